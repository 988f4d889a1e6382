//! Gaussian bells, those of the published model.

use super::bell::{Bell, FourBells, TwoBells};
use super::matched::MatchedBell;
use crate::model::math::{gaussian, normal_tail, normal_tail_inverse};
use crate::simd::Lanes;
use crate::simd::pair::Pair;

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

/// Bell whose integral is a probability. On intervals above the centre the integral is minus the probability above `x`.
///
/// - Accuracy: the integral of an inverted point is within 2e-7 of the given one, and within 2.2e-4 of the probability beyond
///   it (5e-5 where that is at least `2^-30`).
impl MatchedBell for Gaussian {
    /// Area under a Gaussian of deviation 1: `sqrt(2 pi)`.
    const UNIT: f32 = 2.506_628_3;

    /// Returns the origin of probabilities above a half: 1, or 0 on an interval above the centre.
    #[inline(always)]
    fn origin<L: Lanes>(lo: L, _hi: L) -> L {
        L::keep(lo.lt(L::splat(0.0)), L::splat(1.0))
    }

    #[inline(always)]
    fn integral<L: Lanes>(origin: L, x: L) -> L {
        let tail = normal_tail(x.abs());
        L::select(x.lt(L::splat(0.0)), tail, origin - tail)
    }

    #[inline(always)]
    fn invert<L: Lanes>(_origin: L, sum: L) -> L {
        let c = L::splat;
        // Half of the least step below 1: no number stands for a point without density.
        let tail = sum.abs().min((c(1.0) - sum).max(c(f32::EPSILON / 4.0)));
        // Below the centre where the sum is between 0 and 1/2.
        normal_tail_inverse(tail).times_sign(sum * (sum - 0.5))
    }
}
