//! The blur against its integral.

use core::f64::consts::FRAC_PI_2;
use core::f64::consts::PI;
use hairis::HairParams;
use hairis_instruments::direction::fibre_direction;
use hairis_instruments::quadrature::GaussLegendre;
use hairis_study::difference::blur::*;
use hairis_study::difference::lobes::{BellValues, Rule};
use hairis_study::difference::lobes::{Kind, Nodes, ViewedHair};

fn blur() -> Blur {
    Blur::new(SIGMA_DEG.to_radians(), 64, 64)
}

/// Returns a rule without lobes, and a function of `theta` alone on it.
fn plain(f: impl Fn(f64) -> f64) -> (Rule, BellValues) {
    let rule = GaussLegendre::new(128);
    let along: Nodes = rule
        .on(-FRAC_PI_2, FRAC_PI_2)
        .map(|[x, w]| [x, w * x.cos()])
        .collect();
    let around: Nodes = rule.on(0.0, PI).map(|[x, w]| [x, 2.0 * w]).collect();
    let values = BellValues {
        along: along
            .iter()
            .map(|[theta, _]| [f(*theta), 0.0, 0.0])
            .collect(),
        around: vec![[1.0, 0.0, 0.0]; around.len()],
    };
    (Rule { along, around }, values)
}

#[test]
fn the_blur_of_a_constant_is_the_constant() {
    let (rule, values) = plain(|_| 2.5);
    let blur = blur();
    let blurred = &blur.harmonics(&rule, &[values])[0];
    for value in blur.values(blurred) {
        assert!((value - 2.5).abs() < 1e-12, "{value}");
    }
}

#[test]
fn the_blur_of_a_cosine_is_a_weaker_cosine() {
    // A harmonic of degree 1 is weakened by the mean cosine of the kernel.
    let kappa = 1.0 / SIGMA_DEG.to_radians().powi(2);
    let (rule, values) = plain(f64::sin);
    let blurred = &blur().harmonics(&rule, &[values])[0];
    let want = 1.0 / kappa.tanh() - 1.0 / kappa;
    assert!(
        (blurred.at(0.7, 1.0) / 0.7_f64.sin() - want).abs() < 1e-12,
        "{blurred:?}"
    );
}

#[test]
fn what_is_left_out_is_negligible() {
    let factors = factors(1.0 / SIGMA_DEG.to_radians().powi(2), 120);
    assert!(
        factors.windows(2).all(|pair| pair[1] < pair[0]),
        "falling: {factors:?}"
    );
    assert!(factors[DEGREE + 1] < REST, "{}", factors[DEGREE + 1]);
    assert!(factors[DEGREE / 2] > REST, "more than is needed");
}

#[test]
fn hair_blurred_is_its_integral_with_the_kernel() {
    let kappa = 1.0 / SIGMA_DEG.to_radians().powi(2);
    let kernel =
        |cos: f64| kappa / (2.0 * PI * (1.0 - (-2.0 * kappa).exp())) * (kappa * (cos - 1.0)).exp();
    let view = ViewedHair::new(&HairParams::bright(), 0.9);
    let (rule, blur) = (view.rule(12), blur());
    for kind in [Kind::GAUSSIAN, Kind::cauchy(1.0)] {
        let values = rule.values(&view, kind);
        let blurred = &blur.harmonics(&rule, core::slice::from_ref(&values))[0];
        assert!(
            (blurred.integral() / rule.albedo(&values) - 1.0).abs() < 1e-12,
            "the integral stays"
        );
        let sum: f64 = blur.l1(&blur.values(blurred), &vec![0.0; 64 * 64], 0.0);
        assert!(
            (sum / rule.albedo(&values) - 1.0).abs() < 1e-9,
            "it is not negative: {sum}"
        );
        // Next to the highlights, between them, behind the fibre and near a pole.
        for (theta, phi) in [
            (-0.9, 0.0),
            (-0.5, 0.6),
            (0.4, 2.0),
            (-1.0, PI),
            (-1.5, 1.0),
        ] {
            let centre = fibre_direction(theta, phi);
            let mut want = 0.0;
            for ([theta_i, w_theta], along) in rule.along.iter().zip(&values.along) {
                for ([phi_i, w_phi], around) in rule.around.iter().zip(&values.around) {
                    let value: f64 = along.iter().zip(around).map(|(a, b)| a * b).sum();
                    for side in [-1.0, 1.0] {
                        let cos = centre.dot(fibre_direction(*theta_i, side * phi_i));
                        want += 0.5 * w_theta * w_phi * value * kernel(cos);
                    }
                }
            }
            let got = blurred.at(theta, phi);
            assert!(
                (got - want).abs() < 1e-6 * want.abs().max(0.1),
                "{kind:?} at {theta} {phi}: {got} {want}"
            );
        }
    }
}
