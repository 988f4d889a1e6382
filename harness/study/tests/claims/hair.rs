//! Integrals of hair.

use core::f64::consts::FRAC_PI_2;
use hairis::HairParams;
use hairis_harness::efficiency::{Case, by_quadrature};
use hairis_harness::subject::ModelKind;
use hairis_instruments::light::Constant;
use hairis_study::claims::hair::*;

#[test]
fn figures_come_back_from_their_numbers() {
    let numbers = core::array::from_fn(|place| place as f64);
    assert_eq!(HairFigures::from_numbers(numbers).numbers(), numbers);
}

#[test]
fn variances_are_those_of_the_whole_sphere() {
    let params = HairParams::bright();
    for model in ModelKind::ALL {
        for theta_o_deg in [0.0_f64, 45.0, 75.0] {
            let found = Hair::new(model, &params, theta_o_deg.to_radians()).found();
            let want = by_quadrature(&Case::new(model, &params, theta_o_deg), &Constant).v;
            for (got, want) in [found.uniform, found.published].into_iter().zip(want) {
                assert!(
                    (got.value - want).abs() < 1e-5 && got.error < 1e-4,
                    "{model:?}: {got:?} {want}"
                );
            }
        }
    }
}

#[test]
fn a_lobe_alone_loses_what_its_mass_says() {
    // With one lobe, the printed density is the correct one times its mass, so the second moment grows by the inverse of the mass.
    let mut desc = *HairParams::bright().desc();
    (desc.i_tt, desc.i_trt) = ([0.0; 3], [0.0; 3]);
    let params = HairParams::new(&desc).expect("accepted");
    let found = Hair::new(ModelKind::Gaussian, &params, 0.5).found();
    let mass = Longitudinal::of(&params.desc().map(f64::from), 0, 0.5).printed_mass();
    assert!(
        (found.lost - (1.0 - mass)).abs() < 1e-12 && mass < 0.99,
        "{found:?} {mass}"
    );
    assert!(
        ((1.0 + found.published.value) / mass - 1.0 - found.printed.value).abs() < 1e-6,
        "{found:?} {mass}"
    );
    assert!(
        found.uncut_bias.value.abs() < 1e-9,
        "no glints, no bias: {found:?}"
    );
}

#[test]
fn the_printed_mass_is_that_of_the_printed_constants() {
    let (alpha, beta, theta_o) = (-0.1, 0.15, 0.4);
    let span = |[lo, hi]: [f64; 2]| ((hi - alpha) / beta).atan() - ((lo - alpha) / beta).atan();
    let want = span(theta_h_interval(theta_o)) / span([theta_o - FRAC_PI_2, theta_o + FRAC_PI_2]);
    let got = Longitudinal {
        alpha,
        beta,
        theta_o,
    }
    .printed_mass();
    assert!(
        (got - want).abs() < 1e-12 && (got - 0.923).abs() < 5e-4,
        "{got} {want}"
    );
    assert_eq!(
        longitudinal_grid().len(),
        6 * 7 * 3,
        "widths, inclinations and lobes"
    );
}
