//! Running central moments, and the figures computed from them with their standard errors.

use serde::Serialize;

/// Figure with its standard error, both in the unit of the figure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Value of the figure.
    pub value: f64,
    /// Standard error of the figure; NaN for too few samples.
    pub standard_error: f64,
}

impl Estimate {
    /// Estimate of a figure that is not known: both numbers are NaN.
    pub const UNKNOWN: Self = Self {
        value: f64::NAN,
        standard_error: f64::NAN,
    };

    /// Returns the estimate of a figure that is known exactly, with an error of 0.
    #[must_use]
    pub const fn exact(value: f64) -> Self {
        Self {
            value,
            standard_error: 0.0,
        }
    }

    /// Returns the signed distance from `truth` in standard errors.
    ///
    /// - Units: dimensionless.
    /// - Domain: 0 if the estimate is exactly `truth`, whatever its error; infinite if it differs and the error is 0.
    #[must_use]
    pub fn z_score(&self, truth: f64) -> f64 {
        let d = self.value - truth;
        if d == 0.0 {
            0.0
        } else {
            d / self.standard_error
        }
    }

    /// Returns the quotient of two independent estimates, with its first-order standard error.
    ///
    /// The squares of the relative errors add, which is accurate while the divisor's relative error stays below about 0.1.
    #[must_use]
    pub fn ratio(&self, divisor: &Self) -> Self {
        self.combined(divisor, self.value / divisor.value)
    }

    /// Returns the product of two independent estimates, with its first-order standard error. The error is NaN if one of them is 0.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        self.combined(other, self.value * other.value)
    }

    /// Returns the estimate of a product or quotient `value`, for which the squares of the relative errors add.
    fn combined(&self, other: &Self, value: f64) -> Self {
        let relative = (self.standard_error / self.value).hypot(other.standard_error / other.value);
        Self {
            value,
            standard_error: (value * relative).abs(),
        }
    }

    /// Returns the estimate multiplied by an exact number, with its error scaled alike.
    #[must_use]
    pub fn scale(&self, factor: f64) -> Self {
        Self {
            value: self.value * factor,
            standard_error: (self.standard_error * factor).abs(),
        }
    }

    /// Returns the number of effective samples in 1000, `1000 / (1 + V)`, for this estimate of the relative variance V.
    #[must_use]
    pub fn effective_per_1000(&self) -> Self {
        let value = 1e3 / (1.0 + self.value);
        Self {
            value,
            standard_error: value * self.standard_error / (1.0 + self.value),
        }
    }

    /// Returns the geometric mean of independent estimates of positive figures, or NaN without estimates.
    #[must_use]
    pub fn geometric_mean(estimates: &[Self]) -> Self {
        let n = estimates.len() as f64;
        let value = (estimates.iter().map(|one| one.value.ln()).sum::<f64>() / n).exp();
        let squares = estimates
            .iter()
            .map(|one| (one.standard_error / one.value).powi(2))
            .sum::<f64>();
        Self {
            value,
            standard_error: value * squares.sqrt() / n,
        }
    }
}

/// Running count and mean of samples, with their central moment sums up to the fourth.
///
/// `push` is Welford's update, extended to fourth order.
///
/// - Source: Pebay 2008, Formulas for robust, one-pass parallel computation of covariances and arbitrary-order statistical moments.
///
/// # Examples
/// ```
/// use hairis_instruments::stats::Moments;
/// let m: Moments = [1.0, 2.0, 3.0, 4.0].into_iter().collect();
/// assert_eq!(m.mean(), 2.5);
/// assert!((m.variance() - 5.0 / 3.0).abs() < 1e-15, "divides by n - 1");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Moments {
    count: u64,
    mean: f64,
    sum_sq: f64,
    sum_cube: f64,
    sum_fourth: f64,
}

impl Moments {
    /// Makes the moments of an empty set of samples.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a sample. A NaN or an infinity is never dropped, so it makes every later figure NaN.
    #[inline]
    pub fn push(&mut self, x: f64) {
        let n1 = self.count as f64;
        self.count += 1;
        let n = self.count as f64;
        let delta = x - self.mean;
        let delta_n = delta / n;
        let delta_n_sq = delta_n * delta_n;
        let term = delta * delta_n * n1;
        self.mean += delta_n;
        self.sum_fourth += term * delta_n_sq * (n * n - 3.0 * n + 3.0)
            + 6.0 * delta_n_sq * self.sum_sq
            - 4.0 * delta_n * self.sum_cube;
        self.sum_cube += term * delta_n * (n - 2.0) - 3.0 * delta_n * self.sum_sq;
        self.sum_sq += term;
    }

    /// Returns the number of samples that were added.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Returns the mean of the samples, or 0 without samples.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Returns the unbiased sample variance (divisor n - 1), in the unit of the samples squared, or NaN for fewer than two samples.
    #[must_use]
    pub fn variance(&self) -> f64 {
        if self.count < 2 {
            return f64::NAN;
        }
        self.sum_sq / (self.count - 1) as f64
    }

    /// Returns the third and fourth central moments (divisor n), in the unit of the samples to the third and fourth power.
    #[must_use]
    pub fn higher_moments(&self) -> [f64; 2] {
        let n = self.count as f64;
        [self.sum_cube / n, self.sum_fourth / n]
    }

    /// Returns the mean of the samples with its standard error `sqrt(variance / n)`.
    #[must_use]
    pub fn mean_estimate(&self) -> Estimate {
        Estimate {
            value: self.mean,
            standard_error: (self.variance() / self.count as f64).sqrt(),
        }
    }

    /// Returns the relative variance `V = variance / mean^2` of one sample, with its standard error by the delta method.
    ///
    /// `n var(V) = (m4 - s^4)/mean^4 - 4 s^2 m3/mean^5 + 4 s^6/mean^6`, from `n var(s^2) = m4 - s^4`, `n cov(mean, s^2) = m3` and
    /// `n var(mean) = s^2`.
    ///
    /// The error is of first order in 1/n. With a heavy right tail (largest weight far above the samples so far) the error itself is
    /// underestimated. Compare figures only from estimators whose weights are bounded, or at sizes where two halves of the run agree.
    ///
    /// - Units: dimensionless.
    /// - Domain: NaN for fewer than two samples, and if the mean is 0.
    #[must_use]
    pub fn relative_variance(&self) -> Estimate {
        let s2 = self.variance();
        let m = self.mean;
        if self.count < 2 || m == 0.0 {
            return Estimate::UNKNOWN;
        }
        let [m3, m4] = self.higher_moments();
        let v = s2 / (m * m);
        // Each term is written in units of the mean, so that tiny radiances do not underflow.
        let skew = m3 / m / (m * m);
        let kurt = m4 / (m * m) / (m * m);
        let n_var = kurt - v * v - 4.0 * v * skew + 4.0 * v * v * v;
        Estimate {
            value: v,
            standard_error: (n_var.max(0.0) / self.count as f64).sqrt(),
        }
    }
}

impl FromIterator<f64> for Moments {
    fn from_iter<I: IntoIterator<Item = f64>>(samples: I) -> Self {
        let mut m = Self::new();
        for x in samples {
            m.push(x);
        }
        m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sequence::Independent;

    fn exponential(xi: &mut Independent) -> f64 {
        -(1.0 - xi.next_f64()).ln()
    }

    #[test]
    fn known_small_set() {
        let m: Moments = [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]
            .into_iter()
            .collect();
        assert_eq!(m.count(), 8);
        assert!((m.mean() - 5.0).abs() < 1e-15);
        assert!((m.variance() - 32.0 / 7.0).abs() < 1e-14);
        let [m3, m4] = m.higher_moments();
        // Sums of cubes and fourth powers of (-3,-1,-1,-1,0,0,2,4): 42 and 356.
        assert!((m3 - 42.0 / 8.0).abs() < 1e-13, "third {m3}");
        assert!((m4 - 356.0 / 8.0).abs() < 1e-13, "fourth {m4}");
    }

    #[test]
    fn a_large_offset_does_not_eat_the_variance() {
        let mut xi = Independent::new(3, 1);
        let moments: Moments = (0..5_000).map(|_| 1e6 + exponential(&mut xi)).collect();
        assert!(
            (moments.variance() - 1.0).abs() < 0.15,
            "{}",
            moments.variance()
        );
    }

    #[test]
    fn relative_variance_error_covers_as_a_standard_error_should() {
        // 2000 runs of 1000 samples. The mean of z and its variance have standard errors of 0.022 and about 0.035; the bounds leave room
        // for the order 1/sqrt(n) bias of the delta method (-0.14 and 1.16 measured for the exponential, -0.005 and 0.996 for the uniform).
        type Draw = fn(&mut Independent) -> f64;
        let uniform: Draw = |xi| xi.next_f64();
        let cases: [(Draw, f64, f64, &str); 2] = [
            (exponential, 1.0, 4.0, "exponential"),
            (uniform, 1.0 / 3.0, 0.237_037_037, "uniform"),
        ];
        for (draw, v, n_var, name) in cases {
            let mut z = Moments::new();
            let mut se = Moments::new();
            for run in 0..2_000 {
                let mut xi = Independent::new(11, run);
                let m: Moments = (0..1_000).map(|_| draw(&mut xi)).collect();
                let e = m.relative_variance();
                z.push(e.z_score(v));
                se.push(e.standard_error);
            }

            assert!(z.mean().abs() < 0.2, "{name}: mean z {}", z.mean());
            assert!(
                (z.variance() - 1.0).abs() < 0.25,
                "{name}: variance of z {}",
                z.variance()
            );
            let want = (n_var / 1_000.0_f64).sqrt();
            assert!(
                (se.mean() / want - 1.0).abs() < 0.05,
                "{name}: mean error {} want {want}",
                se.mean()
            );
        }
    }

    #[test]
    fn degenerate_inputs() {
        assert!(Moments::new().variance().is_nan());
        assert!(Moments::new().relative_variance().value.is_nan());
        let one: Moments = [2.0].into_iter().collect();
        assert!(one.variance().is_nan() && one.mean() == 2.0);
        let zero: Moments = [0.0, 0.0].into_iter().collect();
        assert!(zero.relative_variance().value.is_nan());
        let constant: Moments = [3.0; 10].into_iter().collect();
        assert_eq!(
            constant.relative_variance(),
            Estimate {
                value: 0.0,
                standard_error: 0.0
            }
        );
        let tiny: Moments = [1e-70, 3e-70].into_iter().collect();
        assert!((tiny.relative_variance().value - 0.5).abs() < 1e-12);
        assert!(
            [1.0, f64::NAN]
                .into_iter()
                .collect::<Moments>()
                .mean()
                .is_nan()
        );
    }

    #[test]
    fn estimates_combine() {
        let a = Estimate {
            value: 6.0,
            standard_error: 0.3,
        };
        let b = Estimate {
            value: 2.0,
            standard_error: 0.1,
        };
        let r = a.ratio(&b);
        assert!(
            (r.value - 3.0).abs() < 1e-15
                && (r.standard_error - 3.0 * 0.05 * 2.0_f64.sqrt()).abs() < 1e-15
        );
        let p = a.times(&b);
        assert!(
            (p.value - 12.0).abs() < 1e-15
                && (p.standard_error - 12.0 * 0.05 * 2.0_f64.sqrt()).abs() < 1e-15
        );
        let mean = Estimate::geometric_mean(&[a, b]);
        assert!((mean.value * mean.value - 12.0).abs() < 1e-14, "{mean:?}");
        assert!(
            (2.0 * mean.standard_error / mean.value - 0.05 * 2.0_f64.sqrt()).abs() < 1e-15,
            "{mean:?}"
        );
        assert!(Estimate::geometric_mean(&[]).value.is_nan());
        let effective = Estimate {
            value: 3.0,
            standard_error: 0.4,
        }
        .effective_per_1000();
        assert_eq!((effective.value, effective.standard_error), (250.0, 25.0));
        assert_eq!(
            a.scale(-2.0),
            Estimate {
                value: -12.0,
                standard_error: 0.6
            }
        );
        assert_eq!(
            Estimate {
                value: 1.0,
                standard_error: 0.0
            }
            .z_score(1.0),
            0.0
        );
        assert_eq!(a.z_score(5.4), (6.0 - 5.4) / 0.3);
    }
}
