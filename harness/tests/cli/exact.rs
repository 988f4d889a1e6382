//! `hairis eval --path f64` computes from its input as it is, not from its input rounded to single precision.

use super::{eval, numbers};
use glam::DVec3;
use hairis::params::HairDesc;
use hairis_reference::{
    ChiangConstants, HairReference, KajiyaKayConstants, MatchedReference, Reference, Selection,
    Shape,
};
use hairis_variants::ChiangDesc;
use hairis_variants::KajiyaKayDesc;
use hairis_variants::ModelId;
use hairis_variants::chiang::Shifts;
use hairis_variants::kajiya_kay::Form;
use serde_json::{Value, json};

// None of these is a number of single precision.
const WO: [f64; 3] = [0.6, 0.8, 0.0];
const WI: [f64; 3] = [0.28, -0.936, 0.2137];
const XI: [f64; 3] = [0.3, 0.7, 0.9];
const H: f64 = 0.35;

/// Checks that the value, density and sample of a line are those of `point`, to `1e-12`.
fn assert_exact(line: &Value, point: &impl Reference<f64>) {
    let wi: [f64; 3] = DVec3::from(WI).normalize().into();
    let mut at_wi = line.clone();
    at_wi["wi"] = json!(wi);
    let mut at_xi = line.clone();
    at_xi["xi"] = json!(XI);
    let answers = eval("f64", &[at_wi, at_xi]).json();
    let (value, pdf) = point.eval_pdf(wi);
    let drawn = point.sample(XI);
    let near = |name: &str, got: &Value, expected: &[f64]| {
        let got = if got.is_array() {
            numbers(got)
        } else {
            vec![got.as_f64().unwrap()]
        };
        for (got, expected) in got.iter().zip(expected) {
            assert!(
                (got - expected).abs() <= 1e-12 * expected.abs(),
                "{name} of {line}: {got:e}, not {expected:e}"
            );
        }
    };
    assert!(
        value[0] > 0.0 && drawn.lobe.is_some(),
        "{line}: nothing to compare"
    );
    near("s", &answers[0]["s"], &value);
    near("pdf", &answers[0]["pdf"], &[pdf]);
    near("wi", &answers[1]["wi"], &drawn.wi);
    near("weight", &answers[1]["weight"], &drawn.weight);
}

#[test]
fn the_published_model() {
    let p = HairDesc {
        alpha: [-0.13, 0.065, 0.2],
        beta: [0.13, 0.41, 0.26],
        gamma_tt: 0.7,
        gamma_g: 0.17,
        phi_g: 0.61,
        i_r: [0.3, 0.31, 0.32],
        i_tt: [0.8, 0.6, 0.4],
        i_trt: [0.7, 0.5, 0.3],
        i_g: 0.55,
    };
    let line = |model: &str, sampler: &str| {
        json!({
            "model": model, "sampler": sampler, "wo": WO,
            "params": {
                "alpha": p.alpha, "beta": p.beta, "gamma_tt": p.gamma_tt, "gamma_g": p.gamma_g, "phi_g": p.phi_g,
                "i_r": p.i_r, "i_tt": p.i_tt, "i_trt": p.i_trt, "i_g": p.i_g
            }
        })
    };
    for (model, shape) in [("gaussian", Shape::Gaussian), ("cauchy", Shape::Cauchy)] {
        assert_exact(
            &line(model, "published"),
            &HairReference::prepare(&p, shape, WO),
        );
        assert_exact(
            &line(model, "matched"),
            &MatchedReference::prepare(&p, shape, WO, 9),
        );
    }
}

#[test]
fn kajiya_kay() {
    for (word, form) in [
        ("reciprocal", Form::Reciprocal),
        ("published", Form::Published),
    ] {
        let p = KajiyaKayDesc {
            kd: [0.3, 0.2, 0.1],
            ks: [0.15, 0.14, 0.13],
            exponent: 80.1,
            form,
        };
        let params = json!({"kd": p.kd, "ks": p.ks, "exponent": p.exponent, "form": word});
        let line = json!({"model": "kajiya-kay", "wo": WO, "params": params});
        assert_exact(&line, &KajiyaKayConstants::new(&p).prepare(WO));
    }
}

#[test]
fn chiang_by_absorption_melanin_and_color() {
    let (beta_n, melanin, color) = (0.31_f64, [0.9, 0.2], [0.6, 0.4, 0.2]);
    // Both formulas as d'Eon et al. 2011 and Chiang et al. 2016 print them.
    let of_melanin: [f64; 3] = core::array::from_fn(|c| {
        melanin[0] * [0.419, 0.697, 1.37][c] + melanin[1] * [0.187, 0.4, 1.05][c]
    });
    // The formula as MaterialX prints it: a quantity of melanin, of which the redness is pheomelanin.
    let quantity = -(1.0_f64 - 0.7).ln();
    let of_amount: [f64; 3] = core::array::from_fn(|c| {
        quantity * (0.6 * [0.419, 0.697, 1.37][c] + 0.4 * [0.187, 0.4, 1.05][c])
    });
    let powers = [2, 3, 4, 5].map(|n| beta_n.powi(n));
    let denominator = 5.969 - 0.215 * beta_n + 2.532 * powers[0] - 10.73 * powers[1]
        + 5.574 * powers[2]
        + 0.245 * powers[3];
    let of_color = color.map(|c: f64| (c.ln() / denominator).powi(2));
    // Cycles' pigments by name, and half a turn per unit of cuticle angle.
    let of_cycles: [f64; 3] = core::array::from_fn(|c| {
        melanin[0] * [0.506, 0.841, 1.653][c] + melanin[1] * [0.343, 0.733, 1.924][c]
    });
    let cycles = ChiangDesc {
        beta_m: 0.3,
        beta_n,
        tilt: core::f64::consts::PI * (0.52 - 0.5),
        eta: 1.55,
        sigma_a: of_cycles,
        tint_r: [0.9, 0.5, 0.1],
        tint_tt: [0.3, 0.2, 0.7],
        tint_trt: [0.0, 1.0, 0.6],
        width_m: [1.3, 0.7, 1.1],
        width_n: [0.6, 0.9, 1.7],
        ..ChiangDesc::default().map(f64::from)
    };
    let line = json!({"model": "chiang", "wo": WO, "h": H, "params": {
        "beta_m": 0.3, "beta_n": beta_n, "cuticle_angle": 0.52,
        "melanin": melanin, "eumelanin": "cycles", "pheomelanin": "cycles",
        "tint_r": cycles.tint_r, "tint_tt": cycles.tint_tt, "tint_trt": cycles.tint_trt,
        "width_m": cycles.width_m, "width_n": cycles.width_n, "eta": 1.55,
    }});
    assert_exact(
        &line,
        &ChiangConstants::new(&cycles, Selection::Mean).prepare(WO, H),
    );
    for (field, numbers, sigma_a) in [
        ("sigma_a", json!([0.3, 0.5, 0.7]), [0.3, 0.5, 0.7]),
        ("melanin", json!(melanin), of_melanin),
        ("melanin_amount", json!([0.7, 0.4]), of_amount),
        ("color", json!(color), of_color),
    ] {
        let p = ChiangDesc {
            beta_m: 0.3,
            beta_n,
            tilt: 0.03,
            eta: 1.55,
            sigma_a,
            shifts: Shifts::SmallAngle,
            ..ChiangDesc::default().map(f64::from)
        };
        let mut params = json!({"beta_m": p.beta_m, "beta_n": beta_n, "tilt": p.tilt, "eta": p.eta, "shifts": "small-angle"});
        params[field] = numbers;
        for (word, selection) in [
            ("mean", Selection::Mean),
            ("by-channel", Selection::ByChannel),
        ] {
            // Some builds lack one of the two.
            if ModelId::find("chiang", Some(word)).is_some() {
                let line =
                    json!({"model": "chiang", "select": word, "params": params, "wo": WO, "h": H});
                assert_exact(&line, &ChiangConstants::new(&p, selection).prepare(WO, H));
            }
        }
    }
}
