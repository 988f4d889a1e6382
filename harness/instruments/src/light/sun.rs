//! Sun: a disc of constant radiance, five degrees wide.

use super::{Light, LightSample, Seen8, about, rounded, unit_or_up};
use crate::quadrature::{Integral, SphereIntegrator, integrate_rectangle};
use core::f64::consts::PI;
use glam::DVec3;
use hairis::Vec3x8;
use wide::f32x8;

/// Disc on the sky, 5 degrees across, which is sampled uniformly over its cone. Its radiance is `1 / solid_angle` and white, which is
/// an irradiance of 1 on a plane that faces each of its points.
///
/// - Integral: the radiance integrates to 1.
///
/// # Examples
/// ```
/// use glam::DVec3;
/// use hairis_instruments::light::{Light, Sun};
/// let sun = Sun::five_degrees(DVec3::new(0.3, 1.0, 0.2));
/// assert_eq!(sun.radiance(DVec3::new(0.3, 1.0, 0.2)), [1.0 / sun.solid_angle(); 3]);
/// assert_eq!(sun.radiance(-DVec3::Y), [0.0; 3]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Sun {
    axis: DVec3,
    /// 1 - cos of the angular radius, computed from the half angle so that nothing cancels for small discs.
    height: f64,
}

impl Sun {
    /// Name of the light, which [`Light::name`] returns for tables and files.
    pub const NAME: &'static str = "sun";

    /// Makes the disc around the direction `towards`, which may have any length; the disc is straight up if `towards` has no direction.
    #[must_use]
    pub fn five_degrees(towards: DVec3) -> Self {
        let half_sin = (0.25 * 5.0_f64.to_radians()).sin();
        Self {
            axis: unit_or_up(towards),
            height: 2.0 * half_sin * half_sin,
        }
    }

    /// Returns the solid angle of the disc, in sr.
    #[must_use]
    pub fn solid_angle(&self) -> f64 {
        2.0 * PI * self.height
    }

    /// Returns the direction at `1 - cos = fall` and azimuth `phi` about the axis.
    fn direction(&self, fall: f64, phi: f64) -> DVec3 {
        about(self.axis, 1.0 - fall, fall * (2.0 - fall), phi)
    }
}

impl Light for Sun {
    fn name(&self) -> &str {
        Self::NAME
    }

    fn words(&self) -> &str {
        "a 5° sun"
    }

    fn see(&self, dir: DVec3) -> ([f64; 3], f64) {
        // The chord is accurate where the cosine is not: |dir - axis|^2 = 2 (1 - cos). A relative slack of 1e-9 on the radius keeps
        // rounded samples on the rim inside, and moves the mass by as little.
        let chord_sq = (unit_or_up(dir) - self.axis).length_squared();
        let is_inside = chord_sq <= 2.0 * self.height * (1.0 + 2e-9);
        let pdf = f64::from(is_inside) / self.solid_angle();
        ([pdf; 3], pdf)
    }

    fn sample(&self, xi: [f64; 2]) -> LightSample {
        let pdf = 1.0 / self.solid_angle();
        LightSample {
            dir: self.direction(self.height * xi[0], 2.0 * PI * xi[1]),
            radiance: [pdf; 3],
            pdf,
        }
    }

    fn see8(&self, dir: &Vec3x8) -> Seen8 {
        let away = Vec3x8::splat(-self.axis.as_vec3()).plus(*dir);
        let inside = away
            .dot(away)
            .simd_le(f32x8::splat(rounded(2.0 * self.height)));
        let pdf = inside.select(f32x8::splat(rounded(1.0 / self.solid_angle())), f32x8::ZERO);
        Seen8 {
            radiance: [pdf; 3],
            pdf,
        }
    }

    fn integrate(&self, f: &dyn Fn(DVec3) -> [f64; 3], sphere: &SphereIntegrator) -> Integral<3> {
        // The square root of the fall is the radius to first order: polar coordinates without the kink at the centre.
        let rim = self.height.sqrt();
        let radiance = 1.0 / self.solid_angle();
        integrate_rectangle(
            |radius, phi| {
                f(self.direction(radius * radius, phi)).map(|v| radiance * v * 2.0 * radius)
            },
            &[0.0, 0.25 * rim, 0.5 * rim, rim],
            &[0.0, 0.5 * PI, PI, 1.5 * PI, 2.0 * PI],
            &sphere.tolerance,
        )
    }
}
