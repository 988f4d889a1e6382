//! The bell curves that the published model is built of: its extension point.

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
///         let x = L::splat(0.0).max(s.mul_add(L::splat(-0.125), L::splat(1.0)));
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

    /// The product of two bells, at `s` and `t`.
    ///
    /// `cauchy` is `1 / ((1 + s) (1 + t))`, `cauchy_s` and `cauchy_t` its two factors.
    #[inline(always)]
    fn two<L: Lanes>(s: L, t: L, cauchy: L, cauchy_s: L, cauchy_t: L) -> L {
        let _ = cauchy;
        Self::one(s, cauchy_s) * Self::one(t, cauchy_t)
    }

    /// The bells of the four lobes at one direction: [`one`](Self::one) of R, [`two`](Self::two) of TT, `one` of TRT, `two` of
    /// the glints, with these arguments. Override it where the four together cost less than one after another.
    #[inline(always)]
    fn four<L: Lanes>(r: [L; 2], tt: [L; 5], trt: [L; 2], glint: [L; 5]) -> [L; 4] {
        [
            Self::one(r[0], r[1]),
            Self::two(tt[0], tt[1], tt[2], tt[3], tt[4]),
            Self::one(trt[0], trt[1]),
            Self::two(glint[0], glint[1], glint[2], glint[3], glint[4]),
        ]
    }

    /// A factor on every width of the material, finite and at least 0.5; it is read once per material.
    #[inline]
    fn width_factor(&self) -> f32 {
        1.0
    }
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
    fn two<L: Lanes>(s: L, t: L, _cauchy: L, _cauchy_s: L, _cauchy_t: L) -> L {
        Self::one(s + t, s)
    }

    // Interleaved in pairs: each constant is read once for two, and no dependency chain waits alone. Four at a time would need more
    // registers than AVX2 has.
    #[inline(always)]
    fn four<L: Lanes>(r: [L; 2], tt: [L; 5], trt: [L; 2], glint: [L; 5]) -> [L; 4] {
        let Pair(r, tt) = gaussian(Pair(r[0], tt[0] + tt[1]));
        let Pair(trt, glint) = gaussian(Pair(trt[0], glint[0] + glint[1]));
        [r, tt, trt, glint]
    }
}
