//! Numbers with a bound on their error: arithmetic, integrals, and the spread of a collection.

use core::array;
use core::iter::Sum;
use hairis_instruments::quadrature::{Tolerance, bell_breakpoints, integrate};
use hairis_instruments::stats::Estimate;

/// Number with a bound estimate of its error. Arithmetic carries the error to first order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounded {
    pub(super) value: f64,
    pub(super) error: f64,
}

impl Bounded {
    pub(super) const fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    pub(super) fn times(self, other: Self) -> Self {
        let error = (self.value * other.error).abs() + (other.value * self.error).abs();
        Self {
            value: self.value * other.value,
            error,
        }
    }

    pub(super) fn over(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self {
            value,
            error: (self.error + (value * other.error).abs()) / other.value.abs(),
        }
    }

    pub(super) fn plus(self, exact: f64) -> Self {
        Self {
            value: self.value + exact,
            ..self
        }
    }

    pub(super) fn magnitude(self) -> Self {
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
pub(super) struct Spread {
    pub(super) least: Bounded,
    pub(super) most: Bounded,
    pub(super) mean: Bounded,
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
pub(super) fn largest(all: impl IntoIterator<Item = Bounded>) -> Bounded {
    all.into_iter().collect::<Spread>().most
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_carried() {
        let [a, b] = [(6.0, 0.3), (2.0, 0.1)].map(|(value, error)| Bounded { value, error });
        let near = |got: Bounded, value: f64, error: f64| {
            assert!(
                (got.value - value).abs() < 1e-12 && (got.error - error).abs() < 1e-12,
                "{got:?}"
            );
        };
        near(a.times(b), 12.0, 1.2);
        near(a.over(b), 3.0, 0.3);
        near(b.plus(-5.0).magnitude(), 3.0, 0.1);
        near([a, b].into_iter().sum(), 8.0, 0.4);
        let four = [
            Bounded {
                value: 2.0,
                error: 0.02,
            },
            Bounded {
                value: 8.0,
                error: 0.08,
            },
        ];
        near(four.into_iter().collect::<Spread>().mean, 4.0, 0.04);
        let Spread { least, most, .. } = [b, a].into_iter().collect();
        assert_eq!([most, least], [a, b]);
        assert!(largest([]).value.is_nan(), "of nothing");
    }
}
