//! The logarithm and the tails of the normal distribution.

use super::POINTS;
use crate::support::narrow;
use crate::tolerance as bound;
use hairis::model::math::{gaussian, log2, normal_tail, normal_tail_inverse, normal_tail_ratio};
use hairis_conformance::comparison::LargestError;
use hairis_reference::Real;

/// Probability that a standard normal number is above `x`.
fn above(x: f64) -> f64 {
    0.5 * Real::erfc(x / 2.0_f64.sqrt())
}

/// The last argument collects what eight lanes and one differ by; it is bounded by the error of either.
#[test]
fn logarithm_and_normal_tails_are_accurate() {
    let (mut worst, mut lanes): ([LargestError; 4], LargestError) = Default::default();
    for i in 0..POINTS {
        let share = f64::from(i) / f64::from(POINTS);
        let x = narrow((-126.0 + 253.0 * share).exp2());
        let want = f64::from(x).log2();
        let got = both!([x, 0.0], |[x, _]| log2(x), &mut lanes);
        worst[0].see((f64::from(got) - want).abs() / (1.0 + want.abs()), || {
            format!("{x}")
        });
        let x = narrow(12.6 * share);
        let want = above(f64::from(x)) * (f64::from(x).powi(2) / 2.0).exp();
        let got = both!([x, 0.0], |[x, _]| normal_tail_ratio(x), &mut lanes);
        worst[1].see((f64::from(got) / want - 1.0).abs(), || format!("{x}"));
        assert_eq!(
            both!([x, 0.0], |[x, _]| normal_tail(x), &mut lanes),
            got * gaussian(x * x),
            "tail of {x}"
        );
        // Probabilities evenly, and evenly by their logarithm.
        for q in [0.5 * share, (-1.0 - 115.0 * share).exp2()] {
            let q = narrow(q);
            if q > f32::MIN_POSITIVE {
                let error = above(f64::from(both!(
                    [q, 0.0],
                    |[q, _]| normal_tail_inverse(q),
                    &mut lanes
                ))) - f64::from(q);
                worst[2].see(error.abs(), || format!("{q}"));
                worst[3].see(error.abs() / f64::from(q), || format!("{q}"));
            }
        }
    }
    worst[0].check("LOG2, over 1 + |log2|", bound::LOG2);
    worst[1].check("NORMAL_TAIL_RATIO", bound::NORMAL_TAIL_RATIO);
    worst[2].check("NORMAL_TAIL_INVERSE", bound::NORMAL_TAIL_INVERSE[0]);
    worst[3].check(
        "NORMAL_TAIL_INVERSE, relative",
        bound::NORMAL_TAIL_INVERSE[1],
    );
    for x in [0.0, f32::from_bits(1), 0.5, 0.500_000_1] {
        assert!(normal_tail_inverse(x).is_finite(), "inverse tail of {x}");
    }
    for x in [12.7, 1e3, 1e5, 1e9] {
        assert!(normal_tail_ratio(x) >= 0.0, "tail ratio of {x}");
    }
    for x in [12.63, 1e3, 1e30, f32::MAX, f32::INFINITY, f32::NAN] {
        assert_eq!(normal_tail(x), 0.0, "tail of {x}");
    }
}
