//! Bells whose distribution on an interval is known in closed form: the extension point of the matched samplers.

use crate::Gaussian;
use crate::model::Bell;
use crate::model::math::{normal_tail, normal_tail_inverse};
use crate::simd::Lanes;

/// A [`Bell`] that [`Matched`](crate::Matched) draws from: one whose integral is known, and its inverse.
///
/// The integral up to a point counts from an origin that the bell chooses, so that differences keep their digits on
/// intervals far from its centre. As for [`Bell`], mark all functions `#[inline(always)]`.
pub trait MatchedBell: Bell {
    /// The area that an integral of 1 stands for.
    const UNIT: f32;

    /// The origin for the interval `[lo, hi]`, in widths from the centre.
    fn origin<L: Lanes>(lo: L, hi: L) -> L;

    /// The integral up to `x` in the interval: it ascends with `x`.
    fn integral<L: Lanes>(origin: L, x: L) -> L;

    /// [`Bell::area`] in closed form.
    #[doc(hidden)]
    #[inline(always)]
    fn closed_area<L: Lanes>(lo: L, hi: L) -> L {
        let origin = Self::origin(lo, hi);
        (Self::integral(origin, hi) - Self::integral(origin, lo)) * Self::UNIT
    }

    /// The point whose integral is `sum`. Rounding may take it past an end.
    fn invert<L: Lanes>(origin: L, sum: L) -> L;
}

/// The integral is a probability. On intervals above the centre it is minus the probability above `x`.
///
/// - Accuracy: the integral of an inverted point is within 2e-7 of the given one, and within 2.1e-4 of the probability beyond
///   it (5e-5 where that is at least `2^-30`).
impl MatchedBell for Gaussian {
    /// `sqrt(2 pi)`.
    const UNIT: f32 = 2.506_628_3;

    /// Origin of probabilities above a half: 1, or 0 on an interval above the centre.
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
