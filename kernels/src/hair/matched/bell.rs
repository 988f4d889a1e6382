//! Bells whose distribution on an interval has a closed form: the extension point of the matched samplers.

use crate::hair::bell::Gaussian;
use crate::model::Bell;
use crate::model::math::{normal_tail, normal_tail_inverse};
use crate::simd::Lanes;

/// [`Bell`] that [`Matched`](crate::Matched) draws from, because its integral and the inverse of the integral are known.
///
/// The integral up to a point is measured from an origin that the bell chooses, so that differences keep their digits on intervals
/// far from the centre. As for [`Bell`], mark all functions `#[inline(always)]`.
pub trait MatchedBell: Bell {
    /// Area that an integral of 1 stands for, in widths.
    const UNIT: f32;

    /// Returns the origin for the interval `[lo, hi]`, in widths from the centre.
    fn origin<L: Lanes>(lo: L, hi: L) -> L;

    /// Computes the integral from the origin up to `x` in the interval, which ascends with `x`.
    fn integral<L: Lanes>(origin: L, x: L) -> L;

    /// Computes [`Bell::area`] in closed form.
    #[doc(hidden)]
    #[inline(always)]
    fn closed_area<L: Lanes>(lo: L, hi: L) -> L {
        let origin = Self::origin(lo, hi);
        (Self::integral(origin, hi) - Self::integral(origin, lo)) * Self::UNIT
    }

    /// Returns the point whose integral is `sum`. Rounding may move the point past an end of the interval.
    fn invert<L: Lanes>(origin: L, sum: L) -> L;
}

/// Bell whose integral is a probability. On intervals above the centre the integral is minus the probability above `x`.
///
/// - Accuracy: the integral of an inverted point is within 2e-7 of the given one, and within 2.1e-4 of the probability beyond
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
