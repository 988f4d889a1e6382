//! Directions in the frame of a fibre, whose axis is the first coordinate of three.

use crate::sequence::Independent;
use core::f64::consts::TAU;
use glam::{DVec3, Vec3};
use hairis::Vec3x8;
use wide::f32x8;

/// Returns the direction at inclination `theta` and azimuth `phi`: `(sin theta, cos theta cos phi, cos theta sin phi)` along (u, v, w).
///
/// - Units: rad; `theta` is measured from the normal plane.
#[inline]
#[must_use]
pub fn fibre_direction(theta: f64, phi: f64) -> DVec3 {
    let (sin_theta, cos_theta) = theta.sin_cos();
    let (sin_phi, cos_phi) = phi.sin_cos();
    DVec3::new(sin_theta, cos_theta * cos_phi, cos_theta * sin_phi)
}

/// Returns the cosine of the inclination of eight directions in the frame of the fibre, one per lane.
#[inline]
#[must_use]
pub fn cosine(direction: &Vec3x8) -> f32x8 {
    (direction.y * direction.y + direction.z * direction.z).sqrt()
}

/// Returns the components of a vector, converted to double precision.
#[inline]
#[must_use]
pub fn to_f64(v: Vec3) -> [f64; 3] {
    v.to_array().map(f64::from)
}

/// Returns the direction at `sin_theta` above the normal plane, with the cosine `cos_theta` and at azimuth `phi` in rad.
///
/// The components are computed in `f64` and then rounded, so that those of a direction near the axis keep their digits.
#[inline]
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to f32 is the purpose"
)]
pub fn direction(sin_theta: f64, cos_theta: f64, phi: f64) -> Vec3 {
    Vec3::new(
        sin_theta as f32,
        (cos_theta * phi.cos()) as f32,
        (cos_theta * phi.sin()) as f32,
    )
}

/// Draws a direction that is uniformly distributed on the sphere, from two numbers of `xi`.
#[inline]
pub fn uniform_direction(xi: &mut Independent) -> Vec3 {
    let sin_theta = 2.0 * xi.next_f64() - 1.0;
    let phi = TAU * xi.next_f64();
    direction(sin_theta, (1.0 - sin_theta * sin_theta).sqrt(), phi)
}
