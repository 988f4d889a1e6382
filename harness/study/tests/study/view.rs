//! Views of rows.

use hairis_instruments::stats::Estimate;
use hairis_study::study::view::*;

fn v(value: f64, standard_error: f64) -> Estimate {
    Estimate {
        value,
        standard_error,
    }
}

#[test]
fn gains_are_geometric_and_leave_out_what_is_unsure() {
    let nan = v(f64::NAN, f64::NAN);
    let pairs = [
        [v(2.0, 0.02), v(1.0, 0.0)],
        [v(8.0, 0.08), v(1.0, 0.0)],
        [v(1.0, 0.0), v(100.0, 30.0)],
        [nan, v(1.0, 0.0)],
    ];
    let gain = gain(pairs.into_iter()).expect("two cells");
    assert!((gain.geometric_mean.value - 4.0).abs() < 1e-12);
    assert!((gain.geometric_mean.standard_error - 4.0 * 0.01 / 2.0_f64.sqrt()).abs() < 1e-12);
    assert_eq!(
        (gain.least.value, gain.most.value, gain.unsure),
        (2.0, 8.0, 2)
    );
    assert_eq!(
        (gain.median.value, gain.quartiles, gain.shares),
        (2.0, [2.0, 2.0], [0.5, 0.0])
    );
    assert_eq!(
        hairis_study::study::gain([[nan, nan]].into_iter()),
        None,
        "nothing is sure"
    );
}
