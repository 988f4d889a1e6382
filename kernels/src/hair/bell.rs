//! Bell curves that the published model is built of: its extension point.

use super::albedo::bell_area;
use super::matched::MatchedBell;
use crate::model::math::gaussian;
use crate::simd::Lanes;
use crate::simd::pair::Pair;

/// Bell curve of unit peak, which takes the place of every Gaussian of the published model.
///
/// The arguments are `s = (x / width)^2`, the squared distance from the centre in widths, and the Cauchy value `1 / (1 + s)`, which
/// the density of the published sampler needs anyway. A bell is written once over [`Lanes`]. For full speed mark all its functions
/// `#[inline(always)]` and pass no closures on.
///
/// ```
/// use hairis::{HairParams, Material, Published};
/// use hairis::model::Bell;
/// use hairis::simd::Lanes;
/// use glam::Vec3;
/// /// A parabola with its corners rounded: `max(0, 1 - s/8)^4`.
/// #[derive(Clone, Copy, Debug)]
/// struct Bump;
/// impl Bell for Bump {
///     #[inline(always)]
///     fn one<L: Lanes>(s: L, _cauchy: L) -> L {
///         let x = L::splat(0.0).max(s * -0.125 + 1.0);
///         (x * x) * (x * x)
///     }
/// }
/// let hair = Material::new(&Published(Bump), &HairParams::default());
/// assert!(hair.prepare(Vec3::Y).pdf(Vec3::Y) > 0.0);
/// ```
pub trait Bell: Copy {
    /// Evaluates the bell at the squared distance `s` in widths; the result is 1 at `s` 0.
    ///
    /// `cauchy` is `1 / (1 + s)`.
    fn one<L: Lanes>(s: L, cauchy: L) -> L;

    /// Evaluates the product of two bells.
    #[inline(always)]
    fn two<L: Lanes>(at: TwoBells<L>) -> L {
        Self::one(at.s, at.cauchy_s) * Self::one(at.t, at.cauchy_t)
    }

    /// Evaluates the bells of the four lobes at one direction: [`one`](Self::one) for R, [`two`](Self::two) for TT, `one` for TRT,
    /// and `two` for the glints. Override it where the four together cost less than one after another.
    #[inline(always)]
    fn four<L: Lanes>(at: FourBells<L>) -> [L; 4] {
        [
            Self::one(at.s_r, at.cauchy_r),
            Self::two(at.tt),
            Self::one(at.s_trt, at.cauchy_trt),
            Self::two(at.glint),
        ]
    }

    /// Computes the integral from `lo` to `hi`, in widths from the centre, for [`Single`](crate::model::Single).
    ///
    /// Provided: a quadrature.
    #[doc(hidden)]
    #[inline(always)]
    fn area<L: Lanes>(lo: L, hi: L) -> L {
        bell_area::<Self, L>(lo, hi)
    }

    /// Returns a factor on every width of the material, finite and at least 0.5, which is read once per material.
    #[inline]
    fn width_factor(&self) -> f32 {
        1.0
    }
}

/// Arguments of the product of two bells, at squared distances `s` and `t` in widths.
#[derive(Clone, Copy, Debug)]
pub struct TwoBells<L> {
    /// Squared distance from the centre of the first, in widths.
    pub s: L,
    /// Squared distance from the centre of the second, in widths.
    pub t: L,
    /// `1 / ((1 + s) (1 + t))`.
    pub cauchy: L,
    /// `1 / (1 + s)`.
    pub cauchy_s: L,
    /// `1 / (1 + t)`.
    pub cauchy_t: L,
}

/// Arguments of the bells of the four lobes at one direction.
#[derive(Clone, Copy, Debug)]
pub struct FourBells<L> {
    /// Squared distance of the inclination from the centre of R, in widths.
    pub s_r: L,
    /// `1 / (1 + s_r)`.
    pub cauchy_r: L,
    /// Inclination and azimuth of TT.
    pub tt: TwoBells<L>,
    /// Squared distance of the inclination from the centre of TRT, in widths.
    pub s_trt: L,
    /// `1 / (1 + s_trt)`.
    pub cauchy_trt: L,
    /// Inclination and azimuth of the glints.
    pub glint: TwoBells<L>,
}

/// Bell of the published model: `exp(-s/2)`, a Gaussian whose standard deviation is the width.
///
/// - Source: Ou et al. 2012, table 2; unit peak by ERRATA E4.
/// - Accuracy: exactly 0 from about `2^-115` down, see [`crate::model::math::gaussian`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gaussian;

impl Bell for Gaussian {
    #[inline(always)]
    fn one<L: Lanes>(s: L, _cauchy: L) -> L {
        gaussian(s)
    }

    // The product of two Gaussians is one Gaussian.
    #[inline(always)]
    fn two<L: Lanes>(at: TwoBells<L>) -> L {
        gaussian(at.s + at.t)
    }

    // Interleaved in pairs, so that each constant is read once for two bells, and no dependency chain waits alone. Four bells at a
    // time would need more registers than AVX2 has.
    #[inline(always)]
    fn four<L: Lanes>(at: FourBells<L>) -> [L; 4] {
        let Pair(r, tt) = gaussian(Pair(at.s_r, at.tt.s + at.tt.t));
        let Pair(trt, glint) = gaussian(Pair(at.s_trt, at.glint.s + at.glint.t));
        [r, tt, trt, glint]
    }

    #[inline(always)]
    fn area<L: Lanes>(lo: L, hi: L) -> L {
        Self::closed_area(lo, hi)
    }
}
