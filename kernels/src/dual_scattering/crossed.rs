//! Global part of dual scattering: what crossing fibres does to light on its way to a hit.

use super::Averages;
use crate::model::math::{gaussian, gaussian_and_complement, log2};
use crate::simd::Lanes;
use core::f32::consts::LN_2;

/// Light that has crossed fibres on its way to a hit, as shares of what it was: linear RGB.
///
/// A renderer that knows the fibres on the way begins with [`clear`](Self::clear) and calls [`through`](Self::through) for each. One that
/// knows their number calls [`strands`](Self::strands), and one that knows a density [`depth`](Self::depth).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossed<L = f32> {
    /// Share of the light that has crossed no fibre.
    pub direct: L,
    /// Share of the light that fibres have scattered forward, without the factor of [`GAIN`](super::GAIN).
    pub scattered: [L; 3],
    /// Mean of the inclinations that the scattered light was shifted by, rad.
    pub shift: [L; 3],
    /// Variance of these, rad^2.
    pub variance: [L; 3],
}

impl<L: Lanes> Crossed<L> {
    /// Light that has crossed nothing.
    #[inline(always)]
    #[must_use]
    pub fn clear() -> Self {
        let none = [L::splat(0.0); 3];
        Self {
            direct: L::splat(1.0),
            scattered: none,
            shift: none,
            variance: none,
        }
    }

    /// Returns the light after one more fibre, which scatters by these averages at the inclination of the light on it.
    #[inline(always)]
    #[must_use]
    pub fn through(&self, fibre: &Averages<L>) -> Self {
        let mut after = Self {
            direct: L::splat(0.0),
            ..*self
        };
        let side = &fibre.forward;
        let mut c = 0;
        while c < 3 {
            after.scattered[c] = (self.scattered[c] + self.direct) * side.albedo[c];
            after.shift[c] = self.shift[c] + side.shift[c];
            after.variance[c] = self.variance[c] + side.variance[c];
            c += 1;
        }
        after
    }

    /// Returns the light that has crossed `count` fibres, 0 or more, all with these averages. Below 1 it is the share of the light that has
    /// crossed one fibre.
    #[inline(always)]
    #[must_use]
    pub fn strands(fibre: &Averages<L>, count: L) -> Self {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let count = count.max(zero);
        let side = &fibre.forward;
        let (part, whole) = (count.min(one), count.max(one));
        let mut crossed = Self::clear();
        crossed.direct = one - part;
        let mut c = 0;
        while c < 3 {
            crossed.scattered[c] = part * power(side.albedo[c], whole);
            crossed.shift[c] = whole * side.shift[c];
            crossed.variance[c] = whole * side.variance[c];
            c += 1;
        }
        crossed
    }

    /// Returns the light that has come through hair of an optical depth: the mean number of fibres on its way, which cross it by chance, all
    /// with these averages. The number is then Poisson's, and the shares are means over it.
    #[inline(always)]
    #[must_use]
    pub fn depth(fibre: &Averages<L>, depth: L) -> Self {
        let (zero, one, two) = (L::splat(0.0), L::splat(1.0), L::splat(2.0));
        let depth = depth.max(zero);
        let side = &fibre.forward;
        let mut crossed = Self::clear();
        crossed.direct = gaussian(two * depth);
        let mut c = 0;
        while c < 3 {
            let albedo = side.albedo[c].min(one);
            let all = gaussian(two * (depth * (one - albedo)));
            let crossings = depth * albedo;
            let (_, at_least_one) = gaussian_and_complement(two * crossings);
            let scattered = all * at_least_one;
            // Mean number of the fibres that light with at least one has crossed.
            let least = L::splat(1e-30);
            let count = L::quotient(crossings.max(least), at_least_one.max(least));
            crossed.scattered[c] = scattered;
            crossed.shift[c] = count * side.shift[c];
            crossed.variance[c] = count * side.variance[c];
            c += 1;
        }
        crossed
    }
}

/// Computes `x^n` for `x` in `[0, 1]` and `n >= 1`; 0 below `2^-115`.
#[inline(always)]
fn power<L: Lanes>(x: L, n: L) -> L {
    let x = x.min(L::splat(1.0));
    let some = L::splat(1e-30);
    L::keep(
        some.lt(x),
        gaussian((log2(x.max(some)) * n * (-2.0 * LN_2)).max(L::splat(0.0))),
    )
}
