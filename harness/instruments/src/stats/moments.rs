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
