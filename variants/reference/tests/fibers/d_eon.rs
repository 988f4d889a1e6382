//! D'Eon's far field: normalisation, energy, sampling, weights, and its distance from RTXCR.

use super::support::{
    DEG, LargestError, cdf_gap, chi_square, corners, direction, points, rule, sum,
};
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::{Lobe, LobeMask};
use hairis_conformance::is_kept;
use hairis_reference::{DEonReference, Real, Reference, RtxcrFaults, RtxcrReference};
use hairis_variants::{DEonDesc, DEonParams};

type Fiber = DEonReference<f64>;
const SHAPED: [Lobe; 3] = [Lobe::R, Lobe::TT, Lobe::TRT];
/// Inclinations of `wo`, degrees, on both sides of the breaks of the fit of TRT.
const THETA_O: [f64; 12] = [
    0.0, 15.0, -30.0, 30.2, 45.0, -60.0, 63.0, 63.1, 75.0, -85.0, 89.0, 89.99,
];

fn parameters(roughness: f64, eta: f64, tilt: f64) -> DEonDesc<f64> {
    DEonDesc {
        roughness,
        eta,
        tilt: tilt * DEG,
        sigma_a: [0.0, 0.3, 1.4],
        diffuse: 0.2,
        diffuse_color: [1.0, 0.7, 0.4],
    }
}

fn clear(roughness: f64, eta: f64, tilt: f64) -> DEonDesc<f64> {
    DEonDesc {
        sigma_a: [0.0; 3],
        diffuse_color: [1.0; 3],
        ..parameters(roughness, eta, tilt)
    }
}

fn prepare(p: &DEonDesc<f64>, theta_o: f64) -> Fiber {
    Fiber::prepare(p, direction(theta_o, 0.7))
}

fn grid() -> impl Iterator<Item = (DEonDesc<f64>, f64)> {
    let fibers = [
        (0.01, 1.55, 0.0),
        (0.06, 1.55, 2.0),
        (0.2, 1.55, -3.0),
        (0.3, 1.1, 5.0),
        (0.6, 3.0, -20.0),
        (1.0, 1.3, 45.0),
    ];
    fibers
        .into_iter()
        .flat_map(|(r, eta, tilt)| THETA_O.map(|theta| (parameters(r, eta, tilt), theta * DEG)))
}

/// `1 / eta'`.
fn inverse_index(p: &DEonDesc<f64>, theta_o: f64) -> f64 {
    theta_o.cos() / (p.eta * p.eta - theta_o.sin().powi(2)).sqrt()
}

/// Azimuths of `wi` from `wo`: the edges of TT, the end of the squeeze of R, and the width of the Gaussians.
fn azimuths(p: &DEonDesc<f64>, theta_o: f64) -> Vec<(f64, f64)> {
    let edge = 2.0 * inverse_index(p, theta_o).asin();
    let squeeze = PI - 2.0 * 0.1_f64.asin();
    let mut kinks = vec![squeeze, -squeeze];
    // Panels as narrow as the narrowest Gaussians, whose places are those of a fit.
    kinks.extend((-150..=150).map(|n| f64::from(n) * 0.02));
    rule(-PI, PI, &[(edge, 1e-3), (-edge, 1e-3)], &kinks)
}

/// Inclinations of `wi`, with the cones of all lobes at one azimuth.
fn inclinations(p: &DEonDesc<f64>, fiber: &Fiber) -> Vec<(f64, f64)> {
    let mut peaks: Vec<_> = SHAPED
        .iter()
        .flat_map(|lobe| {
            let at = fiber.cone_inclination(*lobe);
            [(at, 0.1 * p.roughness), (at, p.roughness)]
        })
        .collect();
    peaks.extend([(FRAC_PI_2, 1e-4), (-FRAC_PI_2, 1e-4)]);
    rule(-FRAC_PI_2, FRAC_PI_2, &peaks, &[])
}

/// The mean of `f` over the width of a fibre, of which `f` takes the cosine of `gamma_i`.
fn over_width(f: impl Fn(f64) -> f64) -> f64 {
    sum(&rule(0.0, FRAC_PI_2, &[], &[0.5, 1.0]), |g| {
        g.cos() * f(g.cos())
    })
}

fn schlick(eta: f64, cos: f64) -> f64 {
    let f0 = ((eta - 1.0) / (eta + 1.0)).powi(2);
    f0 + (1.0 - f0) * (1.0 - cos).powi(5)
}

#[test]
fn every_term_integrates_to_one() {
    let (mut along, mut about) = (LargestError::default(), LargestError::default());
    for (p, theta_o) in grid() {
        let fiber = prepare(&p, theta_o);
        let (theta, phi) = (inclinations(&p, &fiber), azimuths(&p, theta_o));
        for lobe in Lobe::FOUR {
            about.see(sum(&phi, |phi| fiber.azimuthal(lobe, phi)) - 1.0);
            about.see(sum(&phi, |phi| fiber.azimuth_pdf(lobe, phi)) - 1.0);
        }
        for (lobe, phi) in SHAPED
            .into_iter()
            .flat_map(|lobe| [0.0, 2.0, 3.1].map(|phi| (lobe, phi)))
        {
            along.see(sum(&theta, |t| fiber.longitudinal(lobe, t, phi) * t.cos()) - 1.0);
        }
    }
    about.assert_below(1e-13, "azimuthal terms");
    along.assert_below(1e-13, "longitudinal terms");
}

#[test]
fn clear_hair_returns_all_light() {
    let (mut whole, mut lobes) = (LargestError::default(), LargestError::default());
    for (p, theta_o) in grid() {
        let fiber = prepare(&clear(p.roughness, p.eta, 0.0), theta_o);
        whole.see(fiber.albedo().0.iter().map(|lobe| lobe[1]).sum::<f64>() - 1.0);
        let fiber = prepare(&p, theta_o);
        let (albedo, phi) = (fiber.albedo(), azimuths(&p, theta_o));
        for lobe in Lobe::FOUR {
            for channel in 0..3 {
                let found = sum(&phi, |phi| {
                    fiber.attenuation(lobe, phi)[channel] * fiber.azimuthal(lobe, phi)
                });
                lobes.see(found - albedo[lobe][channel]);
            }
        }
    }
    whole.assert_below(1e-13, "light of clear hair");
    lobes.assert_below(1e-13, "albedo of a lobe");
}

#[test]
fn the_third_lobe_has_the_light_of_all_further_paths() {
    let mut worst = LargestError::default();
    for (p, theta_o) in grid() {
        let p = DEonDesc {
            diffuse: 0.0,
            ..clear(p.roughness, p.eta, 0.0)
        };
        let albedo = prepare(&p, theta_o).albedo();
        let f = |cos: f64| schlick(p.eta, theta_o.cos() * cos);
        worst.see(albedo[Lobe::R][0] - over_width(f));
        worst.see(albedo[Lobe::TT][0] - over_width(|cos| (1.0 - f(cos)).powi(2)));
        // (1 - F)^2 F (1 + F + F^2 ..).
        worst.see(albedo[Lobe::TRT][0] - over_width(|cos| f(cos) * (1.0 - f(cos))));
    }
    worst.assert_below(1e-14, "light of R, TT and TRT");
}

#[test]
fn no_lobe_alone_weighs_more_than_stated() {
    let mut over = LargestError::default();
    for eta in [1.1, 1.2, 1.3, 1.55, 2.0, 3.0] {
        for step in 0..=180 {
            let p = DEonDesc {
                diffuse: 0.0,
                ..parameters(0.2, eta, 0.0)
            };
            let fiber = prepare(&p, f64::from(step) * 0.4999 * DEG);
            let largest = fiber.largest_weights();
            for n in 0..=400 {
                let phi = (f64::from(n) / 400.0 * FRAC_PI_2).sin() * PI * 0.999_999;
                for lobe in SHAPED {
                    let pdf = fiber.azimuth_pdf(lobe, phi);
                    if pdf > 1e-12 {
                        let ratio = fiber.azimuthal(lobe, phi) / pdf;
                        for c in 0..3 {
                            over.see(fiber.attenuation(lobe, phi)[c] * ratio / largest[lobe][c]);
                        }
                    }
                }
            }
        }
    }
    over.assert_below(1.0 + 1e-12, "weight of a lobe over the largest");
}

#[test]
fn azimuths_are_drawn_from_their_densities() {
    const COUNT: u32 = 20_000;
    let mut worst = LargestError::default();
    for (n, (p, theta_o)) in grid().enumerate() {
        if !is_kept(n) {
            continue;
        }
        let (fiber, phi) = (prepare(&p, theta_o), azimuths(&p, theta_o));
        for lobe in SHAPED {
            let drawn = (0..COUNT).map(|n| {
                let xi = (f64::from(n) + 0.5) / f64::from(COUNT);
                let phi = fiber.sample_azimuth(lobe, xi);
                (phi.sin().atan2(phi.cos()), 1.0)
            });
            let density = |phi| fiber.azimuth_pdf(lobe, phi);
            worst.see(cdf_gap(drawn.collect(), &phi, density));
        }
    }
    // Half a step of the points for each piece of an inversion, of which TRT has four: two Gaussians by side.
    worst.assert_below(2.0 / f64::from(COUNT), "cdf of the azimuths");
}

#[test]
fn a_sample_reports_its_value_and_density_and_keeps_its_bound() {
    let (mut worst, mut over) = (LargestError::default(), LargestError::default());
    let mut largest = 0.0_f64;
    for (p, theta_o) in grid() {
        let fiber = prepare(&p, theta_o);
        let sum: f64 = fiber.probabilities().0.iter().sum();
        assert!((sum - 1.0).abs() < 1e-15, "probabilities: {sum}");
        let bound = fiber.weight_bound(LobeMask::ALL).unwrap();
        for xi in points(600) {
            let drawn = fiber.sample(xi);
            if drawn.lobe.is_none() {
                continue;
            }
            let (value, pdf) = fiber.eval_pdf(drawn.wi);
            // Next to the axis, and on narrow lobes, a rounded direction matters.
            let steepness =
                1.0 / (p.roughness * theta_o.cos().max(0.01) * drawn.wi[1].hypot(drawn.wi[2]));
            worst.see((pdf / drawn.pdf - 1.0) / steepness);
            for (value, drawn) in value.into_iter().zip(drawn.value) {
                worst.see((value / drawn - 1.0) / steepness);
            }
            let mean = drawn.weight.iter().sum::<f64>() / 3.0;
            over.see(mean / bound);
            largest = largest.max(drawn.weight[0]);
        }
    }
    println!("largest weight of a channel: {largest:.2}");
    worst.assert_below(1e-13, "sample, then evaluate, by steepness");
    over.assert_below(1.0 + 1e-12, "largest weight over its bound");
}

#[test]
fn samples_pass_chi_square_on_the_sphere() {
    let cases = [
        (parameters(0.1, 1.55, 2.0), 30.0),
        (parameters(0.3, 1.55, -5.0), -75.0),
        (parameters(1.0, 1.2, 0.0), 10.0),
        (clear(0.2, 3.0, 10.0), 63.5),
        (DEonParams::black().desc().map(f64::from), 0.0),
    ];
    for (p, theta_o) in cases {
        let fiber = prepare(&p, theta_o * DEG);
        let edge = 2.0 * inverse_index(&p, theta_o * DEG).asin();
        let at = [edge, -edge].map(|phi: f64| ((phi + 0.7).sin().atan2((phi + 0.7).cos()), 0.01));
        let found = chi_square(&fiber, &inclinations(&p, &fiber), &at);
        // Sidak's correction of .01 over five runs.
        assert!(found > 2e-3, "{p:?} theta_o {theta_o}: p-value {found}");
    }
}

#[test]
fn narrow_lobes_are_those_of_rtxcr() {
    // On the cone of each lobe, at the first order of the roughness; RTXCR has the light of its fit in TRT.
    let (mut r, mut tt) = (LargestError::default(), LargestError::default());
    for (degrees, roughness) in [(0.0, 0.01), (20.0, 0.01), (50.0, 0.01)] {
        let p = DEonDesc {
            diffuse: 0.0,
            ..parameters(roughness, 1.55, 0.0)
        };
        let wo = direction(degrees * DEG, 0.0);
        let (ours, theirs) = (
            Fiber::prepare(&p, wo),
            RtxcrReference::prepare(&p, RtxcrFaults::MENDED, wo),
        );
        // TT is alone behind the fibre, and R in front of it where TRT is not.
        let ratio = |phi: f64, channel: usize| {
            let wi = direction(-degrees * DEG, phi);
            ours.eval(wi)[channel] / theirs.eval(wi)[channel] - 1.0
        };
        r.see(ratio(0.75, 0));
        for channel in 0..3 {
            tt.see(ratio(2.6, channel));
        }
    }
    r.assert_below(1e-4, "R against RTXCR");
    tt.assert_below(1e-4, "TT against RTXCR");
}

#[test]
fn single_precision_follows_and_is_total() {
    let mut worst = LargestError::default();
    for (p, theta_o) in grid() {
        // A rounded inclination may lie on the other side of a break of the fit.
        if theta_o.abs() == 30.0 * DEG {
            continue;
        }
        let single = p.map(f32::from_f64);
        let wo = direction(theta_o, 0.7).map(f32::from_f64);
        let fiber = DEonReference::prepare(&single, wo);
        let double = Fiber::prepare(&single.map(f64::from), wo.map(f64::from));
        for xi in points(60) {
            let wi = double.sample(xi).wi.map(f32::from_f64);
            let across = wi[1].hypot(wi[2]);
            if across < 1e-3 {
                continue;
            }
            let (value, pdf) = fiber.eval_pdf(wi);
            let (value64, pdf64) = double.eval_pdf(wi.map(f64::from));
            let steepness = 1.0 / (p.roughness * theta_o.cos().max(1e-3)) / f64::from(across);
            worst.see((f64::from(pdf) / pdf64 - 1.0) / steepness);
            worst.see((f64::from(value[0]) / value64[0] - 1.0) / steepness);
        }
        for xi in corners() {
            let drawn = fiber.sample(xi);
            let numbers = drawn.wi.iter().chain(&drawn.value).chain(&drawn.weight);
            assert!(
                numbers.chain([&drawn.pdf]).all(|x| x.is_finite()),
                "{p:?} {theta_o} {xi:?}: {drawn:?}"
            );
        }
    }
    worst.assert_below(2e-6, "f32 over f64, by steepness");
    let ink = DEonDesc {
        sigma_a: [1e30; 3],
        diffuse: 1.0,
        diffuse_color: [0.0; 3],
        ..parameters(0.2, 1.55, 0.0)
    };
    let nothing = Fiber::prepare(&ink, [0.0, 1.0, 0.0]).sample([0.5; 3]);
    assert_eq!(nothing.lobe, None, "nothing scatters");
}
