//! Light of the same radiance from every direction.

use super::{Light, LightSample, Seen8, rounded};
use core::f64::consts::PI;
use glam::DVec3;
use hairis::Vec3x8;
use wide::f32x8;

/// Constant light of radiance 1 from every direction, sampled uniformly on the sphere.
///
/// - Integral: the radiance integrates to `4 pi` over the sphere.
///
/// # Examples
/// ```
/// use hairis_instruments::light::{Constant, Light};
/// let s = Constant.sample([0.2, 0.7]);
/// assert_eq!(s.radiance, [1.0; 3]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Constant;

impl Constant {
    /// Name of the light, which [`Light::name`] returns for tables and files.
    pub const NAME: &'static str = "constant";
}

impl Light for Constant {
    fn name(&self) -> &str {
        Self::NAME
    }

    fn words(&self) -> &str {
        "constant light"
    }

    fn is_everywhere(&self) -> bool {
        true
    }

    fn see(&self, _dir: DVec3) -> ([f64; 3], f64) {
        ([1.0; 3], 0.25 / PI)
    }

    fn sample(&self, xi: [f64; 2]) -> LightSample {
        let y = 1.0 - 2.0 * xi[0];
        // (1 - y)(1 + y) is computed from its factors, so that nothing cancels near the poles.
        let r = (4.0 * xi[0] * (1.0 - xi[0])).max(0.0).sqrt();
        let (sin_phi, cos_phi) = (2.0 * PI * xi[1]).sin_cos();
        LightSample {
            dir: DVec3::new(r * cos_phi, y, r * sin_phi),
            radiance: [1.0; 3],
            pdf: 0.25 / PI,
        }
    }

    fn see8(&self, _dir: &Vec3x8) -> Seen8 {
        Seen8 {
            radiance: [f32x8::splat(1.0); 3],
            pdf: f32x8::splat(rounded(0.25 / PI)),
        }
    }
}
