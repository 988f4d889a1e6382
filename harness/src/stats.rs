//! Statistics of estimators and of timings: figures with error bars from columns of numbers.
//!
//! - [`Moments`]: running central moments up to the fourth, mergeable; mean, variance and relative variance with their standard errors.
//! - [`Spread`]: median, quartiles and median absolute deviation of timing samples.
//! - [`chi_square`], [`ks_statistic`], [`sidak`]: goodness of fit of samples to a density.
//!
//! All numbers are `f64`. Nothing here draws random numbers or reads a clock.

mod goodness;
mod moments;
mod special;
mod spread;

pub use goodness::{ChiSquare, chi_square, ks_p_value, ks_statistic, sidak};
pub use moments::{Estimate, Moments};
pub use special::regularised_gamma_q;
pub use spread::{Spread, percentile};

/// Two-sided p-value of a standard normal deviate.
///
/// - Units: `z` in standard errors; the result is a probability.
/// - Domain: any `z`; NaN gives NaN.
#[must_use]
pub fn z_p_value(z: f64) -> f64 {
    libm::erfc(z.abs() * core::f64::consts::FRAC_1_SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn z_p_values_match_the_normal_table() {
        for (z, p) in
            [(0.0, 1.0), (1.0, 0.317_310_507_862_914), (1.959_963_984_540_054, 0.05), (4.0, 6.334_248_366_623_996e-5)]
        {
            assert!((z_p_value(z) - p).abs() <= 1e-12, "z {z}: {}", z_p_value(z));
            assert_eq!(z_p_value(z), z_p_value(-z));
        }
    }
}
