//! Statistics of estimators and of timings: figures with error bars from columns of numbers.
//!
//! - [`Moments`]: running central moments up to the fourth; mean, variance and relative variance with their standard errors.
//! - [`percentile`]: order statistics.
//! - [`sidak`]: the correction for many tests.
//!
//! All numbers are `f64`. Nothing here draws random numbers or reads a clock.

mod moments;
mod spread;

pub use moments::{Estimate, Moments};
pub use spread::percentile;

/// Significance for each of `tests` independent tests, such that all together keep `alpha`.
///
/// Sidak's `1 - (1 - alpha)^(1/tests)`, without cancellation.
///
/// - Domain: `alpha` in [0, 1]; no tests count as one.
#[must_use]
pub fn sidak(alpha: f64, tests: usize) -> f64 {
    -((-alpha).ln_1p() / tests.max(1) as f64).exp_m1()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sidak_is_between_alpha_over_n_and_alpha() {
        assert!((sidak(0.05, 1) - 0.05).abs() < 1e-16);
        assert!((sidak(0.05, 10) - 0.005_116_196_891_823_743).abs() < 1e-15);
        assert!((sidak(0.01, 1_000_000) / 1e-8 - 1.005_033_6).abs() < 1e-6);
        assert!((sidak(0.01, 0) - 0.01).abs() < 1e-16);
    }
}
