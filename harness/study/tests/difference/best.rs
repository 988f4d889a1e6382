//! The least of a function.

use core::convert::Infallible;
use hairis_study::difference::best::*;

fn least(f: impl Fn(f64) -> f64) -> f64 {
    let Ok(found) = hairis_study::difference::least(|k| Ok::<_, Infallible>(f(k)));
    found
}

#[test]
fn the_least_is_found_wherever_it_is() {
    for want in [0.6, 1.0, 1.177, 3.7] {
        let found = least(|k| (k / want).ln().powi(2) + 1.0);
        assert!((found / want - 1.0).abs() < 1e-5, "{found} for {want}");
    }
    // If there are two minima, the deeper one is found.
    let found = least(|k| (k - 1.0).powi(2).min((k - 3.0).powi(2) - 0.1));
    assert!((found - 3.0).abs() < 1e-4, "{found}");
    assert!(
        (least(|k| k) / RANGE[0] - 1.0).abs() < 1e-5
            && (least(|k| -k) / RANGE[1] - 1.0).abs() < 1e-5,
        "ends"
    );
}
