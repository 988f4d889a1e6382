//! Kajiya and Kay's formulas: energy, reciprocity, densities, sampling.

use super::support::{
    DEG, LargestError, cdf_gap, cells, chi_square, corners, direction, points, rule, sum,
};
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::Lobe;
use hairis_conformance::is_kept;
use hairis_reference::{KajiyaKayReference, Real, Reference, cosine_power_integral};
use hairis_variants::KajiyaKayDesc;
use hairis_variants::kajiya_kay::{Form, KajiyaKayParams};

type KajiyaKayFiber = KajiyaKayReference<f64>;
const FORMS: [Form; 2] = [Form::Reciprocal, Form::Published];
const EXPONENTS: [f64; 7] = [1.0, 1.5, 5.0, 20.0, 80.0, 1000.0, 1e4];
/// Inclinations of `wo`, degrees.
const THETA_O: [f64; 9] = [0.0, 20.0, -45.0, 60.0, 75.0, -85.0, 89.0, 89.9, -90.0];
const SPECULAR: Lobe = Lobe::slot(1);
const GRAZING: f64 = 1.000_01e-5;

fn parameters(exponent: f64, form: Form) -> KajiyaKayDesc<f64> {
    KajiyaKayDesc {
        kd: [0.3, 0.2, 0.1],
        ks: [0.2, 0.25, 0.3],
        exponent,
        form,
    }
}

/// The highlight alone.
fn specular(exponent: f64, form: Form) -> KajiyaKayDesc<f64> {
    KajiyaKayDesc {
        kd: [0.0; 3],
        ks: [1.0; 3],
        ..parameters(exponent, form)
    }
}

/// (parameters, `theta_o`) over the grid, `theta_o` in radians.
fn grid(
    build: fn(f64, Form) -> KajiyaKayDesc<f64>,
) -> impl Iterator<Item = (KajiyaKayDesc<f64>, f64)> {
    let cases = FORMS
        .into_iter()
        .flat_map(|form| EXPONENTS.map(|exponent| (exponent, form)));
    cases
        .flat_map(move |(exponent, form)| THETA_O.map(|theta| (build(exponent, form), theta * DEG)))
}

/// Panels of `theta_i` between the discarded caps: the peak, and the kinks at `theta_i + theta_o` and
/// `theta_i + 2 theta_o` of a right angle.
fn inclinations(exponent: f64, theta_o: f64) -> Vec<(f64, f64)> {
    let edge = FRAC_PI_2 - GRAZING;
    let rights = [-3.0, -1.0, 1.0, 3.0].map(|turns| turns * FRAC_PI_2);
    let mut peaks = vec![
        (-theta_o, exponent.sqrt().recip()),
        (edge, 1e-4),
        (-edge, 1e-4),
    ];
    peaks.extend(rights.map(|right| (right - theta_o, 1e-4)));
    rule(
        -edge,
        edge,
        &peaks,
        &rights.map(|right| right - 2.0 * theta_o),
    )
}

#[test]
fn powers_of_a_cosine_integrate_to_b() {
    // Measured: 2.4e-12, at 1e4.
    let mut worst = LargestError::default();
    for n in EXPONENTS.into_iter().chain([0.5, 2.0, 3.0]) {
        let found = sum(
            &rule(
                -FRAC_PI_2,
                FRAC_PI_2,
                &[(0.0, 1.0 / n.sqrt()), (FRAC_PI_2, 1e-6), (-FRAC_PI_2, 1e-6)],
                &[],
            ),
            |x| x.cos().powf(n),
        );
        worst.see(cosine_power_integral(n) / found - 1.0);
    }
    worst.assert_below(4e-12, "B(n)");
}

#[test]
fn the_albedo_is_the_integral_of_the_value() {
    let (mut diffuse, mut highlight, mut trait_sum) = (
        LargestError::default(),
        LargestError::default(),
        LargestError::default(),
    );
    for (p, theta_o) in grid(parameters) {
        let fiber = KajiyaKayFiber::prepare(&p, direction(theta_o, 0.7));
        let rule = inclinations(p.exponent, theta_o);
        let lobe = |i: usize| {
            2.0 * PI
                * sum(&rule, |t| {
                    let at = fiber.lobes(direction(t, 0.2)).0[i];
                    at.value * at.color[1] * t.cos() * t.cos()
                })
        };
        let albedo = Reference::albedo(&fiber);
        diffuse.see(lobe(0) - albedo.0[0][1]);
        highlight.see(lobe(1) - albedo.0[1][1]);
        let whole = 2.0
            * PI
            * sum(&rule, |t| {
                fiber.eval(direction(t, 0.2))[1] * t.cos() * t.cos()
            });
        trait_sum.see(whole - albedo.0[0][1] - albedo.0[1][1]);
    }
    diffuse.assert_below(1e-15, "diffuse albedo");
    highlight.assert_below(8e-10, "specular albedo");
    trait_sum.assert_below(8e-10, "albedo of both");
}

#[test]
fn the_highlight_never_gains_energy() {
    let mut excess = LargestError::default();
    for form in FORMS {
        for exponent in EXPONENTS {
            let mut before = 1.0 + 1e-11;
            for step in 0..=90 {
                let theta_o = f64::from(step) * DEG;
                let rho =
                    KajiyaKayFiber::prepare(&specular(exponent, form), direction(theta_o, 0.0))
                        .specular_albedo();
                assert!(
                    rho <= before && rho >= 0.0,
                    "{form:?} p {exponent} theta_o {step}: {rho} after {before}"
                );
                before = rho + 1e-11;
                if step == 0 {
                    excess.see(rho - 1.0);
                }
            }
        }
    }
    // B(n) is formed from logarithms of the gamma function.
    excess.assert_below(1e-11, "albedo at theta_o 0");
}

#[test]
fn the_reciprocal_form_is_reciprocal_and_the_published_one_is_not() {
    let (mut worst, mut published) = (LargestError::default(), LargestError::default());
    for exponent in EXPONENTS {
        for [a, b, c] in points(200) {
            let [one, other] = [
                direction((a - 0.5) * 3.1, 6.0 * b),
                direction((c - 0.5) * 3.1, 6.0 * a),
            ];
            let pair = |form| {
                let value =
                    |wo, wi| KajiyaKayFiber::prepare(&parameters(exponent, form), wo).eval(wi)[0];
                value(one, other) / value(other, one) - 1.0
            };
            worst.see(pair(Form::Reciprocal));
            published.see(pair(Form::Published));
        }
    }
    worst.assert_below(4e-12, "reciprocity");
    assert!(published.0 > 1.0, "the published form: {}", published.0);
}

#[test]
fn densities_integrate_to_one() {
    // What falls into the caps of 1e-5 rad: up to 8e-4, of a narrow highlight that points along the fibre.
    let (mut worst, mut grazing) = (LargestError::default(), LargestError::default());
    for (p, theta_o) in grid(parameters) {
        let fiber = KajiyaKayFiber::prepare(&p, direction(theta_o, 0.7));
        let rule = inclinations(p.exponent, theta_o);
        let mass = |pdf: &dyn Fn([f64; 3]) -> f64| {
            2.0 * PI * sum(&rule, |t| pdf(direction(t, 0.2)) * t.cos())
        };
        let of = |lobe: usize| mass(&|wi| fiber.lobes(wi).0[lobe].pdf);
        for mass in [of(0), of(1), mass(&|wi| fiber.pdf(wi))] {
            if theta_o.abs() < 80.0 * DEG {
                &mut worst
            } else {
                &mut grazing
            }
            .see(mass - 1.0);
        }
    }
    worst.assert_below(2e-10, "mass of the densities");
    grazing.assert_below(1e-3, "mass of the densities beside the axis");
}

#[test]
fn the_highlight_draws_its_density() {
    // The cdf of theta_i on a grid of two numbers, with both signs weighed by their shares. The differences are the grid's.
    let mut worst = LargestError::default();
    for (n, (p, theta_o)) in grid(specular).enumerate() {
        if theta_o.abs() > 80.0 * DEG || !is_kept(n) {
            continue;
        }
        let fiber = KajiyaKayFiber::prepare(&p, direction(theta_o, 0.0));
        let both = |[xi_radius, xi_turn]: [f64; 2]| {
            let [sin, cos] = fiber.sample_angle(xi_radius, xi_turn);
            let (x, kept) = (sin.atan2(cos), fiber.share_kept(sin, cos));
            [(x - theta_o, kept), (-x - theta_o, 1.0 - kept)]
        };
        let drawn = cells(300).flat_map(both).collect();
        let density = |t: f64| 2.0 * PI * fiber.lobes(direction(t, 0.0))[SPECULAR].pdf * t.cos();
        worst.see(cdf_gap(drawn, &inclinations(p.exponent, theta_o), density));
    }
    worst.assert_below(6e-4, "cdf of the highlight");
}

#[test]
fn a_sample_reports_its_value_and_density_and_keeps_its_bound() {
    let (mut worst, mut over) = (LargestError::default(), LargestError::default());
    for (p, theta_o) in grid(parameters) {
        let fiber = KajiyaKayFiber::prepare(&p, direction(theta_o, 0.7));
        let m = if p.form == Form::Reciprocal { 2.0 } else { 1.0 };
        let most = cosine_power_integral(p.exponent) / cosine_power_integral(p.exponent + m);
        let [w_d, w_s, ..] = fiber.probabilities().0;
        assert!((w_d + w_s - 1.0).abs() < 1e-15, "probabilities");
        for xi in points(400) {
            let drawn = fiber.sample(xi);
            if drawn.lobe.is_none() {
                continue;
            }
            let (value, pdf) = fiber.eval_pdf(drawn.wi);
            worst.see(pdf / drawn.pdf - 1.0);
            for (value, drawn) in value.into_iter().zip(drawn.value) {
                worst.see(value / drawn - 1.0);
            }
            for (c, weight) in drawn.weight.into_iter().enumerate() {
                over.see(weight / (p.kd[c] / w_d).max(p.ks[c] * most / w_s));
            }
        }
    }
    // A power of 1e4 of a rounded cosine.
    worst.assert_below(4e-12, "sample, then evaluate");
    over.assert_below(1.0 + 1e-11, "largest weight over its bound");
}

#[test]
fn the_highlights_variance_is_as_stated() {
    let theta_o = [0.0, 45.0, 75.0, 85.0];
    let reciprocal = [
        (5.0, [0.037, 0.000, 0.36, 0.90], [0.196, 0.114]),
        (20.0, [0.004, 0.000, 0.19, 0.89], [0.109, 0.043]),
        (80.0, [0.000, 0.000, 0.035, 0.52], [0.078, 0.018]),
    ];
    let published = [
        (5.0, [0.012, 0.009, 0.042, 0.24]),
        (20.0, [0.001, 0.001, 0.007, 0.16]),
        (80.0, [0.000, 0.000, 0.000, 0.05]),
    ];
    let variance = |p: &KajiyaKayDesc<f64>, theta_o: f64| {
        let fiber = KajiyaKayFiber::prepare(p, direction(theta_o, 0.0));
        let moment = |t: f64| {
            let (value, pdf) = fiber.eval_pdf(direction(t, 0.0));
            let f = value[0] * t.cos();
            if pdf > 0.0 {
                f * f / pdf * t.cos()
            } else {
                0.0
            }
        };
        let rho = fiber.specular_albedo();
        (
            2.0 * PI * sum(&inclinations(p.exponent, theta_o), moment) / (rho * rho) - 1.0,
            rho,
        )
    };
    for (exponent, expected, albedos) in reciprocal {
        for (i, theta) in theta_o.into_iter().enumerate() {
            let (found, rho) = variance(&specular(exponent, Form::Reciprocal), theta * DEG);
            println!("reciprocal p {exponent} theta_o {theta}: V {found:.4} rho {rho:.4}");
            assert!(
                (found - expected[i]).abs() < 6e-3,
                "p {exponent} theta_o {theta}: {found}"
            );
            assert!(
                i < 2 || (rho - albedos[i - 2]).abs() < 6e-4,
                "p {exponent} theta_o {theta}: albedo {rho}"
            );
        }
    }
    for (exponent, expected) in published {
        for (theta, expected) in theta_o.into_iter().zip(expected) {
            let (found, _) = variance(&specular(exponent, Form::Published), theta * DEG);
            println!("published p {exponent} theta_o {theta}: V {found:.4}");
            assert!(
                (found - expected).abs() < 6e-3,
                "p {exponent} theta_o {theta}: {found}"
            );
        }
    }
}

#[test]
fn samples_pass_chi_square_on_the_sphere() {
    let cases = [
        (1.0, 30.0),
        (5.0, 75.0),
        (80.0, 45.0),
        (80.0, -85.0),
        (1000.0, 10.0),
    ];
    for (form, (exponent, theta_o)) in FORMS
        .into_iter()
        .flat_map(|form| cases.map(|case| (form, case)))
    {
        let fiber =
            KajiyaKayFiber::prepare(&parameters(exponent, form), direction(theta_o * DEG, 0.7));
        let p = chi_square(&fiber, &inclinations(exponent, theta_o * DEG), &[]);
        // Sidak's correction of .01 over ten runs.
        assert!(
            p > 1e-3,
            "{form:?} p {exponent} theta_o {theta_o}: p-value {p}"
        );
    }
}

#[test]
fn single_precision_follows_and_is_total() {
    let mut worst = LargestError::default();
    for (p, theta_o) in grid(parameters) {
        let single = KajiyaKayDesc {
            kd: p.kd.map(f32::from_f64),
            ks: p.ks.map(f32::from_f64),
            exponent: f32::from_f64(p.exponent),
            form: p.form,
        };
        let wo = direction(theta_o, 0.7).map(f32::from_f64);
        let fiber = KajiyaKayReference::prepare(&single, wo);
        let double = KajiyaKayFiber::prepare(&p, wo.map(f64::from));
        for [a, b, _] in points(100) {
            let wi = direction((a - 0.5) * 3.1, 6.0 * b).map(f32::from_f64);
            let (value, pdf) = fiber.eval_pdf(wi);
            let (value64, pdf64) = double.eval_pdf(wi.map(f64::from));
            worst.see((f64::from(pdf) / pdf64 - 1.0) / p.exponent.max(10.0));
            worst.see((f64::from(value[0]) / value64[0] - 1.0) / p.exponent.max(10.0));
        }
        for xi in corners() {
            let drawn = fiber.sample(xi);
            let finite = drawn
                .wi
                .iter()
                .chain(&drawn.value)
                .chain(&drawn.weight)
                .chain([&drawn.pdf]);
            assert!(
                finite.clone().all(|x| x.is_finite()),
                "{p:?} {theta_o} {xi:?}: {drawn:?}"
            );
            assert!(
                drawn.pdf >= 0.0 && drawn.lobe.is_some() == (drawn.pdf > 0.0),
                "{drawn:?}"
            );
        }
    }
    worst.assert_below(1.5e-7, "f32 over f64, by exponent");
    let nothing = KajiyaKayDesc {
        kd: [0.0; 3],
        ks: [0.0; 3],
        ..parameters(80.0, Form::Reciprocal)
    };
    assert_eq!(
        KajiyaKayFiber::prepare(&nothing, [0.0, 1.0, 0.0])
            .sample([0.5; 3])
            .lobe,
        None,
        "nothing scatters"
    );
    let bright = KajiyaKayParams::default().scaled(1e37).unwrap();
    let bright = KajiyaKayReference::<f32>::prepare(bright.desc(), [0.0, 1.0, 0.0]);
    assert!(
        bright.sample([0.9, 0.5, 0.5]).weight[0].is_finite(),
        "bright colours"
    );
}
