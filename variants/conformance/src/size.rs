//! Sizes of a test run: a factor on the counts of cases that tests are written with.

use std::sync::OnceLock;

/// Factor of a run that a person waits for.
const USUAL: f64 = 0.25;

/// Returns the factor of this run: `HAIRIS_CASES`, or [`USUAL`]. The variable is read once.
fn factor() -> f64 {
    static FACTOR: OnceLock<f64> = OnceLock::new();
    *FACTOR.get_or_init(|| match std::env::var_os("HAIRIS_CASES") {
        Some(text) => parsed(&text.to_string_lossy()).unwrap_or_else(|message| panic!("{message}")),
        None => USUAL,
    })
}

/// Returns the factor that a text states.
///
/// # Errors
///
/// Returns the refusal, with the text, if it is not a finite number above 0.
fn parsed(text: &str) -> Result<f64, String> {
    let factor = text.parse().ok();
    let factor = factor.filter(|factor: &f64| factor.is_finite() && *factor > 0.0);
    factor.ok_or_else(|| {
        format!("HAIRIS_CASES must be a finite number above 0, got {text:?}: 1 runs the counts written in the tests, as CI does")
    })
}

/// Returns the number of cases of a test that is written with `count` of them: as many with `HAIRIS_CASES=1`, which CI sets, a multiple with
/// another value, and a quarter without the variable. The number is at least 1.
///
/// # Panics
///
/// Panics if the environment variable `HAIRIS_CASES` is not a finite number above 0.
#[must_use]
pub fn cases(count: usize) -> usize {
    times(factor(), count)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a cast saturates, and the product is positive"
)]
fn times(factor: f64, count: usize) -> usize {
    ((count as f64 * factor).round() as usize).max(1)
}

/// Returns true if tests run at least the counts that they are written with, as in CI.
///
/// # Panics
///
/// Panics if the environment variable `HAIRIS_CASES` is not a finite number above 0.
#[must_use]
pub fn is_full() -> bool {
    factor() >= 1.0
}

/// Returns true for the numbers from 0 that a test keeps, by which it leaves out points of a grid: for all of them with `HAIRIS_CASES=1`, and
/// for every fourth without the variable. A grid passes the sum of its indices, so that each row leaves out others.
///
/// # Panics
///
/// Panics if the environment variable `HAIRIS_CASES` is not a finite number above 0.
#[must_use]
pub fn is_kept(number: usize) -> bool {
    is_kept_of(1.0, number)
}

/// Returns true for the numbers that a test keeps of a grid of which it has this share with `HAIRIS_CASES=1`.
pub(crate) fn is_kept_of(share: f64, number: usize) -> bool {
    keeps(share * factor(), number)
}

fn keeps(factor: f64, number: usize) -> bool {
    let before = |number: usize| (number as f64 * factor).floor();
    before(number + 1) > before(number)
}

/// Returns the lengths of slices up to `longest` that a test tries: the shortest, and the eight longest.
pub(crate) fn lengths(longest: usize) -> impl Iterator<Item = usize> {
    (0..=longest).filter(move |length| *length <= cases(longest) || longest - length < 8)
}

#[cfg(test)]
mod tests {
    use super::{keeps, parsed, times};

    #[test]
    fn factors_are_numbers_above_0() {
        assert_eq!(parsed("1"), Ok(1.0));
        assert_eq!(parsed("0.25"), Ok(0.25));
        for text in ["", "0", "-1", "NaN", "inf", "1x", "a quarter"] {
            let refusal = parsed(text).expect_err("no factor");
            assert!(
                refusal.starts_with("HAIRIS_CASES ") && refusal.contains(&format!("{text:?}")),
                "{refusal}"
            );
        }
    }

    #[test]
    fn counts_are_multiplied_and_at_least_1() {
        assert_eq!(
            [1, 2, 3, 4000].map(|count| times(0.25, count)),
            [1, 1, 1, 1000]
        );
        assert_eq!([1, 7, 4000].map(|count| times(1.0, count)), [1, 7, 4000]);
        assert_eq!(times(4.0, 7), 28);
    }

    #[test]
    fn a_share_of_the_numbers_is_kept() {
        let kept = |factor: f64| (0..1000).filter(|n| keeps(factor, *n)).count();
        assert_eq!([0.25, 0.5, 1.0, 4.0].map(kept), [250, 500, 1000, 1000]);
    }
}
