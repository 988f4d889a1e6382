//! Implementations rebuilt with the faults that renderers had, and right ones.

use super::{answered, cases, many_cases, multiply, multiply_lobe, verdicts};
use core::f64::consts::PI;
use hairis::Hit;
use hairis::simd::Vec3x;
use hairis_materials::MaterialSpec;
use hairis_materials::material::single;
use hairis_reference::{Reference, reference};
use hairis_variants::ModelId;
use serde_json::{Value, json};

/// Numbers of an array.
pub(crate) fn three(value: &Value) -> [f64; 3] {
    [0, 1, 2].map(|k| value[k].as_f64().unwrap())
}

fn cos(v: [f64; 3]) -> f64 {
    v[1].hypot(v[2])
}

/// Returns the formulas at a case, with parameters changed.
pub(crate) fn formulas(case: &Value, set: &[&str]) -> (ModelId, Box<dyn Reference<f64>>) {
    let object = json!({ "model": case["model"], "params": case["params"] }).to_string();
    let [spec] = &MaterialSpec::parse_all(&object).unwrap()[..] else {
        panic!("one material")
    };
    let set: Vec<String> = set.iter().map(|&text| text.to_owned()).collect();
    let spec = spec.set(&set).unwrap();
    let h = case["h"].as_f64().unwrap_or(0.0);
    (
        spec.model,
        reference(spec.model, &spec.values, three(&case["wo"]), h).unwrap(),
    )
}

/// Asserts that these verdicts are wrong with these words, in order, and that all others are right.
pub(crate) fn assert_wrong(what: &str, answers: &str, wrong: &[&str]) {
    let lines = verdicts(answers);
    let found: Vec<_> = lines.iter().filter(|line| line.contains("WRONG")).collect();
    let fits = found.len() == wrong.len()
        && found
            .iter()
            .zip(wrong)
            .all(|(line, words)| words.split(" .. ").all(|words| line.contains(words)));
    assert!(fits, "{what}: {lines:#?}");
}

#[test]
fn right_implementations_raise_no_alarm() {
    for model in ["chiang", "gaussian", "cauchy", "kajiya-kay", "d-eon"] {
        let cases = cases(model);
        assert_wrong(model, &answered(&cases, |_, _| ()), &[]);
        // The kernels, in single precision.
        let specs: Vec<_> = (cases.iter())
            .map(|case| {
                let object = json!({ "model": model, "params": case["params"] }).to_string();
                MaterialSpec::parse_all(&object).unwrap().swap_remove(0)
            })
            .collect();
        let kernels = |case: &Value, line: &mut Value| {
            let spec = &specs[usize::try_from(case["case"].as_u64().unwrap()).unwrap()];
            let [wo, wi] = ["wo", "wi"].map(|name| {
                let [x, y, z] = three(&case[name]).map(single);
                Vec3x::new(x, y, z)
            });
            let h = single(case["h"].as_f64().unwrap_or(0.0));
            let bsdf = spec.material.prepare(Hit { wo, h });
            let eval = bsdf.eval_pdf(wi.into());
            (line["value"], line["pdf"]) = (json!(eval.value), json!(eval.pdf));
            let lobes = bsdf.lobes(wi.into()).0;
            for (name, lobe) in spec.model.lobes().iter().zip(lobes) {
                line["lobes"][*name] = json!(lobe.color.map(|c| c * lobe.value));
            }
        };
        assert_wrong(model, &answered(&cases, kernels), &[]);
    }
}

#[test]
fn constant_factors_are_named() {
    let cases = cases("chiang");
    let last = ModelId::find("chiang", None).unwrap().lobes()[3];
    // MaterialX before #2961: the uniform azimuth of the last lobe was pi/2 in place of 1/(2 pi).
    let before = answered(&cases, |_, line| multiply_lobe(line, last, PI * PI));
    let factor = format!("lobe {last} .. WRONG by the factor pi^2 (9.86960)");
    assert_wrong("pi/2", &before, &[&factor, "value .. in shape"]);
    // MaterialX before #3018: 1/pi too much in all lobes.
    let extra = answered(&cases, |_, line| {
        for name in ["value", "lobes"] {
            match &mut line[name] {
                Value::Object(lobes) => lobes.values_mut().for_each(|rgb| multiply(rgb, 1.0 / PI)),
                value => multiply(value, 1.0 / PI),
            }
        }
    });
    let names = ModelId::find("chiang", None).unwrap().lobes();
    let mut wrong: Vec<String> = (names.iter())
        .map(|name| format!("lobe {name} .. WRONG by the factor 1/pi (0.31831)"))
        .collect();
    wrong.push("value .. factor 1/pi".to_owned());
    let wrong: Vec<&str> = wrong.iter().map(String::as_str).collect();
    assert_wrong("1/pi", &extra, &wrong);
    // A value that contains the cosine, as many interfaces ask for, and one that has it twice over 2.
    for (power, text) in [
        (1, "factor cos theta_i, else"),
        (-1, "factor 1/cos theta_i, else"),
    ] {
        let cosine = answered(&cases, |case, line| {
            multiply(&mut line["value"], cos(three(&case["wi"])).powi(power));
        });
        assert_wrong(text, &cosine, &[&format!("value .. {text}")]);
    }
    let half = answered(&cases, |case, line| {
        multiply(&mut line["pdf"], 0.5 * cos(three(&case["wi"])));
    });
    assert_wrong(
        "half",
        &half,
        &[
            "pdf .. cos theta_i times 1/2 (0.50000)",
            "pdf's integral .. integrates to",
        ],
    );
}

#[test]
fn wrong_shapes_are_found_by_lobe() {
    // The modified Bessel function of eq. 7 of Chiang et al. as ten terms of its series, without a branch for large arguments.
    let cases_of_chiang = cases("chiang");
    let cut_short = answered(&cases_of_chiang, |case, line| {
        let (model, _) = formulas(case, &[]);
        let beta_m = case["params"]["beta_m"].as_f64().unwrap();
        let v = (0.726 * beta_m + 0.812 * beta_m.powi(2) + 3.7 * beta_m.powi(20)).powi(2);
        let product = cos(three(&case["wo"])) * cos(three(&case["wi"]));
        for (lobe, scale) in model.lobes().iter().zip([1.0, 0.25, 4.0, 4.0]) {
            multiply_lobe(line, lobe, series(product / (scale * v)));
        }
    });
    let lines = verdicts(&cut_short);
    let wrong = |name: &str| {
        let line = lines.iter().find(|line| line.starts_with(name)).unwrap();
        line.contains("WRONG in shape: 0.")
    };
    assert!(
        wrong("lobe r ") && wrong("lobe tt ") && wrong("value"),
        "{lines:#?}"
    );

    // The width of R for all lobes, as of tables that are filled with one width.
    let cases = cases("gaussian");
    let one_width = answered(&cases, |case, line| {
        let [r, ..] = three(&case["params"]["beta"]);
        let (model, point) = formulas(case, &[&format!("beta={r},{r},{r}")]);
        let found = hairis_referee::vectors::expected(model, &*point, three(&case["wi"]));
        (line["lobes"], line["value"]) = (found["lobes"].clone(), found["value"].clone());
    });
    assert_wrong(
        "one width",
        &one_width,
        &[
            "lobe tt .. in shape",
            "lobe trt .. in shape",
            "lobe glint .. in shape",
            "value .. in shape",
        ],
    );

    // Glints that are added to TRT without taking their share of it from the rest: more light than the model returns.
    let bright = answered(&cases, |_, line| multiply_lobe(line, "trt", 9.5));
    let words = [
        "lobe trt .. factor 9.50000",
        "value .. in shape",
        "energy .. of the light",
    ];
    assert_wrong("glints", &bright, &words);
}

/// Glints of `MoonRay`: Gaussians of the azimuth with weights that are themselves Gaussians of it, and the rest of TRT for what they leave.
#[test]
fn weights_that_depend_on_the_azimuth_are_no_mixture() {
    let answers = answered(&cases("gaussian"), |case, line| {
        let number = |name: &str| case["params"][name].as_f64().unwrap();
        let phi = |name: &str| {
            case[name][2]
                .as_f64()
                .unwrap()
                .atan2(case[name][1].as_f64().unwrap())
        };
        let apart = (phi("wo") - phi("wi")).cos().acos() - number("phi_g");
        let weight = (-0.5 * (apart / number("gamma_g")).powi(2)).exp();
        multiply_lobe(line, "glint", weight);
        multiply_lobe(line, "trt", 1.0 - weight);
    });
    let words = [
        "lobe trt .. in shape",
        "lobe glint .. in shape",
        "value .. in shape",
    ];
    assert_wrong("MoonRay", &answers, &words);
}

#[test]
fn densities_of_another_sampler_are_found() {
    // The value without absorption in place of the density of the sampler.
    let cases = many_cases("chiang", 800);
    let clear = answered(&cases, |case, line| {
        let (_, point) = formulas(case, &["sigma_a=0,0,0"]);
        line["pdf"] = json!(point.eval(three(&case["wi"]))[0]);
    });
    assert_wrong(
        "clear",
        &clear,
        &["pdf .. in shape", "pdf's integral .. integrates to 1."],
    );
    // With the cosine it is the density of the same lobes, chosen by the light that they would return without absorption.
    let clear = answered(&cases, |case, line| {
        let (_, point) = formulas(case, &["sigma_a=0,0,0"]);
        let wi = three(&case["wi"]);
        line["pdf"] = json!(point.eval(wi)[0] * cos(wi));
    });
    assert_wrong("with the cosine", &clear, &[]);
    assert!(verdicts(&clear)[5].contains("other probabilities"));
}

#[test]
fn other_probabilities_of_lobes_are_no_fault() {
    // Lobes that are chosen by their luminance, and evenly.
    let cases = cases("chiang");
    let density = |case: &Value, weigh: &dyn Fn([f64; 3]) -> f64| {
        let (_, point) = formulas(case, &[]);
        let [lobes @ .., _] = point.lobes(three(&case["wi"])).0;
        let weights = lobes.map(|lobe| weigh(lobe.color));
        let parts = lobes.iter().zip(weights).map(|(lobe, w)| lobe.pdf * w);
        parts.sum::<f64>() / weights.iter().sum::<f64>()
    };
    let luminance = |[r, g, b]: [f64; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
    for weigh in [&luminance as &dyn Fn([f64; 3]) -> f64, &|_| 1.0] {
        let answers = answered(&cases, |case, line| {
            line["pdf"] = json!(density(case, weigh))
        });
        assert_wrong("probabilities", &answers, &[]);
        let lines = verdicts(&answers);
        assert!(lines[5].contains("other probabilities"), "{lines:#?}");
    }
    let answers = answered(&cases, |case, line| {
        line["pdf"] = json!(0.9 * density(case, &luminance));
    });
    assert_wrong(
        "sum",
        &answers,
        &["pdf .. in shape", "pdf's integral .. integrates to 0.9"],
    );
}

/// Ten terms of the series of I0, over I0.
fn series(x: f64) -> f64 {
    let terms = |count: u32| {
        let mut term = 1.0;
        (1..count).fold(1.0, |sum, k| {
            term *= (0.5 * x / f64::from(k)).powi(2);
            sum + term
        })
    };
    terms(10) / terms(2000)
}
