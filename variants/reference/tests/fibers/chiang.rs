//! The energy-conserving fibre's formulas: energy, normalisation, symmetries, agreement with the published forms.

use super::support::{DEG, LargestError, direction, points, rule, sum};
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::Lobe;
use hairis_conformance::is_kept;
use hairis_reference::{
    ChiangFormulas, ChiangReference, Real, Reference, Selection, bessel_i0_scaled,
};
use hairis_variants::ChiangDesc;
use hairis_variants::chiang::ChiangParams;

pub(crate) type ChiangFiber = ChiangReference<f64>;
pub(crate) const GRAZING: f64 = 1.000_01e-5;
const ROUGHNESSES: [f64; 5] = [1e-3, 0.05, 0.3, 0.7, 1.0];
/// Inclinations of `wo`, degrees.
const THETA_O: [f64; 8] = [0.0, 20.0, -45.0, 75.0, -85.0, 89.0, 89.9, -90.0];
const TILTS: [f64; 4] = [0.0, 2.0, -20.0, 45.0];
const OFFSETS: [f64; 6] = [0.0, 0.3, -0.7, 0.95, 0.999_999, -1.0];

pub(crate) fn clear(beta_m: f64, beta_n: f64, tilt_deg: f64) -> ChiangDesc<f64> {
    ChiangDesc {
        beta_m,
        beta_n,
        tilt: tilt_deg * DEG,
        eta: 1.55,
        sigma_a: [0.0; 3],
        ..ChiangDesc::default().map(f64::from)
    }
}

pub(crate) fn prepare(p: &ChiangDesc<f64>, theta_o: f64, h: f64) -> ChiangFiber {
    ChiangFiber::prepare(p, Selection::Mean, direction(theta_o, 0.7), h)
}

/// Panels of `theta_i` between the discarded caps: peaks at the cones, and the poles, where M changes over `v`.
pub(crate) fn inclinations(p: &ChiangDesc<f64>, fiber: &ChiangFiber, edge: f64) -> Vec<(f64, f64)> {
    let v = p.variances();
    let mut peaks: Vec<_> = Lobe::FOUR
        .into_iter()
        .map(|lobe| (fiber.cone(lobe), v[lobe].sqrt().min(1.0)))
        .collect();
    let least = v[Lobe::TT].min(0.1);
    peaks.extend([(FRAC_PI_2, least), (-FRAC_PI_2, least)]);
    rule(-edge, edge, &peaks, &[])
}

/// Panels of `phi_i - phi_o` over a turn: peaks and cuts of the logistics.
pub(crate) fn azimuths(p: &ChiangDesc<f64>, fiber: &ChiangFiber) -> Vec<(f64, f64)> {
    let turn = 2.0 * PI;
    let centres = [Lobe::R, Lobe::TT, Lobe::TRT].map(|lobe| fiber.centre(lobe).rem_euclid(turn));
    let peaks: Vec<_> = centres
        .into_iter()
        .flat_map(|c| [c - turn, c, c + turn])
        .map(|c| (c, p.scales().0[1]))
        .collect();
    rule(
        0.0,
        turn,
        &peaks,
        &centres.map(|c| (c + PI).rem_euclid(turn)),
    )
}

#[test]
fn the_scaled_bessel_function_is_its_integral() {
    // exp(-x) I0(x) = (1/pi) integral of exp(x (cos t - 1)): midpoints over a period converge geometrically.
    let integral = |x: f64| {
        let count = (1..)
            .find(|n| f64::from(*n) > 64.0 + 16.0 * x.sqrt())
            .unwrap_or(1);
        let half = |n: u32| (0.5 * PI * (f64::from(n) + 0.5) / f64::from(count)).sin();
        (0_u32..count)
            .map(|n| (-2.0 * x * half(n) * half(n)).exp())
            .sum::<f64>()
            / f64::from(count)
    };
    let (mut double, mut single) = (LargestError::default(), LargestError::default());
    for step in 0..4000_u32 {
        let x = f64::from(step).powi(2) * 1e-3;
        let expected = integral(x);
        double.see(bessel_i0_scaled(x) / expected - 1.0);
        let rounded = f32::from_f64(x);
        single.see(f64::from(bessel_i0_scaled(rounded)) / integral(f64::from(rounded)) - 1.0);
    }
    double.assert_below(2e-15, "I0e in f64");
    single.assert_below(2e-7, "I0e in f32");
    let seam = bessel_i0_scaled(30.0_f64) / bessel_i0_scaled(30.0_f64.next_down());
    assert!(
        (seam - 1.0).abs() < 1e-14,
        "the seam of both series: {seam}"
    );
}

#[test]
fn attenuations_of_clear_hair_sum_to_one() {
    let mut worst = LargestError::default();
    for eta in [1.0, 1.0 + 1e-7, 1.1, 1.55, 2.5, 4.0] {
        for theta_o in THETA_O.into_iter().chain([90.0]) {
            for h in OFFSETS.into_iter().chain([1.0, 2.0]) {
                let fiber = prepare(
                    &ChiangDesc {
                        eta,
                        ..clear(0.3, 0.3, 2.0)
                    },
                    theta_o * DEG,
                    h,
                );
                let albedo = Reference::albedo(&fiber);
                for channel in 0..3 {
                    worst.see(albedo.0.iter().map(|a| a[channel]).sum::<f64>() - 1.0);
                    assert!(
                        albedo.0.iter().all(|a| a[channel] >= 0.0),
                        "eta {eta} theta_o {theta_o} h {h}"
                    );
                }
            }
        }
    }
    worst.assert_below(1e-15, "sum of A");
}

#[test]
fn absorption_only_takes_away() {
    let fiber = |sigma: f64, eta| {
        let p = ChiangDesc {
            eta,
            sigma_a: [sigma, 0.0, 1.0],
            ..clear(0.3, 0.3, 2.0)
        };
        prepare(&p, 0.5, 0.4).albedo()
    };
    let sum = |sigma, eta| fiber(sigma, eta).0.iter().map(|a| a[0]).sum::<f64>();
    let mut before = 1.0 + 1e-15;
    for sigma in [0.0, 1e-3, 0.1, 1.0, 10.0, 1e4, f64::from(f32::MAX)] {
        assert!(sum(sigma, 1.55) <= before, "sigma_a {sigma}");
        before = sum(sigma, 1.55);
    }
    assert!(
        (before - prepare(&clear(0.3, 0.3, 2.0), 0.5, 0.4).fresnel()).abs() < 1e-15,
        "opaque hair reflects F"
    );
    assert_eq!(
        sum(f64::from(f32::MAX), 1.0),
        0.0,
        "without a surface all is absorbed"
    );
    let nothing = ChiangDesc {
        eta: 1.0,
        sigma_a: [f64::from(f32::MAX); 3],
        ..clear(0.3, 0.3, 2.0)
    };
    assert_eq!(
        prepare(&nothing, 0.5, 0.4).sample([0.5; 3]).lobe,
        None,
        "and nothing is drawn"
    );
    // T after one diameter at normal incidence and h = 0 is exp(-2 sigma_a).
    let straight = prepare(&clear(0.3, 0.3, 2.0), 0.0, 0.0);
    assert!(
        (straight.path_length() - 2.0).abs() < 1e-15,
        "path length {}",
        straight.path_length()
    );
}

#[test]
fn longitudinal_terms_integrate_to_one() {
    let mut worst = LargestError::default();
    for (beta_m, tilt) in ROUGHNESSES
        .into_iter()
        .flat_map(|m| TILTS.map(|tilt| (m, tilt)))
    {
        for theta_o in THETA_O {
            let p = clear(beta_m, 0.3, tilt);
            let fiber = prepare(&p, theta_o * DEG, 0.0);
            let rule = inclinations(&p, &fiber, FRAC_PI_2);
            for lobe in Lobe::FOUR {
                worst.see(sum(&rule, |t| fiber.longitudinal(lobe, t) * t.cos()) - 1.0);
            }
        }
    }
    worst.assert_below(2e-13, "integral of M");
}

#[test]
fn azimuthal_terms_integrate_to_one() {
    let mut worst = LargestError::default();
    for (beta_n, h) in ROUGHNESSES
        .into_iter()
        .flat_map(|n| OFFSETS.map(|h| (n, h)))
    {
        let p = clear(0.3, beta_n, 2.0);
        let fiber = prepare(&p, 0.4, h);
        let rule = azimuths(&p, &fiber);
        for lobe in Lobe::FOUR {
            worst.see(sum(&rule, |phi| fiber.azimuthal(lobe, phi)) - 1.0);
        }
    }
    worst.assert_below(8e-13, "integral of N");
}

#[test]
fn the_longitudinal_term_is_the_published_one_where_that_does_not_overflow() {
    // csch(1/v) / (2 v) exp(-sin theta_i sin theta' / v) I0(cos theta_i cos theta' / v), d'Eon et al. 2011.
    let mut worst = LargestError::default();
    for beta_m in [0.15, 0.3, 0.7, 1.0] {
        let p = clear(beta_m, 0.3, 0.0);
        for [a, b, _] in points(500) {
            let (theta_i, theta_o) = ((a - 0.5) * PI, (b - 0.5) * PI);
            let fiber = prepare(&p, theta_o, 0.0);
            for lobe in Lobe::FOUR {
                let v = p.variances()[lobe];
                let x = theta_i.cos() * theta_o.cos() / v;
                let published =
                    (-theta_i.sin() * theta_o.sin() / v).exp() * bessel_i0_scaled(x) * x.exp()
                        / (2.0 * v * (1.0 / v).sinh());
                worst.see(fiber.longitudinal(lobe, theta_i) / published - 1.0);
            }
        }
    }
    worst.assert_below(2e-13, "M against its published form");
}

#[test]
fn clear_hair_returns_all_the_light() {
    let mut worst = LargestError::default();
    let cases = [
        (1e-3, 1e-3),
        (0.05, 0.3),
        (0.3, 0.05),
        (0.3, 1.0),
        (1.0, 0.7),
    ];
    let places = cases
        .into_iter()
        .flat_map(|betas| [0.0, 60.0, -85.0].map(|t| (betas, t)))
        .enumerate();
    for (_, ((beta_m, beta_n), theta_o)) in places.filter(|(n, _)| is_kept(*n)) {
        for (h, tilt) in [(0.2, 2.0), (-0.97, -20.0)] {
            let p = clear(beta_m, beta_n, tilt);
            let fiber = prepare(&p, theta_o * DEG, h);
            let (theta, phi) = (
                inclinations(&p, &fiber, FRAC_PI_2 - GRAZING),
                azimuths(&p, &fiber),
            );
            let furnace = sum(&theta, |t| {
                let cos = t.cos();
                sum(&phi, |phi| fiber.eval(direction(t, 0.7 + phi))[1]) * cos * cos
            });
            worst.see(furnace - 1.0);
        }
    }
    // The caps of 1e-5 rad hold the rest.
    worst.assert_below(2e-9, "furnace");
}

#[test]
fn colours_integrate_to_the_albedo() {
    let mut worst = LargestError::default();
    for (_, preset) in ChiangParams::presets() {
        let p = preset.desc().map(f64::from);
        let fiber = ChiangFiber::prepare(&p, Selection::ByChannel, direction(0.6, 0.7), -0.4);
        let (theta, phi) = (
            inclinations(&p, &fiber, FRAC_PI_2 - GRAZING),
            azimuths(&p, &fiber),
        );
        let (mut sums, mut mass) = ([0.0; 3], 0.0);
        for &(t, w_t) in &theta {
            for &(phi, w_phi) in &phi {
                let (value, pdf) = fiber.eval_pdf(direction(t, 0.7 + phi));
                let w = w_t * w_phi * t.cos();
                sums = core::array::from_fn(|c| sums[c] + w * value[c] * t.cos());
                mass += w * pdf;
            }
        }
        worst.see(mass - 1.0);
        for (channel, found) in sums.into_iter().enumerate() {
            worst.see(found - fiber.albedo().0.iter().map(|a| a[channel]).sum::<f64>());
        }
    }
    worst.assert_below(1e-11, "albedo of the presets");
}

#[test]
fn symmetries_hold() {
    let mut worst = LargestError::default();
    for (beta_m, beta_n) in [(0.05, 0.3), (0.3, 0.1), (1.0, 1.0)] {
        for [a, b, c] in points(300) {
            let p = ChiangDesc {
                sigma_a: [0.1, 0.5, 2.0],
                ..clear(beta_m, beta_n, 7.0)
            };
            let (theta_o, theta_i, h) = ((a - 0.5) * 3.0, (b - 0.5) * 3.0, 2.0 * c - 1.0);
            let value = |p: &ChiangDesc<f64>, sign_theta: f64, sign_phi: f64| {
                let fiber = ChiangFiber::prepare(
                    p,
                    Selection::Mean,
                    direction(sign_theta * theta_o, sign_phi * 0.3),
                    sign_phi * h,
                );
                fiber.eval(direction(sign_theta * theta_i, sign_phi * 5.0 * b))[2]
            };
            let here = value(&p, 1.0, 1.0);
            worst.see(value(&p, 1.0, -1.0) / here - 1.0);
            worst.see(value(&ChiangDesc { tilt: -p.tilt, ..p }, -1.0, 1.0) / here - 1.0);
        }
    }
    worst.assert_below(3e-14, "mirrored fibres");
}

#[test]
fn shares_of_the_lobes_are_as_stated() {
    let nodes = rule(-1.0, 1.0, &[(1.0, 1e-4), (-1.0, 1e-4)], &[]);
    for (theta_o, expected, within) in [
        (0.0, [0.075, 0.862, 0.056, 0.0076], 6e-4),
        (85.0, [0.69, 0.10, 0.07, 0.14], 6e-3),
    ] {
        for lobe in Lobe::FOUR {
            let mean = 0.5
                * sum(&nodes, |h| {
                    prepare(&clear(0.3, 0.3, 0.0), theta_o * DEG, h).albedo()[lobe][0]
                });
            println!("theta_o {theta_o}: {lobe:?} {mean:.5}");
            assert!(
                (mean - expected[lobe.index()]).abs() < within,
                "theta_o {theta_o} {lobe:?}: {mean}"
            );
        }
    }
}

#[test]
fn single_precision_follows_and_is_total() {
    let mut worst = LargestError::default();
    for (beta_m, beta_n) in ROUGHNESSES
        .into_iter()
        .flat_map(|m| ROUGHNESSES.map(|n| (m, n)))
    {
        for (theta_o, h) in THETA_O
            .into_iter()
            .flat_map(|t| OFFSETS.map(|h| (t * DEG, h)))
        {
            let p = ChiangDesc {
                sigma_a: [0.5, 0.0, 3e38],
                ..clear(beta_m, beta_n, 2.0)
            };
            let single = ChiangDesc {
                beta_m: f32::from_f64(beta_m),
                beta_n: f32::from_f64(beta_n),
                tilt: f32::from_f64(p.tilt),
                eta: f32::from_f64(p.eta),
                sigma_a: p.sigma_a.map(f32::from_f64),
                ..ChiangDesc::default()
            };
            let wo = direction(theta_o, 0.7).map(f32::from_f64);
            let fiber =
                ChiangReference::prepare(&single, Selection::ByChannel, wo, f32::from_f64(h));
            let double = ChiangFiber::prepare(
                &p,
                Selection::ByChannel,
                wo.map(f64::from),
                f64::from(f32::from_f64(h)),
            );
            let narrow = p.scales()[Lobe::TT].min(p.variances()[Lobe::TT].sqrt());
            if theta_o.abs() < 1.5 && h.abs() < 0.99 {
                for [a, b, c] in points(20) {
                    let drawn = fiber.sample([a, b, c].map(f32::from_f64));
                    let (value, pdf) = double.eval_pdf(drawn.wi.map(f64::from));
                    worst.see((f64::from(drawn.pdf) / pdf - 1.0) * narrow);
                    worst.see((f64::from(drawn.value[0]) / value[0] - 1.0) * narrow);
                }
            }
            for xi in super::support::corners() {
                let drawn = fiber.sample(xi);
                let mut all = drawn
                    .wi
                    .iter()
                    .chain(&drawn.value)
                    .chain(&drawn.weight)
                    .chain([&drawn.pdf]);
                assert!(
                    all.all(|x| x.is_finite()),
                    "{p:?} theta_o {theta_o} h {h} {xi:?}: {drawn:?}"
                );
                assert!(drawn.lobe.is_some() == (drawn.pdf > 0.0), "{drawn:?}");
            }
        }
    }
    worst.assert_below(2e-6, "f32 over f64 at its samples, by width");
}
