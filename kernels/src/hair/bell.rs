//! The bell curves that the published model is built of: its extension point.

use super::albedo::bell_area;
use super::matched::MatchedBell;
use crate::model::math::gaussian;
use crate::simd::Lanes;
use crate::simd::pair::Pair;

/// A bell of unit peak: every Gaussian of the published model, or what replaces it.
///
/// Its arguments are `s = (x / width)^2`, the squared distance from its centre in widths, and the Cauchy value
/// `1 / (1 + s)`, which the density of the published sampler needs anyway. It is written once over [`Lanes`]. For full
/// speed mark all functions `#[inline(always)]` and pass no closures on.
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
    /// The bell at squared distance `s` in widths; 1 at 0.
    ///
    /// `cauchy` is `1 / (1 + s)`.
    fn one<L: Lanes>(s: L, cauchy: L) -> L;

    /// The product of two bells.
    #[inline(always)]
    fn two<L: Lanes>(at: TwoBells<L>) -> L {
        Self::one(at.s, at.cauchy_s) * Self::one(at.t, at.cauchy_t)
    }

    /// The bells of the four lobes at one direction: [`one`](Self::one) of R, [`two`](Self::two) of TT, `one` of TRT, `two` of
    /// the glints. Override it where the four together cost less than one after another.
    #[inline(always)]
    fn four<L: Lanes>(at: FourBells<L>) -> [L; 4] {
        [
            Self::one(at.s_r, at.cauchy_r),
            Self::two(at.tt),
            Self::one(at.s_trt, at.cauchy_trt),
            Self::two(at.glint),
        ]
    }

    /// Integral from `lo` to `hi`, in widths from the centre, for [`Single`](crate::model::Single).
    ///
    /// Provided: a quadrature.
    #[doc(hidden)]
    #[inline(always)]
    fn area<L: Lanes>(lo: L, hi: L) -> L {
        bell_area::<Self, L>(lo, hi)
    }

    /// A factor on every width of the material, finite and at least 0.5; it is read once per material.
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
    /// As `s_r`, of TRT.
    pub s_trt: L,
    /// `1 / (1 + s_trt)`.
    pub cauchy_trt: L,
    /// Inclination and azimuth of the glints.
    pub glint: TwoBells<L>,
}

/// The bell of the published model: `exp(-s/2)`, a Gaussian whose deviation is the width.
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

    // Two Gaussians are one.
    #[inline(always)]
    fn two<L: Lanes>(at: TwoBells<L>) -> L {
        gaussian(at.s + at.t)
    }

    // Interleaved in pairs: each constant is read once for two, and no dependency chain waits alone. Four at a time would need more
    // registers than AVX2 has.
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
