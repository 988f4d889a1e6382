//! A smooth, strictly positive light of order one.

use super::{Light, LightSample, Seen8, luminance, rounded, splat3, tangents, unit_or_up};
use core::f64::consts::PI;
use glam::DVec3;
use hairis::Vec3x8;
use wide::f32x8;

/// Axis of the gradient: above, ahead and to the side, so that no symmetry of the fibre hides an error. Unit to rounding after normalisation.
const AXIS: DVec3 = DVec3::new(0.36, 0.80, 0.48);

/// Mean radiance of each channel.
const MEAN: [f64; 3] = [1.0, 0.9, 0.8];

/// Contrast of each channel: the radiance runs over `MEAN (1 -+ CONTRAST)`.
const CONTRAST: [f64; 3] = [0.5, 0.6, 0.8];

/// A linear gradient over the sphere: `mean (1 + contrast dot(axis, dir))` in each channel, its luminance sampled exactly.
///
/// The axis is (0.36, 0.80, 0.48), the means are 1, 0.9, 0.8 and the contrasts 0.5, 0.6, 0.8 for red, green, blue: always above 0.16.
///
/// - Integral: of the radiance, `4 pi mean`.
///
/// # Examples
/// ```
/// use glam::DVec3;
/// use hairis_harness::light::{Light, Smooth};
/// let smooth = Smooth::new();
/// assert!(smooth.radiance(DVec3::Y)[1] > smooth.radiance(-DVec3::Y)[1]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Smooth {
    axis: DVec3,
    slope: f64,
}

impl Default for Smooth {
    fn default() -> Self {
        Self::new()
    }
}

impl Smooth {
    /// The light.
    #[must_use]
    pub fn new() -> Self {
        let gradient = core::array::from_fn(|c| MEAN[c] * CONTRAST[c]);
        Self { axis: AXIS.normalize(), slope: luminance(gradient) / luminance(MEAN) }
    }
}

impl Light for Smooth {
    fn name(&self) -> &str {
        "smooth"
    }

    fn radiance(&self, dir: DVec3) -> [f64; 3] {
        let t = self.axis.dot(unit_or_up(dir));
        core::array::from_fn(|c| MEAN[c] * (1.0 + CONTRAST[c] * t))
    }

    fn sample(&self, xi: [f64; 2]) -> LightSample {
        // The cdf of t is ((t + 1) + slope (t^2 - 1)/2)/2; its root by the form that does not cancel.
        let k = self.slope;
        let c = 2.0 * xi[0] - 1.0 + 0.5 * k;
        let t = (2.0 * c / (1.0 + (1.0 + 2.0 * k * c).max(0.0).sqrt())).clamp(-1.0, 1.0);
        let r = ((1.0 - t) * (1.0 + t)).max(0.0).sqrt();
        let (sin_phi, cos_phi) = (2.0 * PI * xi[1]).sin_cos();
        let [e1, e2] = tangents(self.axis);
        let dir = t * self.axis + r * cos_phi * e1 + r * sin_phi * e2;
        LightSample { dir, radiance: self.radiance(dir), pdf: self.pdf(dir) }
    }

    fn pdf(&self, dir: DVec3) -> f64 {
        (1.0 + self.slope * self.axis.dot(unit_or_up(dir))) * (0.25 / PI)
    }

    fn see8(&self, dir: &Vec3x8) -> Seen8 {
        let t = Vec3x8::splat(self.axis.as_vec3()).dot(*dir);
        let (mean, slope) = (splat3(MEAN), splat3(core::array::from_fn(|c| MEAN[c] * CONTRAST[c])));
        let uniform = f32x8::splat(rounded(0.25 / PI));
        Seen8 {
            radiance: core::array::from_fn(|c| slope[c].mul_add(t, mean[c])),
            pdf: (f32x8::splat(rounded(self.slope)) * t + f32x8::splat(1.0)) * uniform,
        }
    }
}
