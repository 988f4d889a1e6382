//! Bells whose distribution on an interval is known in closed form: the extension point of the matched samplers.

use crate::math::{gaussian, normal_tail_inverse, normal_tail_ratio};
use crate::{Bell, Gaussian, Lanes};

/// A bell's distribution cut to an interval, in widths from its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truncated<L> {
    /// Area of the bell over the interval, in units of [`MatchedBell::UNIT`]; 0 where the bell is 0.
    pub mass: L,
    /// `1 / mass`, or 0 if the mass is.
    pub inv_mass: L,
    /// Two numbers of the bell's own choice.
    pub ends: [L; 2],
}

/// A [`Bell`] that [`Matched`](crate::Matched) draws from: one with a cdf and its inverse.
///
/// A cdf is told by its distance from the nearer end, in `[0, 1/2]`, so that it keeps its digits at both. As for [`Bell`],
/// mark all functions `#[inline(always)]`.
pub trait MatchedBell: Bell {
    /// The area that a mass of 1 stands for.
    const UNIT: f32;

    /// The distribution on `[lo, hi]`.
    fn truncate<L: Lanes>(lo: L, hi: L) -> Truncated<L>;

    /// Where the lower end is the nearer one to the point `x`, by cdf, and the cdf's distance from the nearer end; `bell` is
    /// the bell at `x`.
    fn locate<L: Lanes>(cut: &Truncated<L>, x: L, bell: L) -> (L::Mask, L);

    /// The point at a cdf of `from_lo` from the lower end, and `from_hi = 1 - from_lo` from the upper one.
    ///
    /// Rounding may take it past an end.
    fn invert<L: Lanes>(cut: &Truncated<L>, from_lo: L, from_hi: L) -> L;

    /// The points at a cdf of `v` from either end, the lower one first; roughly will do, as this places nodes.
    #[inline(always)]
    fn invert_both<L: Lanes>(cut: &Truncated<L>, v: f32) -> [L; 2] {
        let (v, rest) = (L::splat(v), L::splat(1.0 - v));
        [Self::invert(cut, v, rest), Self::invert(cut, rest, v)]
    }
}

/// A Gaussian cut to an interval: masses are probabilities, the ends those beyond the interval.
///
/// - Accuracy: a point's cdf is that asked for to 2e-7, and to 5e-5 of its distance from the nearer end of the line.
impl MatchedBell for Gaussian {
    /// `sqrt(2 pi)`.
    const UNIT: f32 = 2.506_628_3;

    #[inline(always)]
    fn truncate<L: Lanes>(lo: L, hi: L) -> Truncated<L> {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let (beyond_lo, beyond_hi) = (tail(lo), tail(hi));
        let (above, below) = (zero.lt(lo), hi.lt(zero));
        // Off its centre the mass is a difference of small tails, not of numbers next to 1.
        let outside = L::select(above, beyond_lo - beyond_hi, beyond_hi - beyond_lo);
        let mass = L::select(L::or(above, below), outside, one - (beyond_lo + beyond_hi));
        let mass = zero.max(mass);
        Truncated {
            mass,
            inv_mass: L::select(zero.lt(mass), one / mass, zero),
            ends: [L::select(above, one - beyond_lo, beyond_lo), L::select(below, one - beyond_hi, beyond_hi)],
        }
    }

    #[inline(always)]
    fn locate<L: Lanes>(cut: &Truncated<L>, x: L, bell: L) -> (L::Mask, L) {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let negative = x.lt(zero);
        let tail = normal_tail_ratio(x.abs()) * bell;
        // Distance from the end on the side of x, by tails: it may be the farther one.
        let from_end = (tail - L::select(negative, cut.ends[0], cut.ends[1])) * cut.inv_mass;
        let side = L::negate(negative, L::splat(0.5) - from_end);
        (side.lt(zero), zero.max(from_end.min(one - from_end)))
    }

    #[inline(always)]
    fn invert<L: Lanes>(cut: &Truncated<L>, from_lo: L, from_hi: L) -> L {
        let least = L::splat(LEAST_SHARE);
        let below = from_lo.max(least).mul_add(cut.mass, cut.ends[0]);
        let above = from_hi.max(least).mul_add(cut.mass, cut.ends[1]);
        normal_tail_inverse(below.min(above)).times_sign(below - above)
    }
}

/// A quarter of the step between uniform numbers of 24 bits, which a cdf is kept from its ends: the very end of a Gaussian
/// would be where it has no density left.
const LEAST_SHARE: f32 = f32::EPSILON / 8.0;

/// The probability of a standard normal number beyond `x`, away from 0.
#[inline(always)]
fn tail<L: Lanes>(x: L) -> L {
    normal_tail_ratio(x.abs()) * gaussian(x * x)
}
