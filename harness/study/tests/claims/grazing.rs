//! The grazing discard.

use core::f64::consts::FRAC_PI_2;
use hairis::{HairParams, Lobe};
use hairis_reference::{HairReference, Reference, Shape};
use hairis_study::claims::grazing::*;
use hairis_study::claims::hair::Longitudinal;

#[test]
fn beyond_the_cap_it_is_the_reference() {
    let params = HairParams::bright();
    let p = params.desc().map(f64::from);
    for (theta_o, delta) in [(0.3_f64, 2e-5_f64), (-1.2, 0.4), (1.5, 1.1)] {
        let hair = HairReference::prepare(&p, Shape::Cauchy, [theta_o.sin(), theta_o.cos(), 0.0]);
        for sign in [-1.0, 1.0] {
            let wi = [sign * delta.cos(), delta.sin(), 0.0];
            let want = hair.lobe_values(wi)[Lobe::TRT] * delta.sin() * delta.sin();
            assert!(
                (Longitudinal::of(&p, 2, theta_o).energy_at(Shape::Cauchy, sign, delta) / want
                    - 1.0)
                    .abs()
                    < 1e-9,
                "{theta_o} {delta}"
            );
        }
    }
}

#[test]
fn a_narrow_lobe_loses_the_cube_of_the_cap() {
    // Integral of x^2 exp(-x^2 / 2 s^2) over [0, e], divided by that over the half line, for e far below s: (e/s)^3 / 3 / sqrt(pi/2).
    let beta = 2e-3;
    let want = (CAP / (2.0 * beta)).powi(3) / 3.0 / FRAC_PI_2.sqrt();
    let got = pointed(Shape::Gaussian, beta, 0.0);
    assert!((got.value / want - 1.0).abs() < 1e-2, "{got:?} {want}");
}

#[test]
fn few_samples_are_discarded() {
    let got = discarded(&HairParams::bright(), 0.0);
    // Densities of theta_i at the axis are near 0.05 per rad.
    assert!((1e-7..1e-5).contains(&got), "{got}");
}
