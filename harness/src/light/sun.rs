//! A disc of constant radiance: a sun, five degrees wide by default.

use super::{Light, LightSample, Seen8, product, rounded, splat3, tangents, unit_or_up};
use crate::quadrature::{Integral, SphereIntegrator, integrate_rectangle};
use core::f64::consts::PI;
use glam::DVec3;
use hairis::Vec3x8;
use wide::f32x8;

/// A disc on the sky, sampled uniformly over its cone.
///
/// - Integral: of the radiance, the radiance times [`solid_angle`](Self::solid_angle).
///
/// # Examples
/// ```
/// use glam::DVec3;
/// use hairis_harness::light::{Light, Sun};
/// let sun = Sun::five_degrees(DVec3::new(0.3, 1.0, 0.2));
/// assert_eq!(sun.radiance(DVec3::new(0.3, 1.0, 0.2)), [1.0 / sun.solid_angle(); 3]);
/// assert_eq!(sun.radiance(-DVec3::Y), [0.0; 3]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Sun {
    axis: DVec3,
    /// 1 - cos of the angular radius, through the half angle: no cancellation for small discs.
    height: f64,
    radiance: [f64; 3],
}

impl Sun {
    /// A disc 5 degrees across around `towards` with irradiance 1 on a plane facing each of its points: radiance `1 / solid_angle`, white.
    #[must_use]
    pub fn five_degrees(towards: DVec3) -> Self {
        let sun = Self::new(towards, 5.0_f64.to_radians(), [1.0; 3]);
        Self { radiance: [1.0 / sun.solid_angle(); 3], ..sun }
    }

    /// A disc of angular `diameter`, in rad and clamped to [1e-4, pi], around `towards` (of any length; straight up when it has no direction).
    #[must_use]
    pub fn new(towards: DVec3, diameter: f64, radiance: [f64; 3]) -> Self {
        let half_sin = (0.25 * diameter.clamp(1e-4, PI)).sin();
        Self { axis: unit_or_up(towards), height: 2.0 * half_sin * half_sin, radiance }
    }

    /// Solid angle of the disc, in sr.
    #[must_use]
    pub fn solid_angle(&self) -> f64 {
        2.0 * PI * self.height
    }

    /// Whether the disc covers `dir`. A relative slack of 1e-9 on the radius keeps rounded rim samples inside; it moves the mass by as little.
    fn covers(&self, dir: DVec3) -> bool {
        // The chord is accurate where the cosine is not: |dir - axis|^2 = 2 (1 - cos).
        (unit_or_up(dir) - self.axis).length_squared() <= 2.0 * self.height * (1.0 + 2e-9)
    }

    /// The direction at `1 - cos = fall` and azimuth `phi` about the axis.
    fn direction(&self, fall: f64, phi: f64) -> DVec3 {
        let r = (fall * (2.0 - fall)).max(0.0).sqrt();
        let (sin_phi, cos_phi) = phi.sin_cos();
        let [e1, e2] = tangents(self.axis);
        (1.0 - fall) * self.axis + r * cos_phi * e1 + r * sin_phi * e2
    }
}

impl Light for Sun {
    fn name(&self) -> &str {
        "sun"
    }

    fn radiance(&self, dir: DVec3) -> [f64; 3] {
        if self.covers(dir) { self.radiance } else { [0.0; 3] }
    }

    fn sample(&self, xi: [f64; 2]) -> LightSample {
        let dir = self.direction(self.height * xi[0], 2.0 * PI * xi[1]);
        LightSample { dir, radiance: self.radiance, pdf: 1.0 / self.solid_angle() }
    }

    fn pdf(&self, dir: DVec3) -> f64 {
        if self.covers(dir) { 1.0 / self.solid_angle() } else { 0.0 }
    }

    fn see8(&self, dir: &Vec3x8) -> Seen8 {
        let away = Vec3x8::splat(-self.axis.as_vec3()).plus(*dir);
        let inside = away.dot(away).simd_le(f32x8::splat(rounded(2.0 * self.height)));
        let on = |x: f32x8| inside.select(x, f32x8::ZERO);
        Seen8 { radiance: splat3(self.radiance).map(on), pdf: on(f32x8::splat(rounded(1.0 / self.solid_angle()))) }
    }

    fn integrate(&self, f: &dyn Fn(DVec3) -> [f64; 3], sphere: &SphereIntegrator) -> Integral<3> {
        // Square root of the fall is the radius to first order: polar coordinates without the kink at the centre.
        let rim = self.height.sqrt();
        integrate_rectangle(
            |radius, phi| product(self.radiance, f(self.direction(radius * radius, phi))).map(|v| v * 2.0 * radius),
            &[0.0, 0.25 * rim, 0.5 * rim, rim],
            &[0.0, 0.5 * PI, PI, 1.5 * PI, 2.0 * PI],
            sphere.tolerance(),
        )
    }
}
