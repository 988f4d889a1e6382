//! Bounds of the samplers of M.

use core::f64::consts::FRAC_PI_2;
use hairis_instruments::sequence::Independent;
use hairis_study::claims::hair::Longitudinal;

#[test]
fn samples_are_lost_as_the_mass_says() {
    let (alpha, beta, theta_o) = (-0.13_f64, 0.26_f64, 0.8_f64);
    let [a, b] = [FRAC_PI_2, -FRAC_PI_2].map(|end: f64| ((end + theta_o - alpha) / beta).atan());
    let mut from = Independent::new(4, 0);
    let count = 100_000;
    let drawn = (0..count)
        .map(|_| 2.0 * beta * (from.next_f64() * (a - b) + b).tan() + 2.0 * alpha - theta_o);
    let lost = drawn.filter(|theta_i| theta_i.abs() > FRAC_PI_2).count() as f64 / f64::from(count);
    let want = 1.0
        - Longitudinal {
            alpha,
            beta,
            theta_o,
        }
        .printed_mass();
    let error = (want * (1.0 - want) / f64::from(count)).sqrt();
    assert!(
        (lost - want).abs() < 4.0 * error && want > 0.05,
        "{lost} {want}"
    );
}
