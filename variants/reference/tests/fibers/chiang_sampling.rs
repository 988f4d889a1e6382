//! The energy-conserving fibre's sampler: inversion, its reports, bounds of its weights, variances.

use super::chiang::{ChiangFiber, clear, inclinations, prepare};
use super::support::{DEG, LargestError, cdf_gap, cells, chi_square, direction, points, rule, sum};
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::Lobe;
use hairis_conformance::is_kept;
use hairis_conformance::published::quadrature::gauss;
use hairis_reference::{ChiangFormulas, Reference, Selection};
use hairis_variants::ChiangDesc;
use hairis_variants::chiang::ChiangParams;

const ROUGHNESSES: [f64; 5] = [1e-3, 0.05, 0.3, 0.7, 1.0];
const BOTH: [Selection; 2] = [Selection::Mean, Selection::ByChannel];

/// Uniform numbers up to both ends of their range.
fn uniforms() -> impl Iterator<Item = f64> {
    let least = 0.5 * f64::from(f32::EPSILON);
    let ends = [0.0, least, 0.5, 1.0 - least];
    ends.into_iter()
        .chain((1..=500).map(|n| (f64::from(n) * 0.618_033_988_749_894_9).fract()))
}

#[test]
fn both_distributions_invert() {
    let (mut cone, mut azimuth) = (LargestError::default(), LargestError::default());
    for beta in ROUGHNESSES {
        let fiber = prepare(&clear(beta, beta, 2.0), 0.4, 0.3);
        for (lobe, xi) in Lobe::FOUR
            .into_iter()
            .flat_map(|lobe| uniforms().map(move |xi| (lobe, xi)))
        {
            let delta = fiber.sample_cone(lobe, xi);
            assert!(
                (0.0..=2.0).contains(&delta),
                "{lobe:?} beta {beta} xi {xi}: delta {delta}"
            );
            cone.see(fiber.cdf_cone(lobe, delta) - xi);
            let x = fiber.sample_azimuth(lobe, xi);
            assert!(x.abs() <= PI, "{lobe:?} beta {beta} xi {xi}: x {x}");
            azimuth.see(fiber.cdf_azimuth(lobe, x) - xi);
        }
    }
    cone.assert_below(4e-16, "cdf of delta at its samples");
    azimuth.assert_below(4e-16, "cdf of x at its samples");
}

#[test]
fn inclinations_follow_the_longitudinal_term() {
    // The differences are the grid's, 300 numbers a side.
    let mut worst = LargestError::default();
    let fibers = ROUGHNESSES
        .into_iter()
        .flat_map(|m| [2.0, -20.0, 45.0].map(|tilt| (m, tilt)));
    for (index, (beta_m, tilt)) in fibers.enumerate() {
        for (turn, theta_o) in [0.0, 50.0, -85.0].into_iter().enumerate() {
            if !is_kept(index + turn) {
                continue;
            }
            let p = clear(beta_m, 0.3, tilt);
            let fiber = prepare(&p, theta_o * DEG, 0.0);
            let rule = inclinations(&p, &fiber, FRAC_PI_2);
            for lobe in Lobe::FOUR {
                let draw = |[a, b]: [f64; 2]| {
                    let [sin, cos] = fiber.sample_inclination(lobe, a, b);
                    assert!(
                        (sin.hypot(cos) - 1.0).abs() < 1e-14 && cos >= 0.0,
                        "a direction"
                    );
                    (sin.atan2(cos), 1.0)
                };
                let drawn = cells(300).map(draw).collect();
                worst.see(cdf_gap(drawn, &rule, |t| {
                    fiber.longitudinal(lobe, t) * t.cos()
                }));
            }
        }
    }
    worst.assert_below(2e-3, "cdf of theta_i");
}

/// Everyday and odd fibres, with inclination and offset.
fn fibers() -> impl Iterator<Item = (ChiangDesc<f64>, Selection, f64, f64)> {
    let presets = ChiangParams::presets().map(|(_, preset)| preset.desc().map(f64::from));
    let betas = [(0.3, 0.3), (0.05, 0.7), (1.0, 0.02)];
    let places = [(0.0, 0.0), (0.7, -0.8), (-1.45, 0.5), (1.3, 0.999)];
    let all = presets.into_iter().flat_map(move |p| {
        betas.map(|(beta_m, beta_n)| ChiangDesc {
            beta_m,
            beta_n,
            ..p
        })
    });
    all.flat_map(move |p| {
        BOTH.into_iter()
            .flat_map(move |s| places.map(|(theta_o, h)| (p, s, theta_o, h)))
    })
}

#[test]
fn a_sample_reports_its_value_and_density_and_keeps_its_bound() {
    let (mut reported, mut over) = (LargestError::default(), LargestError::default());
    for (p, selection, theta_o, h) in fibers() {
        let fiber = ChiangFiber::prepare(&p, selection, direction(theta_o, 0.7), h);
        let returned: [f64; 3] =
            core::array::from_fn(|c| fiber.albedo().0.iter().map(|a| a[c]).sum());
        let mean = returned.iter().sum::<f64>() / 3.0;
        assert!(
            (fiber.probabilities().0.iter().sum::<f64>() - 1.0).abs() < 1e-15,
            "probabilities"
        );
        for xi in points(200) {
            let drawn = fiber.sample(xi);
            let (value, pdf) = fiber.eval_pdf(drawn.wi);
            reported.see(pdf / drawn.pdf - 1.0);
            for c in 0..3 {
                reported.see(value[c] / drawn.value[c] - 1.0);
                let bound = if selection == Selection::Mean {
                    mean
                } else {
                    returned[c]
                };
                over.see(drawn.weight[c] / (3.0 * bound));
            }
        }
    }
    // 3.6e-13: evaluation divides the length out of wi.
    reported.assert_below(4.7e-13, "sample, then evaluate");
    over.assert_below(1.0, "largest weight over its bound");
}

#[test]
fn weights_of_clear_hair_are_one() {
    let mut worst = LargestError::default();
    for (beta_m, beta_n) in ROUGHNESSES
        .into_iter()
        .flat_map(|m| ROUGHNESSES.map(|n| (m, n)))
    {
        for (theta_o, h) in [
            (0.0, 0.0),
            (0.7, -0.8),
            (-1.5, 0.5),
            (1.569, 0.999),
            (0.2, 1.0),
        ] {
            for selection in BOTH {
                let fiber = ChiangFiber::prepare(
                    &clear(beta_m, beta_n, 2.0),
                    selection,
                    direction(theta_o, 0.7),
                    h,
                );
                for drawn in points(50)
                    .map(|xi| fiber.sample(xi))
                    .filter(|drawn| drawn.lobe.is_some())
                {
                    drawn.weight.into_iter().for_each(|w| worst.see(w - 1.0));
                }
            }
        }
    }
    worst.assert_below(1e-15, "weights of clear hair");
}

#[test]
fn variances_are_as_stated() {
    // V under constant light of luminance, of a channel in the mean, and of the worst channel, over h and three inclinations.
    // By symmetry h runs over [0, 1]; a finer rule changes the last digit by 1 at most.
    let expected = [
        ("blond", [0.0007, 0.0149, 0.0329], [0.0024, 0.0144, 0.0263]),
        ("brown", [0.0010, 0.2210, 0.5815], [0.0497, 0.1623, 0.2807]),
        ("red", [0.0018, 0.2513, 0.6854], [0.0647, 0.1663, 0.2767]),
        ("black", [0.0005, 0.0077, 0.0152], [0.0025, 0.0058, 0.0070]),
    ];
    let presets = ChiangParams::presets();
    for (name, mean, by_channel) in expected {
        let preset = presets.iter().find(|preset| preset.0 == name).unwrap().1;
        for (selection, expected) in BOTH.into_iter().zip([mean, by_channel]) {
            let found = variances(&preset.desc().map(f64::from), selection);
            println!("{name} {selection:?}: {found:.4?}");
            for (found, expected) in found.into_iter().zip(expected) {
                let within = 1e-4_f64.max(1e-3 * expected);
                assert!(
                    (found - expected).abs() < within,
                    "{name} {selection:?}: {found} is stated as {expected}"
                );
            }
        }
    }
}

fn variances(p: &ChiangDesc<f64>, selection: Selection) -> [f64; 3] {
    let luminance = |[r, g, b]: [f64; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let coarse = |lo: f64, hi: f64, peaks: [f64; 3], width: f64| {
        let around = peaks
            .into_iter()
            .flat_map(|peak| [peak - width, peak, peak + width]);
        rule(lo, hi, &[], &around.collect::<Vec<_>>())
    };
    let (mut mean, mut weights) = ([0.0; 4], 0.0);
    for (h, w_h) in rule(0.0, 1.0, &[], &[]) {
        for theta_o in [0.0, 45.0, 75.0] {
            let fiber = ChiangFiber::prepare(p, selection, direction(theta_o * DEG, 0.0), h);
            let lobes = [Lobe::R, Lobe::TT, Lobe::TRT];
            let theta = coarse(
                -FRAC_PI_2 + 1e-5,
                FRAC_PI_2 - 1e-5,
                lobes.map(|lobe| fiber.cone(lobe)),
                0.4,
            );
            let phi = coarse(
                0.0,
                2.0 * PI,
                lobes.map(|lobe| fiber.centre(lobe).rem_euclid(2.0 * PI)),
                0.5,
            );
            let mut moments = [0.0; 4];
            for &(t, w_t) in &theta {
                for &(phi, w_phi) in &phi {
                    let (value, pdf) = fiber.eval_pdf(direction(t, phi));
                    let w = w_t * w_phi * t.cos().powi(3) / pdf.max(f64::MIN_POSITIVE);
                    let [r, g, b] = value;
                    for (moment, f) in moments.iter_mut().zip([r, g, b, luminance(value)]) {
                        *moment += w * f * f;
                    }
                }
            }
            let returned: [f64; 3] =
                core::array::from_fn(|c| fiber.albedo().0.iter().map(|a| a[c]).sum());
            let [r, g, b] = returned;
            weights += w_h;
            for (mean, (moment, a)) in
                mean.iter_mut()
                    .zip(moments.into_iter().zip([r, g, b, luminance(returned)]))
            {
                *mean += w_h * (moment / (a * a) - 1.0);
            }
        }
    }
    let [r, g, b, luminance] = mean.map(|sum| sum / weights);
    [luminance, (r + g + b) / 3.0, r.max(g).max(b)]
}

#[test]
fn samples_pass_chi_square_on_the_sphere() {
    let cases = [
        (0.3, 0.3, 0.0, 0.0),
        (0.1, 0.3, 60.0, 0.7),
        (1.0, 0.2, -80.0, -0.95),
        (0.3, 1.0, 85.0, 0.3),
    ];
    for ((beta_m, beta_n, theta_o, h), selection) in
        cases.into_iter().flat_map(|case| BOTH.map(|s| (case, s)))
    {
        let brown = ChiangParams::brown().desc().map(f64::from);
        let p = ChiangDesc {
            beta_m,
            beta_n,
            tilt: 10.0 * DEG,
            ..brown
        };
        let fiber = ChiangFiber::prepare(&p, selection, direction(theta_o * DEG, 0.7), h);
        let turn = 2.0 * PI;
        let centres = [Lobe::R, Lobe::TT, Lobe::TRT]
            .map(|lobe| (0.7 + fiber.centre(lobe) + PI).rem_euclid(turn) - PI);
        let theta = rule(
            -FRAC_PI_2,
            FRAC_PI_2,
            &Lobe::FOUR.map(|lobe| (fiber.cone(lobe), 0.05)),
            &[],
        );
        let value = chi_square(&fiber, &theta, &centres.map(|c| (c, p.scales()[Lobe::TT])));
        println!(
            "beta_m {beta_m} beta_n {beta_n} theta_o {theta_o} {selection:?}: p-value {value:.3}"
        );
        // Sidak's correction of .01 over eight runs.
        assert!(
            value > 1.2e-3,
            "beta_m {beta_m} beta_n {beta_n} theta_o {theta_o} {selection:?}: p-value {value}"
        );
    }
}

#[test]
fn few_offsets_make_the_far_field_of_rough_fibres() {
    // L1 distance, over the azimuth, of the sum of A N at Gauss nodes of h from that at many; its integral is 1.
    let gap = |beta_n: f64, theta_o: f64, count: usize| {
        let p = clear(0.3, beta_n, 0.0);
        let far_field = |nodes: &[(f64, f64)]| {
            let fibers: Vec<_> = nodes
                .iter()
                .map(|&(h, w)| (prepare(&p, theta_o * DEG, h), 0.5 * w))
                .collect();
            let one = |fiber: &ChiangFiber, phi: f64| -> f64 {
                Lobe::FOUR
                    .into_iter()
                    .map(|lobe| fiber.albedo()[lobe][0] * fiber.azimuthal(lobe, phi))
                    .sum()
            };
            let at = |n: u32| f64::from(n) * DEG;
            let all = (0..360).map(|n| fibers.iter().map(|(fiber, w)| w * one(fiber, at(n))).sum());
            all.collect::<Vec<f64>>()
        };
        let (few, exact) = (far_field(&gauss(count)), far_field(&gauss(256)));
        few.iter()
            .zip(&exact)
            .map(|(a, b)| (a - b).abs())
            .sum::<f64>()
            * DEG
    };
    let stated = [
        (0.5, [0.0066, 0.0055]),
        (0.3, [0.0458, 0.1284]),
        (0.2, [0.2287, 0.4571]),
    ];
    for (beta_n, expected) in stated {
        for (theta_o, expected) in [0.0, 60.0].into_iter().zip(expected) {
            let found = gap(beta_n, theta_o, 8);
            println!("beta_n {beta_n} theta_o {theta_o}, 8 nodes: {found:.4}");
            assert!(
                (found - expected).abs() < 0.02 * expected,
                "beta_n {beta_n} theta_o {theta_o}: {found}"
            );
        }
        // 1.7 over the scale of the logistic.
        let count = (1..)
            .find(|n| *n as f64 >= 1.7 / clear(0.3, beta_n, 0.0).scales()[Lobe::TT])
            .unwrap();
        for theta_o in [0.0, 30.0, 60.0, 80.0] {
            let found = gap(beta_n, theta_o, count);
            println!("beta_n {beta_n} theta_o {theta_o}, {count} nodes: {found:.4}");
            // Measured: .0120 up to 60 degrees, .0313 at 80.
            assert!(
                found < if theta_o > 60.0 { 0.04 } else { 0.016 },
                "beta_n {beta_n} theta_o {theta_o}, {count} nodes: {found}"
            );
        }
    }
    let mass = sum(&gauss(8), |h| {
        prepare(&clear(0.3, 0.3, 0.0), 0.3, h)
            .albedo()
            .0
            .iter()
            .map(|a| a[0])
            .sum::<f64>()
    });
    assert!(
        (0.5 * mass - 1.0).abs() < 1e-14,
        "the furnace is exact for any nodes: {mass}"
    );
}
