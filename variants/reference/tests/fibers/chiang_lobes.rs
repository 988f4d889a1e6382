//! Tints and widths of each lobe, and other names of tilt and pigment.

use super::chiang::{clear, prepare};
use super::support::LargestError;
use core::f64::consts::PI;
use hairis::Lobe;
use hairis::params::Pigments;
use hairis_reference::{ChiangFormulas, Reference, bessel_i0_scaled};
use hairis_variants::ChiangDesc;

/// M of d'Eon et al. 2011 and N of Chiang et al. 2016 as they print them, for each lobe's own v and s.
#[test]
fn each_lobe_has_its_widths() {
    let (width_m, width_n) = ([1.4, 0.9, 0.6], [0.5, 1.0, 1.7]);
    let (beta_m, beta_n, tilt) = (0.4_f64, 0.35_f64, 3.0_f64);
    let p = ChiangDesc {
        width_m,
        width_n,
        ..clear(beta_m, beta_n, tilt)
    };
    let root = 0.726 * beta_m + 0.812 * beta_m.powi(2) + 3.7 * beta_m.powi(20);
    let scale =
        (PI / 8.0).sqrt() * (0.265 * beta_n + 1.194 * beta_n.powi(2) + 5.372 * beta_n.powi(22));
    let fiber = prepare(&p, 0.4, 0.3);
    let mut worst = LargestError::default();
    for (place, lobe) in [Lobe::R, Lobe::TT, Lobe::TRT, Lobe::slot(3)]
        .into_iter()
        .enumerate()
    {
        let (m, n) = (width_m[place.min(2)], width_n[place.min(2)]);
        let v = (m * root).powi(2);
        for theta in [-1.4, -0.6, -0.1, 0.3, 1.2_f64] {
            let cone = fiber.cone(lobe);
            let x = theta.cos() * cone.cos() / v;
            // The cone's own inclination is -theta', so that the product of sines has the other sign.
            let printed = (theta.sin() * cone.sin() / v + x).exp() * bessel_i0_scaled(x)
                / (2.0 * v * (1.0 / v).sinh());
            worst.see(fiber.longitudinal(lobe, theta) / printed - 1.0);
        }
        let s = n * scale;
        for phi in [-3.0, -1.0, 0.2, 2.5_f64] {
            let e = (-phi.abs() / s).exp();
            let within = 1.0 / (1.0 + (-PI / s).exp()) - 1.0 / (1.0 + (PI / s).exp());
            let printed = if place == 3 {
                0.5 / PI
            } else {
                e / (s * (1.0 + e).powi(2)) / within
            };
            let at = fiber.centre(lobe) + phi;
            worst.see(fiber.azimuthal(lobe, at) / printed - 1.0);
        }
    }
    worst.assert_below(2e-13, "M and N of lobes with widths of their own");
}

#[test]
fn tints_multiply_attenuations() {
    let plain = ChiangDesc {
        sigma_a: [0.2, 0.4, 0.9],
        ..clear(0.3, 0.3, 2.0)
    };
    let tinted = ChiangDesc {
        tint_r: [1.0, 0.5, 0.0],
        tint_tt: [0.25, 1.0, 0.75],
        tint_trt: [0.5, 0.0, 1.0],
        ..plain
    };
    let [before, after] = [plain, tinted].map(|p| prepare(&p, 0.5, 0.4).albedo());
    let tints = [
        tinted.tint_r,
        tinted.tint_tt,
        tinted.tint_trt,
        tinted.tint_trt,
    ];
    for (lobe, tint) in tints.into_iter().enumerate() {
        let want = [0, 1, 2].map(|c| tint[c] * before.0[lobe][c]);
        assert_eq!(after.0[lobe], want, "lobe {lobe}");
    }
}

#[test]
fn a_cuticle_angle_is_a_tilt_and_pigments_are_factors() {
    let p = clear(0.3, 0.3, 2.0);
    for (angle, tilt) in [(0.25, -PI / 4.0), (0.5, 0.0), (0.75, PI / 4.0)] {
        assert!(
            (p.with_cuticle_angle(angle).tilt - tilt).abs() < 1e-15,
            "{angle}"
        );
    }
    let cycles = ChiangDesc::default()
        .with_pigments(Pigments::CYCLES)
        .map(f64::from);
    let sigma = cycles.with_melanin(1.5, 0.5).sigma_a;
    for (got, want) in sigma.into_iter().zip([0.9305, 1.628, 3.4415]) {
        assert!((got / want - 1.0).abs() < 1e-7, "{got} {want}");
    }
}
