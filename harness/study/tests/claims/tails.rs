//! Tails of the bells.

use core::f64::consts::PI;
use hairis_instruments::sequence::Independent;
use hairis_instruments::stats::Moments;
use hairis_reference::Shape;
use hairis_study::claims::tails::*;

#[test]
fn the_added_variance_is_its_closed_form_and_that_of_samples() {
    let got = added(0.0, 0.3, [-REACH, REACH].map(|x| 0.3 * x), Some(0.3 * PI));
    assert!(
        (got.value - (0.75 * PI.sqrt() - 1.0)).abs() < 1e-9 && got.error < 1e-8,
        "{got:?}"
    );
    let mut from = Independent::new(1, 0);
    let weights: Moments = (0..100_000)
        .map(|_| {
            let x = (PI * (from.next_f64() - 0.5)).tan();
            Shape::Gaussian.bell(1.0, x) / Shape::Cauchy.bell(1.0, x)
        })
        .collect();
    let z = weights.relative_variance().z_score(got.value);
    assert!(z.abs() < 4.0, "{z} standard errors");
}

#[test]
fn the_largest_weight_is_at_one_width() {
    assert!((largest_weight() - 2.0 * (-0.5_f64).exp()).abs() < 1e-9);
}
