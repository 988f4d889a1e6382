//! The large area light of the paper's Figure 6A: a rectangle above the fibre, its long side along it.

use super::{Light, LightSample, Seen8, product, rounded, splat3};
use crate::quadrature::{Integral, SphereIntegrator, integrate_rectangle};
use glam::DVec3;
use hairis::Vec3x8;
use wide::f32x8;

/// A horizontal rectangle above the shading point, centred, long side along world x (the fibre), of constant radiance.
///
/// Sampled uniformly over the solid angle (Urena, Fajardo and King 2013): the density is constant, so all the noise left is
/// that of the scattering function.
///
/// - Integral: of the radiance, the radiance times [`solid_angle`](Self::solid_angle).
///
/// # Examples
/// ```
/// use hairis_harness::light::Rectangle;
/// let r = Rectangle::figure_6a();
/// assert!((r.solid_angle() - 1.646_1).abs() < 1e-4);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Rectangle {
    half_x: f64,
    half_z: f64,
    height: f64,
    radiance: [f64; 3],
}

impl Rectangle {
    /// 4 by 1 units at distance 1, radiance 1, sampled by solid angle: it spans 127 degrees along the fibre and 53 across.
    #[must_use]
    pub fn figure_6a() -> Self {
        Self::new(4.0, 1.0, 1.0, [1.0; 3])
    }

    /// A rectangle of `length` along x and `width` along z at `height` above. Sizes in units of length, clamped to [1e-3, 1e3].
    #[must_use]
    pub fn new(length: f64, width: f64, height: f64, radiance: [f64; 3]) -> Self {
        let size = |x: f64| x.clamp(1e-3, 1e3);
        Self { half_x: 0.5 * size(length), half_z: 0.5 * size(width), height: size(height), radiance }
    }

    /// Solid angle seen from the shading point, in sr.
    ///
    /// `4 asin(a b / sqrt((a^2 + h^2)(b^2 + h^2)))` with half sides a, b and height h.
    #[must_use]
    pub fn solid_angle(&self) -> f64 {
        let (a, b, h) = (self.half_x, self.half_z, self.height);
        // As an arctangent: accurate for large rectangles too.
        4.0 * (a * b).atan2(h * (a * a + b * b + h * h).sqrt())
    }

    /// Whether the ray along `dir` meets the rectangle.
    fn hit(&self, dir: DVec3) -> bool {
        if dir.y.is_nan() || dir.y <= 0.0 {
            return false;
        }
        let t = self.height / dir.y;
        let (x, z) = (dir.x * t, dir.z * t);
        // Slack for rounded rim samples, as for the sun.
        let slack = 1.0 + 1e-9;
        x.abs() <= self.half_x * slack && z.abs() <= self.half_z * slack
    }

    /// The point of the rectangle for two uniform numbers, as (x, z).
    fn point(&self, xi: [f64; 2]) -> [f64; 2] {
        let (a, b, h) = (self.half_x, self.half_z, self.height);
        // The strip between the centre plane and x subtends 2 atan(x b / (h sqrt(x^2 + b^2 + h^2))): invert for x.
        let part = (2.0 * xi[0] - 1.0) * 0.25 * self.solid_angle();
        let t = h * part.tan();
        let x = (t * ((b * b + h * h) / ((b - t) * (b + t)).max(f64::MIN_POSITIVE)).sqrt()).clamp(-a, a);
        // Across the strip the sine of the angle to the plane of x and h is uniform.
        let rho_sq = x * x + h * h;
        let s = (2.0 * xi[1] - 1.0) * b / (rho_sq + b * b).sqrt();
        let z = (s * (rho_sq / ((1.0 - s) * (1.0 + s))).sqrt()).clamp(-b, b);
        [x, z]
    }
}

impl Light for Rectangle {
    fn name(&self) -> &str {
        "rectangle"
    }

    fn radiance(&self, dir: DVec3) -> [f64; 3] {
        if self.hit(dir) { self.radiance } else { [0.0; 3] }
    }

    fn sample(&self, xi: [f64; 2]) -> LightSample {
        let [x, z] = self.point(xi);
        LightSample {
            dir: DVec3::new(x, self.height, z).normalize(),
            radiance: self.radiance,
            pdf: 1.0 / self.solid_angle(),
        }
    }

    fn pdf(&self, dir: DVec3) -> f64 {
        if self.hit(dir) { 1.0 / self.solid_angle() } else { 0.0 }
    }

    fn see8(&self, dir: &Vec3x8) -> Seen8 {
        let splat = |x: f64| f32x8::splat(rounded(x));
        // The plane is met at dir * height / y: compare without the division, which below the horizon would come back up.
        let within = |x: f32x8, half: f64| (x.abs() * splat(self.height)).simd_le(dir.y * splat(half));
        let hit = dir.y.simd_gt(f32x8::ZERO) & within(dir.x, self.half_x) & within(dir.z, self.half_z);
        let on = |x: f32x8| hit.select(x, f32x8::ZERO);
        let pdf = splat(1.0 / self.solid_angle());
        Seen8 { radiance: splat3(self.radiance).map(on), pdf: on(pdf) }
    }

    fn integrate(&self, f: &dyn Fn(DVec3) -> [f64; 3], sphere: &SphereIntegrator) -> Integral<3> {
        // In angles rather than lengths, x = h tan(a) and z = h tan(b): the integrand is then flat along the light.
        let h = self.height;
        let edge = |half: f64| {
            let end = (half / h).atan();
            (0..=16).map(|i| end * (f64::from(i) / 8.0 - 1.0)).collect::<Vec<f64>>()
        };
        integrate_rectangle(
            |a, b| {
                let (x, z) = (h * a.tan(), h * b.tan());
                let rho_sq = x * x + z * z + h * h;
                let jacobian = h / (rho_sq * rho_sq.sqrt()) * (x * x + h * h) * (z * z + h * h) / (h * h);
                product(self.radiance, f(DVec3::new(x, h, z).normalize())).map(|v| v * jacobian)
            },
            &edge(self.half_x),
            &edge(self.half_z),
            sphere.tolerance(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;

    #[test]
    fn solid_angle_of_known_rectangles() {
        // A face of a cube seen from its centre is a sixth of the sphere; a small far one is area over distance squared.
        let face = Rectangle::new(2.0, 2.0, 1.0, [1.0; 3]);
        assert!((face.solid_angle() - 4.0 * PI / 6.0).abs() < 1e-14);
        let far = Rectangle::new(0.1, 0.2, 100.0, [1.0; 3]);
        assert!((far.solid_angle() / (0.02 / 1e4) - 1.0).abs() < 1e-5);
        let plane = Rectangle::new(1e3, 1e3, 1e-3, [1.0; 3]);
        assert!((plane.solid_angle() / (2.0 * PI) - 1.0).abs() < 1e-5);
    }

    #[test]
    fn corners_come_from_the_corners_of_the_square() {
        let r = Rectangle::figure_6a();
        let last = 1.0 - f64::EPSILON / 2.0;
        for (xi, want) in [([0.0, 0.0], [-2.0, -0.5]), ([last, last], [2.0, 0.5]), ([0.5, 0.5], [0.0, 0.0])] {
            let got = r.point(xi);
            assert!((got[0] - want[0]).abs() < 1e-12 && (got[1] - want[1]).abs() < 1e-12, "{xi:?}: {got:?}");
        }
    }
}
