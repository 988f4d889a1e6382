//! Bells whose distribution on an interval has a closed form: the extension point of the matched samplers.

use crate::hair::bell::Bell;
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
