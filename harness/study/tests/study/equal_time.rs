//! Gains in equal time.

use hairis_instruments::stats::Estimate;
use hairis_study::study::equal_time::*;

fn of(value: f64, standard_error: f64) -> Estimate {
    Estimate {
        value,
        standard_error,
    }
}

#[test]
fn words_need_two_standard_errors() {
    let sign = |value, error| Sign::of(of(value, error));
    assert_eq!(
        [sign(1.1, 0.04), sign(1.1, 0.06), sign(0.9, 0.04)],
        [Sign::Above, Sign::Unsure, Sign::Below]
    );
    assert_eq!(sign(f64::NAN, 0.1), Sign::Unsure, "no number tells nothing");
    assert_eq!(
        sign(2.0, f64::NAN),
        Sign::Unsure,
        "nor does one without an error"
    );
}

#[test]
fn what_follows_brings_times_together_and_its_error_nearly_cancels() {
    let (base, other) = (of(10.0, 0.1), of(20.0, 0.1));
    let alone = time_ratio([base, other], NOTHING);
    assert_eq!(alone, base.ratio(&other));
    let with = time_ratio([base, other], of(20.0, 0.0));
    assert!((with.value - 0.75).abs() < 1e-15, "{with:?}");
    assert!(
        (with.standard_error / 0.75 - (0.1_f64 / 30.0).hypot(0.1 / 40.0)).abs() < 1e-15,
        "{with:?}"
    );
    // The change of the ratio if the time that follows is one error longer.
    let moved = time_ratio([base, other], of(20.001, 0.0)).value - with.value;
    let error = time_ratio([of(10.0, 0.0), of(20.0, 0.0)], of(20.0, 0.001)).standard_error;
    assert!((error / moved.abs() - 1.0).abs() < 1e-4, "{error} {moved}");
}

#[test]
fn cells_are_won_and_lost_beyond_the_errors_of_variance_and_time() {
    let gains = [
        Some(of(2.1, 0.01)),
        Some(of(1.9, 0.01)),
        Some(of(2.01, 0.01)),
        Some(of(2.1, 0.1)),
        None,
    ];
    assert_eq!(count_cells(gains.into_iter(), of(0.5, 0.0)), [1, 3, 1]);
    assert_eq!(
        count_cells(gains.into_iter(), of(0.5, 0.05)),
        [0, 5, 0],
        "times with errors of a tenth"
    );
}
