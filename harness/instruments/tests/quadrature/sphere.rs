//! Tests of `quadrature::sphere`.

use core::f64::consts::{FRAC_PI_2, PI};
use hairis_instruments::quadrature::SphereIntegrator;

#[test]
fn second_moments_are_those_of_the_sphere() {
    let r = SphereIntegrator::new().integrate_direction(|d| [d.x * d.x, d.y * d.y, d.z * d.z]);
    for v in r.value {
        assert!((v - 4.0 * PI / 3.0).abs() < 1e-12, "{r:?}");
    }
}

#[test]
fn a_narrow_product_lobe_matches_its_lines() {
    // Bells of 0.01 rad off centre, one across the seam of phi: the product of two line integrals.
    let (theta_0, phi_0, width) = (0.713, 3.139, 0.01);
    let bell = |x: f64| (-0.5 * (x / width) * (x / width)).exp();
    let wrap = |x: f64| x - 2.0 * PI * (x / (2.0 * PI)).round();
    let r = SphereIntegrator::new()
        .theta_lobe(theta_0, width)
        .phi_lobe(phi_0, width)
        .integrate(|theta, phi| [bell(theta - theta_0) * bell(wrap(phi - phi_0))]);
    let line = width * (2.0 * PI).sqrt();
    let want = line * line * theta_0.cos() * (-0.5 * width * width).exp();
    assert!(
        r.converged && (r.value[0] / want - 1.0).abs() < 1e-8,
        "{r:?} {want}"
    );
}

#[test]
fn cauchy_tails_and_rgb() {
    let c = |x: f64, b: f64| b * b / (x * x + b * b);
    let r = SphereIntegrator::new()
        .theta_lobe(-0.3, 0.01)
        .phi_lobe(1.0, 0.02)
        .integrate(|t, p| {
            let v = c(t + 0.3, 0.01) * c(p - 1.0, 0.02) / t.cos();
            [v, 2.0 * v, 0.5 * v]
        });
    let theta = 0.01 * (((FRAC_PI_2 + 0.3) / 0.01).atan() + ((FRAC_PI_2 - 0.3) / 0.01).atan());
    let phi = 0.02 * (((PI - 1.0) / 0.02).atan() + ((PI + 1.0) / 0.02).atan());
    for (got, scale) in r.value.iter().zip([1.0, 2.0, 0.5]) {
        assert!((got / (scale * theta * phi) - 1.0).abs() < 1e-9, "{r:?}");
    }
    assert!(r.converged);
}

#[test]
fn foreign_breakpoints_are_dropped_or_wrapped() {
    let q = SphereIntegrator::new()
        .theta_break(2.0)
        .theta_break(f64::NAN)
        .phi_break(7.0)
        .phi_break(f64::INFINITY);
    let r = q.integrate(|_, _| [1.0]);
    assert!((r.value[0] - 4.0 * PI).abs() < 1e-12 && r.converged);
    assert_eq!(q.tolerance.relative, 1e-8);
}
