//! Lights for the comparison, which are infinitely far away and so are functions of direction alone.
//!
//! In the world frame y points up. With the fibre along world x, the fibre frame (u, v, w) is the world frame (x, y, z), so that
//! [`fibre_direction`](crate::direction::fibre_direction) returns world directions. Radiance is linear RGB with the Rec. 709 primaries,
//! in arbitrary but common units.

mod constant;
mod environment;
pub mod inversion;
mod load;
mod rectangle;
mod sky;
mod smooth;
mod sun;

pub use constant::Constant;
pub use environment::{Environment, PixelRepairs};
pub use load::LightError;
pub use rectangle::Rectangle;
pub use sky::{Sky, xyy_to_rgb};
pub use smooth::Smooth;
pub use sun::Sun;

use crate::quadrature::{Integral, SphereIntegrator};
use core::fmt::Debug;
use glam::DVec3;
use hairis::Vec3x8;
use wide::f32x8;

/// Returns the luminance of a linear RGB colour with the Rec. 709 primaries, in the unit of the colour.
#[inline]
#[must_use]
pub const fn luminance(rgb: [f64; 3]) -> f64 {
    0.212_639 * rgb[0] + 0.715_169 * rgb[1] + 0.072_192 * rgb[2]
}

/// Direction drawn from a light, with its radiance and its density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit direction from the shading point towards the light, world frame.
    pub dir: DVec3,
    /// Radiance from the direction, linear RGB.
    pub radiance: [f64; 3],
    /// Density per steradian; if the density is 0, the sample contributes 0.
    pub pdf: f64,
}

/// Radiance and density of a light in eight directions, one per lane, in single precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen8 {
    /// Radiance from the direction, linear RGB.
    pub radiance: [f32x8; 3],
    /// Density of drawing the direction from the light, per steradian.
    pub pdf: f32x8,
}

/// Light that arrives from infinitely far away, with its importance sampling.
///
/// Directions passed to `see` need not have exactly unit length: a direction that was rounded to `f32` is good enough.
pub trait Light: Debug + Sync + Send {
    /// Returns the name in tables and files, which no two lights share.
    fn name(&self) -> &str;

    /// Returns the name as it reads in a sentence.
    fn words(&self) -> &str {
        self.name()
    }

    /// Returns true if the light shines from everywhere with about the same brightness. Directions of the hair's sampler alone then
    /// measure the light well.
    fn is_everywhere(&self) -> bool {
        false
    }

    /// Returns [`radiance`](Self::radiance) and [`pdf`](Self::pdf) of a direction at once.
    fn see(&self, dir: DVec3) -> ([f64; 3], f64);

    /// Returns the radiance that arrives from `dir`, linear RGB.
    fn radiance(&self, dir: DVec3) -> [f64; 3] {
        self.see(dir).0
    }

    /// Returns the density of [`sample`](Self::sample) at `dir`, per steradian; it integrates to 1 over the sphere.
    fn pdf(&self, dir: DVec3) -> f64 {
        self.see(dir).1
    }

    /// Draws a direction with density [`pdf`](Self::pdf) from two numbers of [0, 1).
    fn sample(&self, xi: [f64; 2]) -> LightSample;

    /// Draws eight directions as [`sample`](Self::sample) does, from eight pairs of numbers.
    fn sample8(&self, xi: [[f64; 2]; 8]) -> [LightSample; 8] {
        xi.map(|xi| self.sample(xi))
    }

    /// Returns [`radiance`](Self::radiance) and [`pdf`](Self::pdf) in eight directions, one per lane, which are unit vectors in single
    /// precision.
    ///
    /// - Accuracy: that of `f32`; a direction within a few 1e-7 rad of an edge may count as lying on the other side.
    fn see8(&self, dir: &Vec3x8) -> Seen8;

    /// Computes the reference integral of `radiance * f` over the sphere, with `f` per steradian and in linear RGB.
    ///
    /// Each light integrates over its own support, so its edges cost nothing. `sphere` specifies the tolerance and, for lights that
    /// cover the whole sphere, the breakpoints of the lobes of `f` (fibre along world x). An [`Environment`] integrates texel by texel
    /// and only estimates the error.
    fn integrate(&self, f: &dyn Fn(DVec3) -> [f64; 3], sphere: &SphereIntegrator) -> Integral<3> {
        sphere.integrate_direction(|dir| product(self.radiance(dir), f(dir)))
    }
}

/// Returns the number of single precision that is nearest to `x`.
#[inline]
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to f32 is the purpose"
)]
pub const fn rounded(x: f64) -> f32 {
    x as f32
}

/// Returns the product of two colours, channel by channel.
#[inline]
#[must_use]
pub fn product(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|c| a[c] * b[c])
}

/// Returns the direction at an angle to the unit vector `axis`, given by its cosine and the square of its sine, and at azimuth `phi` in
/// a right-handed frame (Duff et al. 2017).
fn about(axis: DVec3, cosine: f64, sine_sq: f64, phi: f64) -> DVec3 {
    let [e1, e2] = tangents(axis);
    let r = sine_sq.max(0.0).sqrt();
    let (sin_phi, cos_phi) = phi.sin_cos();
    cosine * axis + r * cos_phi * e1 + r * sin_phi * e2
}

/// Returns two unit vectors that complete the unit vector `axis` to a right-handed frame (Duff et al. 2017).
#[must_use]
pub fn tangents(axis: DVec3) -> [DVec3; 2] {
    let sign = 1.0_f64.copysign(axis.z);
    let a = -1.0 / (sign + axis.z);
    let b = axis.x * axis.y * a;
    [
        DVec3::new(1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x),
        DVec3::new(b, sign + axis.y * axis.y * a, -axis.y),
    ]
}

/// Returns the unit vector along `dir`, or straight up if `dir` has no direction.
fn unit_or_up(dir: DVec3) -> DVec3 {
    dir.try_normalize().unwrap_or(DVec3::Y)
}
