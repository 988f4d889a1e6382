//! Tests of `quadrature::adaptive`.

use core::f64::consts::{PI, SQRT_2};
use hairis_instruments::quadrature::{Tolerance, bell_breakpoints, integrate, integrate_rectangle};

#[test]
fn the_rules_are_exact_to_their_degrees() {
    for degree in 0..=23 {
        let want = if degree % 2 == 1 {
            0.0
        } else {
            2.0 / f64::from(degree + 1)
        };
        // One panel: the Kronrod rule, with the distance from the Gauss rule as the error.
        let one = Tolerance {
            max_panels: 1,
            ..Tolerance::default()
        };
        let rules = integrate(|x| [x.powi(degree)], &[-1.0, 1.0], &one);
        let [kronrod] = rules.value;
        assert!(
            (kronrod - want).abs() < 1e-15,
            "Kronrod, degree {degree}: {kronrod}"
        );
        if degree <= 13 {
            assert!(rules.error[0] < 1e-15, "Gauss, degree {degree}: {rules:?}");
        }
    }
}

#[test]
fn narrow_bells_are_found_through_a_breakpoint() {
    let tolerance = Tolerance::relative(1e-12);
    let edges = |width| {
        let bell = bell_breakpoints(0.0, width);
        let inside = bell.into_iter().filter(|x| x.abs() < PI);
        inside.chain([-PI, PI]).collect::<Vec<f64>>()
    };
    for width in [1.0, 0.1, 1e-2, 1e-4] {
        let r = integrate(
            |x| [(-0.5 * (x / width) * (x / width)).exp()],
            &edges(width),
            &tolerance,
        );
        let want = width * (2.0 * PI).sqrt() * libm::erf(PI / width / SQRT_2);
        assert!(
            r.converged && (r.value[0] / want - 1.0).abs() < 1e-12,
            "width {width}: {r:?}"
        );
        let r = integrate(
            |x| [width / (x * x + width * width)],
            &[-1.0, 0.0, 2.0],
            &tolerance,
        );
        let want = (2.0 / width).atan() + (1.0 / width).atan();
        assert!(
            r.converged && (r.value[0] / want - 1.0).abs() < 1e-12,
            "Cauchy of width {width}: {r:?}"
        );
    }
}

#[test]
fn components_share_the_panels() {
    let r = integrate(
        |x: f64| [1.0, x.sqrt(), 0.0],
        &[0.0, 1.0],
        &Tolerance::relative(1e-9),
    );
    assert!(r.converged && r.value[2] == 0.0 && r.error[2] == 0.0);
    assert!(
        (r.value[0] - 1.0).abs() < 1e-14 && (r.value[1] - 2.0 / 3.0).abs() < 1e-9,
        "{r:?}"
    );
}

#[test]
fn rectangle_product_and_kink() {
    let r = integrate_rectangle(
        |x, y| [x * x * y, (x - 0.3).abs() + (y - 0.7).abs()],
        &[0.0, 0.3, 1.0],
        &[0.0, 0.7, 1.0],
        &Tolerance::relative(1e-12),
    );
    let kink = (0.09 + 0.49) / 2.0 + (0.49 + 0.09) / 2.0;
    assert!(
        r.converged && (r.value[0] - 1.0 / 6.0).abs() < 1e-14 && (r.value[1] - kink).abs() < 1e-14,
        "{r:?}"
    );
    // A kink that no breakpoint announces still converges.
    let r = integrate_rectangle(
        |x, y| [(x - y).abs()],
        &[0.0, 1.0],
        &[0.0, 1.0],
        &Tolerance::relative(1e-5),
    );
    assert!(
        r.converged && (r.value[0] - 1.0 / 3.0).abs() < 1e-5,
        "{r:?}"
    );
}

#[test]
fn degenerate_inputs() {
    let r = integrate(|_| [1.0], &[2.0], &Tolerance::default());
    assert_eq!((r.value, r.converged), ([0.0], true));
    let r = integrate(
        |_| [f64::NAN],
        &[0.0, 1.0],
        &Tolerance {
            max_panels: 10,
            ..Tolerance::default()
        },
    );
    assert!(!r.converged && r.value[0].is_nan());
    let r = integrate(
        |x: f64| [1.0 / x],
        &[0.0, 1.0],
        &Tolerance {
            max_panels: 100,
            ..Tolerance::default()
        },
    );
    assert!(
        !r.converged,
        "a divergent integral is not reported as one: {r:?}"
    );
    let r = integrate(|_| [0.0], &[0.0, 1.0], &Tolerance::default());
    assert_eq!((r.value, r.converged), ([0.0], true));
}
