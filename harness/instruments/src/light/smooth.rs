//! Smooth, strictly positive light whose radiance is of order one.

use super::{Light, LightSample, Seen8, about, luminance, rounded, unit_or_up};
use core::f64::consts::PI;
use glam::DVec3;
use hairis::Vec3x8;
use wide::f32x8;

/// Axis of the gradient, a unit vector. It points upwards, ahead and to the side, so that no symmetry of the fibre hides an error.
const AXIS: DVec3 = DVec3::new(0.36, 0.80, 0.48);

/// Mean radiance of each channel.
const MEAN: [f64; 3] = [1.0, 0.9, 0.8];

/// Contrast of each channel: the radiance ranges over `MEAN (1 -+ CONTRAST)`.
const CONTRAST: [f64; 3] = [0.5, 0.6, 0.8];

/// Contrast of the luminance.
const SLOPE: f64 = luminance([
    MEAN[0] * CONTRAST[0],
    MEAN[1] * CONTRAST[1],
    MEAN[2] * CONTRAST[2],
]) / luminance(MEAN);

/// Linear gradient over the sphere, `mean (1 + contrast dot(axis, dir))` in each channel, whose luminance is sampled exactly.
///
/// The axis is (0.36, 0.80, 0.48). For red, green and blue the means are 1, 0.9, 0.8 and the contrasts 0.5, 0.6, 0.8. The radiance is
/// therefore never below 0.16.
///
/// - Integral: the radiance integrates to `4 pi mean` over the sphere.
///
/// # Examples
/// ```
/// use glam::DVec3;
/// use hairis_instruments::light::{Light, Smooth};
/// let smooth = Smooth;
/// assert!(smooth.radiance(DVec3::Y)[1] > smooth.radiance(-DVec3::Y)[1]);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Smooth;

impl Smooth {
    /// Name of the light, which [`Light::name`] returns for tables and files.
    pub const NAME: &'static str = "smooth";
}

impl Light for Smooth {
    fn name(&self) -> &str {
        Self::NAME
    }

    fn words(&self) -> &str {
        "smooth light"
    }

    fn is_everywhere(&self) -> bool {
        true
    }

    fn see(&self, dir: DVec3) -> ([f64; 3], f64) {
        let t = AXIS.dot(unit_or_up(dir));
        (
            core::array::from_fn(|c| MEAN[c] * (1.0 + CONTRAST[c] * t)),
            (1.0 + SLOPE * t) * (0.25 / PI),
        )
    }

    fn sample(&self, xi: [f64; 2]) -> LightSample {
        // The cdf of t is ((t + 1) + slope (t^2 - 1)/2)/2; its root is computed in the form that does not cancel.
        let k = SLOPE;
        let c = 2.0 * xi[0] - 1.0 + 0.5 * k;
        let t = (2.0 * c / (1.0 + (1.0 + 2.0 * k * c).max(0.0).sqrt())).clamp(-1.0, 1.0);
        let dir = about(AXIS, t, (1.0 - t) * (1.0 + t), 2.0 * PI * xi[1]);
        let (radiance, pdf) = self.see(dir);
        LightSample { dir, radiance, pdf }
    }

    fn see8(&self, dir: &Vec3x8) -> Seen8 {
        let t = Vec3x8::splat(AXIS.as_vec3()).dot(*dir);
        let splat = |x: f64| f32x8::splat(rounded(x));
        Seen8 {
            radiance: core::array::from_fn(|c| {
                splat(MEAN[c] * CONTRAST[c]).mul_add(t, splat(MEAN[c]))
            }),
            pdf: (splat(SLOPE) * t + splat(1.0)) * splat(0.25 / PI),
        }
    }
}
