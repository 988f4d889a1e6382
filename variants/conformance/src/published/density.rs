//! Tests that each lobe's density integrates to 1, and so does the mixture, by quadrature over the kernels' own numbers.

use super::Tested;
use super::quadrature::{integrate, panels};
use super::support::{Kind, THETA_O, direction, double, materials, parameters};
use crate::comparison::LargestError;
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::{HairParams, Lobe, LobeMask};
use hairis_reference::{MatchedReference, Reference};

/// Integrates the density of each lobe alone over the sphere. Except for rounding, the density is a product of two factors, so that two
/// line integrals suffice.
fn integrals(tested: &Tested, bands: usize, params: &HairParams, theta_o: f64) -> [f64; 4] {
    let wo = direction(theta_o, 0.4);
    let p = parameters(params, 1.0);
    let bsdf = tested
        .sampler(Some(bands))
        .prepare(params, wo, LobeMask::ALL);
    let reference = MatchedReference::prepare(&p, tested.formulas.shape, double(wo), bands);
    Lobe::FOUR.map(|lobe| {
        let l = lobe.index().min(2);
        let at = |theta: f64, phi: f64| {
            let wi = direction(theta, 0.4 - phi);
            f64::from(bsdf.lobes(wi)[lobe].pdf) * theta.cos()
        };
        let centre = 2.0 * p.alpha[l] - theta_o;
        let (theta_0, phi_0) = (
            centre.clamp(-1.4, 1.4),
            [0.0, PI, 0.0, p.phi_g][lobe.index()],
        );
        let inner = FRAC_PI_2 - 1e-5;
        let mut ends = panels(-inner, inner, &[(centre, p.beta[l])]);
        // The density jumps between bands: panels end there.
        ends.extend(reference.jumps().into_iter().filter(|x| x.abs() < inner));
        ends.sort_by(f64::total_cmp);
        let phi = panels(0.0, PI, &[(p.phi_g, p.gamma_g), (PI, p.gamma_tt)]);
        let largest = at(theta_0, phi_0);
        if largest == 0.0 {
            return f64::NAN;
        }
        // Directions closer to the axis are discarded; this is their part of the density.
        let caps = reference.cdf_theta(lobe, -inner) + 1.0 - reference.cdf_theta(lobe, inner);
        caps + integrate(&ends, |theta| at(theta, phi_0))
            * 2.0
            * integrate(&phi, |phi| at(theta_0, phi))
            / largest
    })
}

fn see(tested: &Tested, worst: &mut LargestError, bands: usize, kind: Kind, theta_o: &[f64]) {
    for params in materials(kind)
        .iter()
        .step_by(if kind == Kind::Grid { 37 } else { 1 })
    {
        for degrees in theta_o {
            let all = integrals(tested, bands, params, degrees.to_radians());
            for (lobe, integral) in Lobe::FOUR.into_iter().zip(all).filter(|(_, x)| !x.is_nan()) {
                worst.see((integral - 1.0).abs(), || {
                    format!("{bands} {lobe:?} {degrees} {integral} {params:?}")
                });
            }
        }
    }
}

pub fn each_lobe_integrates_to_one(tested: &Tested) {
    for (kind, limit) in [
        (Kind::Grid, tested.rows.integral[0]),
        (Kind::Narrow, tested.rows.integral[1]),
        (Kind::Wide, tested.rows.integral[2]),
    ] {
        let mut worst = LargestError::default();
        for bands in [5, 9, 25] {
            see(tested, &mut worst, bands, kind, &THETA_O);
        }
        worst.check(
            &format!("{kind:?} integral of a lobe's density, off 1"),
            limit,
        );
    }
}
