//! Numbers with a bound on their error: arithmetic, integrals, and the spread of a collection.

use core::array;
use core::iter::Sum;
use hairis_instruments::quadrature::{Tolerance, bell_breakpoints, integrate};
use hairis_instruments::stats::Estimate;

/// Number with a bound estimate of its error. Arithmetic carries the error to first order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounded {
    /// Number.
    pub value: f64,
    /// Bound estimate of the error.
    pub error: f64,
}

impl Bounded {
    pub(super) const fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// Returns the product with another number.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        let error = (self.value * other.error).abs() + (other.value * self.error).abs();
        Self {
            value: self.value * other.value,
            error,
        }
    }

    /// Returns the quotient by another number.
    #[must_use]
    pub fn over(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self {
            value,
            error: (self.error + (value * other.error).abs()) / other.value.abs(),
        }
    }

    /// Returns the sum with an exact number.
    #[must_use]
    pub fn plus(self, exact: f64) -> Self {
        Self {
            value: self.value + exact,
            ..self
        }
    }

    /// Returns the magnitude.
    #[must_use]
    pub fn magnitude(self) -> Self {
        Self {
            value: self.value.abs(),
            ..self
        }
    }
}

impl Sum for Bounded {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::exact(0.0), |a, b| Self {
            value: a.value + b.value,
            error: a.error + b.error,
        })
    }
}

impl From<Estimate> for Bounded {
    fn from(
        Estimate {
            value,
            standard_error: error,
        }: Estimate,
    ) -> Self {
        Self { value, error }
    }
}

/// Integrates from the first to the last of `ends`, with breakpoints at each of `ends` and around a bell.
pub(super) fn integrals<const N: usize>(
    f: impl FnMut(f64) -> [f64; N],
    ends: &[f64],
    centre: f64,
    width: f64,
) -> [Bounded; N] {
    let [lo, hi] = [ends[0], ends[ends.len() - 1]];
    let bell = bell_breakpoints(centre, width)
        .into_iter()
        .filter(|x| (lo..=hi).contains(x));
    let breakpoints: Vec<f64> = ends.iter().copied().chain(bell).collect();
    let r = integrate(f, &breakpoints, &Tolerance::default());
    array::from_fn(|k| Bounded {
        value: r.value[k],
        error: r.error[k],
    })
}

/// Least, largest and geometric mean of a collection, or NaN if it is empty. Among equals, the first counts.
#[derive(Clone, Copy, Debug)]
pub struct Spread {
    /// Least number.
    pub least: Bounded,
    /// Largest number.
    pub most: Bounded,
    /// Geometric mean.
    pub mean: Bounded,
}

impl FromIterator<Bounded> for Spread {
    fn from_iter<I: IntoIterator<Item = Bounded>>(all: I) -> Self {
        let none = Bounded {
            value: f64::NAN,
            error: f64::NAN,
        };
        let (mut least, mut most) = (none, none);
        let (mut logarithms, mut relative, mut n) = (0.0, 0.0, 0.0);
        for next in all {
            least = if next.value >= least.value {
                least
            } else {
                next
            };
            most = if next.value <= most.value { most } else { next };
            logarithms += next.value.ln();
            relative += next.error / next.value;
            n += 1.0;
        }
        let value = f64::exp(logarithms / n);
        Self {
            least,
            most,
            mean: Bounded {
                value,
                error: value * relative / n,
            },
        }
    }
}

/// Returns the largest number, the first among equals, or NaN if there is none.
pub fn largest(all: impl IntoIterator<Item = Bounded>) -> Bounded {
    all.into_iter().collect::<Spread>().most
}
