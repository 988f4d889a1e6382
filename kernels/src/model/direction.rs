//! A direction in the frame of a fibre, with the sine and the cosine of its inclination.

use crate::model::GRAZING;
use crate::model::math::sin_cos_half_turn;
use crate::simd::{Lanes, Vec3x};
use core::f32::consts::PI;

/// Unit direction in the fibre's frame, with the sine and cosine of its inclination: argument and sample of a model.
#[derive(Clone, Copy, Debug)]
pub struct Direction<L: Lanes> {
    /// Components along u, v and w.
    pub vector: Vec3x<L>,
    /// Sine of the inclination.
    pub sin_theta: L,
    /// Cosine of the inclination.
    pub cos_theta: L,
    /// Mask of the lanes that hold a direction off the axis.
    sound: L::Mask,
}

impl<L: Lanes> Direction<L> {
    /// Makes the direction of a unit vector. A vector within [`GRAZING`] of the axis, or longer than 2, is not
    /// [sound](Self::is_sound).
    #[inline(always)]
    #[must_use]
    pub fn new(vector: Vec3x<L>) -> Self {
        L::stage("wi: cosine of the inclination, and whether it is a direction");
        let Vec3x { x, y, z } = vector;
        let cos_sq = y.mul_add(y, z * z);
        let cos_theta = cos_sq.sqrt();
        // The comparison is false for the infinities of a sum that overflowed, and for NaN.
        let sound = L::and(
            L::splat(GRAZING).lt(cos_theta),
            x.mul_add(x, cos_sq).lt(L::splat(4.0)),
        );
        Self {
            vector,
            sin_theta: x,
            cos_theta,
            sound,
        }
    }

    /// Makes the direction of any finite vector. Zero counts as v, in the normal plane; on the axis the cosine is 0.
    #[inline(always)]
    #[must_use]
    pub fn normalized(vector: Vec3x<L>) -> Self {
        L::stage("wo at unit length, and the cosine of its inclination");
        let c = L::splat;
        let (one, half) = (c(1.0), c(0.5));
        let Vec3x { x, y, z } = vector;
        // Scaled first, so that no square overflows or vanishes; one of about unit length keeps its digits.
        let largest = x.abs().max(y.abs().max(z.abs()));
        let by = L::select_predictable(
            c(1e12).lt(largest),
            c(1e-25),
            L::select_predictable(largest.lt(c(1e-12)), c(1e25), one),
        );
        let (x, y, z) = (x * by, y * by, z * by);
        let length_sq = x.mul_add(x, y.mul_add(y, z * z));
        let some = c(1e-30).lt(length_sq);
        let unit = (length_sq - 1.0).abs().lt(c(1e-5));
        let by =
            L::select_predictable(unit, one, L::keep(some, L::quotient(one, length_sq.sqrt())));
        let (x, y, z) = (x * by, L::select_predictable(some, y * by, one), z * by);
        // Correct the length by its remaining difference from 1: one rounding per component.
        let plane_sq = y.mul_add(y, z * z);
        let off = half - x.mul_add(x, plane_sq) * 0.5;
        let cos = plane_sq.sqrt();
        let vector = Vec3x::new(x.mul_add(off, x), y.mul_add(off, y), z.mul_add(off, z));
        let (sin_theta, cos_theta) = (vector.x, cos.mul_add(off, cos));
        Self {
            vector,
            sin_theta,
            cos_theta,
            sound: c(GRAZING).lt(cos_theta),
        }
    }

    /// Makes the direction of an inclination and an azimuth, each given as sine and cosine.
    #[inline(always)]
    #[must_use]
    pub fn from_sin_cos([sin_theta, cos_theta]: [L; 2], [sin_phi, cos_phi]: [L; 2]) -> Self {
        let vector = Vec3x::new(sin_theta, cos_theta * cos_phi, cos_theta * sin_phi);
        Self {
            vector,
            sin_theta,
            cos_theta,
            sound: L::splat(GRAZING).lt(cos_theta),
        }
    }

    /// Makes the direction of an inclination, given as sine and cosine, at the azimuth `pi (2 xi - 1)`.
    #[inline(always)]
    #[must_use]
    pub fn with_uniform_azimuth(theta: [L; 2], xi: L) -> Self {
        let (sin, cos) = sin_cos_half_turn((xi - 0.5) * PI);
        Self::from_sin_cos(theta, [(sin + sin) * cos, cos.mul_sub(cos, sin * sin)])
    }

    /// Returns the mask of the lanes that hold a direction further than [`GRAZING`] from the axis.
    #[inline(always)]
    pub fn is_sound(&self) -> L::Mask {
        self.sound
    }
}
