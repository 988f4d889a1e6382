//! Bell cut to an interval, from which the matched sampler draws.

use super::shape::Shape;
use crate::real::Real;

/// Bell cut to an interval, with its cdf and the inverse of the cdf.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Cut<T> {
    gaussian: bool,
    lo: T,
    hi: T,
    /// Integral of the bell of unit width and peak over the interval.
    pub(crate) area: T,
}

/// Returns the probability that a standard normal number is above `x`.
fn above<T: Real>(x: T) -> T {
    T::from_f64(0.5) * (x / T::from_f64(2.0).sqrt()).erfc()
}

impl<T: Real> Cut<T> {
    /// Makes the bell on `[lo, hi]`, in widths from its centre.
    pub(crate) fn new(shape: Shape, lo: T, hi: T) -> Self {
        let gaussian = shape == Shape::Gaussian;
        let unit = Self {
            gaussian,
            lo,
            hi,
            area: T::from_f64(1.0),
        };
        let area = unit.below(hi);
        // A Gaussian whose every value in the interval is below 2^-115 is 0 to the kernels, and nothing is drawn from it.
        let none = gaussian && lo.max(-hi) > T::from_f64(12.627_1);
        Self {
            area: if none { T::default() } else { area },
            ..unit
        }
    }

    /// Returns the ends of the interval, in widths from the centre.
    pub(crate) fn ends(&self) -> [T; 2] {
        [self.lo, self.hi]
    }

    /// Integrates the bell from `x` to its centre, or to the end of the interval that is next to the centre.
    pub(crate) fn centre_to(&self, x: T) -> T {
        let origin = self.lo.max(T::default().min(self.hi));
        (self.below(x) - self.below(origin)).abs()
    }

    /// Integrates the bell from `lo` to `x`.
    pub(crate) fn below(&self, x: T) -> T {
        let (zero, one) = (T::default(), T::from_f64(1.0));
        if !self.gaussian {
            return (x - self.lo).atan2(one + self.lo * x);
        }
        let probability = if self.lo > zero {
            above(self.lo) - above(x)
        } else if x < zero {
            above(-x) - above(-self.lo)
        } else {
            one - above(x) - above(-self.lo)
        };
        (T::PI + T::PI).sqrt() * probability
    }

    /// Integrates the bell from `x` to `hi`: the rest of [`below`](Self::below), without a difference.
    fn beyond(&self, x: T) -> T {
        Self {
            lo: -self.hi,
            ..*self
        }
        .below(-x)
    }

    /// Returns the probability of a number of at most `x`.
    pub(crate) fn cdf(&self, x: T) -> T {
        let x = x.max(self.lo).min(self.hi);
        let (below, beyond) = (self.below(x), self.beyond(x));
        if below < beyond {
            below / self.area
        } else {
            T::from_f64(1.0) - beyond / self.area
        }
    }

    /// Returns the point whose [`cdf`](Self::cdf) is `xi`: for a Cauchy by turning the nearer end by its part of the angle, and for
    /// a Gaussian by bisection.
    pub(crate) fn sample(&self, xi: T) -> T {
        let (one, half) = (T::from_f64(1.0), T::from_f64(0.5));
        if !self.gaussian {
            let (end, turn) = if xi < half {
                (self.lo, xi * self.area)
            } else {
                (self.hi, -(one - xi) * self.area)
            };
            let (sin, cos) = (turn.sin(), turn.cos());
            return ((end * cos + sin) / (cos - end * sin))
                .max(self.lo)
                .min(self.hi);
        }
        let (mut lo, mut hi) = (self.lo, self.hi);
        for _ in 0..64 {
            let middle = half * (lo + hi);
            if self.cdf(middle) < xi {
                lo = middle;
            } else {
                hi = middle;
            }
        }
        half * (lo + hi)
    }
}
