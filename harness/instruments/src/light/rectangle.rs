//! Large area light of the paper's Figure 6A: a rectangle above the fibre with its long side along the fibre.

use super::{Light, LightSample, Seen8, rounded};
use crate::quadrature::{Integral, SphereIntegrator, integrate_rectangle};
use glam::DVec3;
use hairis::Vec3x8;
use wide::f32x8;

/// Half sides along x and along z, at a distance of 1.
const HALF: [f64; 2] = [2.0, 0.5];

/// Horizontal rectangle of 4 by 1 units, centred at distance 1 above the shading point. Its long side runs along world x, the fibre,
/// and its radiance is 1. The rectangle spans 127 degrees along the fibre and 53 across.
///
/// Directions are sampled uniformly over the solid angle (Urena, Fajardo and King 2013). Because the density is constant, all remaining
/// noise is that of the scattering function.
///
/// - Integral: the radiance integrates to [`solid_angle`](Self::solid_angle).
///
/// # Examples
/// ```
/// use hairis_instruments::light::Rectangle;
/// assert!((Rectangle.solid_angle() - 1.646_1).abs() < 1e-4);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Rectangle;

impl Rectangle {
    /// Name of the light, which [`Light::name`] returns for tables and files.
    pub const NAME: &'static str = "rectangle";

    /// Returns the solid angle of the rectangle as seen from the shading point, in sr.
    ///
    /// `4 asin(a b / sqrt((a^2 + 1)(b^2 + 1)))` with half sides a and b, as an arctangent.
    #[must_use]
    pub fn solid_angle(&self) -> f64 {
        let [a, b] = HALF;
        4.0 * (a * b).atan2((a * a + b * b + 1.0).sqrt())
    }

    /// Returns the point of the rectangle for two uniform numbers, as (x, z).
    fn point(&self, xi: [f64; 2]) -> [f64; 2] {
        let [a, b] = HALF;
        // The strip between the centre plane and x subtends 2 atan(x b / sqrt(x^2 + b^2 + 1)): invert for x.
        let t = ((2.0 * xi[0] - 1.0) * 0.25 * self.solid_angle()).tan();
        let x =
            (t * ((b * b + 1.0) / ((b - t) * (b + t)).max(f64::MIN_POSITIVE)).sqrt()).clamp(-a, a);
        // Across the strip, the sine of the angle to the plane of x and the height is uniform.
        let rho_sq = x * x + 1.0;
        let s = (2.0 * xi[1] - 1.0) * b / (rho_sq + b * b).sqrt();
        let z = (s * (rho_sq / ((1.0 - s) * (1.0 + s))).sqrt()).clamp(-b, b);
        [x, z]
    }
}

impl Light for Rectangle {
    fn name(&self) -> &str {
        Self::NAME
    }

    fn words(&self) -> &str {
        "a large area light"
    }

    fn see(&self, dir: DVec3) -> ([f64; 3], f64) {
        let t = 1.0 / dir.y;
        // Slack for rounded samples on the rim, as for the sun.
        let within = |x: f64, half: f64| (x * t).abs() <= half * (1.0 + 1e-9);
        let hit = f64::from(dir.y > 0.0 && within(dir.x, HALF[0]) && within(dir.z, HALF[1]));
        ([hit; 3], hit / self.solid_angle())
    }

    fn sample(&self, xi: [f64; 2]) -> LightSample {
        let [x, z] = self.point(xi);
        LightSample {
            dir: DVec3::new(x, 1.0, z).normalize(),
            radiance: [1.0; 3],
            pdf: 1.0 / self.solid_angle(),
        }
    }

    fn see8(&self, dir: &Vec3x8) -> Seen8 {
        let splat = |x: f64| f32x8::splat(rounded(x));
        // The ray meets the plane at dir / y. Compare without the division, with which directions below the horizon would count as
        // hits.
        let within = |x: f32x8, half: f64| x.abs().simd_le(dir.y * splat(half));
        let hit = dir.y.simd_gt(f32x8::ZERO) & within(dir.x, HALF[0]) & within(dir.z, HALF[1]);
        let on = |x: f64| hit.select(splat(x), f32x8::ZERO);
        Seen8 {
            radiance: [on(1.0); 3],
            pdf: on(1.0 / self.solid_angle()),
        }
    }

    fn integrate(&self, f: &dyn Fn(DVec3) -> [f64; 3], sphere: &SphereIntegrator) -> Integral<3> {
        // Integrate over angles rather than lengths, x = tan(a) and z = tan(b), because the integrand is then flat along the light.
        let edges = |half: f64| {
            (0..=16)
                .map(|i| half.atan() * (f64::from(i) / 8.0 - 1.0))
                .collect::<Vec<f64>>()
        };
        let integrand = |a: f64, b: f64| {
            let (x, z) = (a.tan(), b.tan());
            let rho_sq = x * x + z * z + 1.0;
            let jacobian = 1.0 / (rho_sq * rho_sq.sqrt()) * (x * x + 1.0) * (z * z + 1.0);
            f(DVec3::new(x, 1.0, z).normalize()).map(|v| v * jacobian)
        };
        integrate_rectangle(
            integrand,
            &edges(HALF[0]),
            &edges(HALF[1]),
            &sphere.tolerance,
        )
    }
}
