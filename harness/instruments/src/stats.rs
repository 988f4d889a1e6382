//! Statistics of estimators and of timings, which turn columns of numbers into figures with error bars.
//!
//! - [`Moments`]: running central moments up to the fourth, with the mean, the variance and the relative variance; means and relative
//!   variances have standard errors.
//! - [`percentile`]: order statistics of sorted samples.
//! - [`sidak`]: correction of the significance for many tests.
//!
//! All numbers are `f64`. Nothing in this module draws random numbers or reads a clock.

mod moments;
mod spread;

pub use moments::{Estimate, Moments};
pub use spread::percentile;

/// Returns the significance for each of `tests` independent tests with which all of them together have the significance `alpha`.
///
/// The result is Sidak's `1 - (1 - alpha)^(1/tests)`, computed without cancellation.
///
/// - Domain: `alpha` in [0, 1]; no tests count as one.
#[must_use]
pub fn sidak(alpha: f64, tests: usize) -> f64 {
    -((-alpha).ln_1p() / tests.max(1) as f64).exp_m1()
}
