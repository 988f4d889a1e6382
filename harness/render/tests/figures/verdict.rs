//! Tests of `figures::verdict`.

use core::cmp::Ordering;
use hairis_instruments::stats::Estimate;
use hairis_render::figures::verdict::{BELOW, Gain};

#[test]
fn no_gain_is_not_the_same_as_none_found() {
    let gain = |value, standard_error, is_below| Gain {
        ratio: Estimate {
            value,
            standard_error,
        },
        is_below,
    };
    assert!(gain(1.07, 0.01, false).is_none() && gain(0.9, 0.01, false).is_none());
    for unclear in [
        gain(1.07, 0.1, false),
        gain(3.0, 1.5, false),
        gain(1.07, 0.01, true),
        gain(0.9, 0.03, false),
    ] {
        assert!(
            !unclear.is_none() && unclear.side() == Ordering::Equal,
            "{unclear:?}"
        );
    }
    assert_eq!(gain(1.3, 0.1, false).side(), Ordering::Greater);
    assert_eq!(gain(0.5, 0.1, false).side(), Ordering::Less);
    assert!(gain(1.3, 0.1, true).text().ends_with(BELOW));
    assert!(
        !gain(1.0, f64::NAN, false).is_none(),
        "an error that is not known"
    );
}
