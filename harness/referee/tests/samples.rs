//! Samples beside the density that a program states, and albedos.

use super::{answered, cases, many_cases, multiply, verdicts};
use crate::faults::{assert_wrong, formulas, three};
use hairis_reference::{Reference, RtxcrFaults, RtxcrReference};
use hairis_variants::DEonDesc;
use serde_json::{Value, json};

/// Uniform numbers after splitmix64.
struct Uniform(u64);

impl Uniform {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn some<const N: usize>(&mut self) -> [f64; N] {
        core::array::from_fn(|_| self.next())
    }
}

/// Returns the answers with samples at the first case of each shading point, of the formulas with parameters changed.
fn with_samples(cases: &[Value], count: usize, seed: u64, set: &[&str]) -> String {
    let mut uniform = Uniform(seed);
    let mut scene = Value::Null;
    let mut lines = Vec::new();
    for (case, line) in cases.iter().zip(answered(cases, |_, _| ()).lines()) {
        let mut line: Value = serde_json::from_str(line).unwrap();
        if case["scene"] != scene {
            scene = case["scene"].clone();
            let (_, point) = formulas(case, set);
            let draw = |_| {
                let drawn = point.sample(uniform.some());
                drawn.lobe.map(|_| drawn.wi)
            };
            line["samples"] = json!((0..count).map(draw).collect::<Vec<_>>());
        }
        lines.push(line.to_string());
    }
    lines.join("\n")
}

#[test]
fn right_samples_raise_no_alarm() {
    for model in ["chiang", "gaussian", "cauchy", "kajiya-kay", "d-eon"] {
        let cases = many_cases(model, 32);
        for seed in 1..4 {
            let answers = with_samples(&cases, 1000, seed, &[]);
            assert_wrong(model, &answers, &[]);
            let lines = verdicts(&answers);
            let words = "samples          right: chi-square";
            assert!(
                lines.iter().any(|line| line.starts_with(words)),
                "{lines:?}"
            );
        }
    }
}

#[test]
fn few_samples_say_nothing() {
    let cases = cases("gaussian");
    for count in [1, 31] {
        let answers = with_samples(&cases, count, 1, &[]);
        let lines = verdicts(&answers);
        let says = lines.iter().any(|line| line.starts_with("samples"));
        assert!(!says, "{count}: {lines:?}");
    }
}

#[test]
fn samples_of_another_density_are_found() {
    let samples = ["samples .. WRONG: chi-square .. from the viewer, from line"];
    for (model, set) in [
        // A tilt without its sign, and a width that is squared once too little.
        ("chiang", "tilt=-0.05"),
        ("chiang", "beta_m=0.4"),
        ("chiang", "sigma_a=0,0,0"),
        ("kajiya-kay", "exponent=20"),
        ("d-eon", "tilt=-0.05"),
    ] {
        let cases = many_cases(model, 32);
        assert_wrong(set, &with_samples(&cases, 1000, 1, &[set]), &samples);
    }
}

/// Far field of RTXCR, which states the value without absorption as its density, and draws without the tilt and with other azimuths of TRT.
#[test]
fn faults_of_rtxcr_are_told_apart() {
    let cases = many_cases("d-eon", 320);
    let mut uniform = Uniform(1);
    let mut scene = Value::Null;
    let mut answers = Vec::new();
    for (case, line) in cases.iter().zip(answered(&cases, |_, _| ()).lines()) {
        let mut line: Value = serde_json::from_str(line).unwrap();
        let number = |name: &str| case["params"][name].as_f64().unwrap();
        let parameters = DEonDesc {
            roughness: number("roughness"),
            tilt: number("tilt"),
            eta: number("eta"),
            sigma_a: three(&case["params"]["sigma_a"]),
            diffuse: number("diffuse"),
            diffuse_color: three(&case["params"]["diffuse_color"]),
        };
        let point = RtxcrReference::prepare(&parameters, RtxcrFaults::SHIPPED, three(&case["wo"]));
        let (value, pdf) = point.eval_pdf(three(&case["wi"]));
        (line["value"], line["pdf"]) = (json!(value), json!(pdf));
        line.as_object_mut().unwrap().remove("lobes");
        if case["scene"] != scene {
            scene = case["scene"].clone();
            let drawn = (0..1000).map(|_| point.draw(uniform.some()));
            line["samples"] = json!(drawn.collect::<Vec<_>>());
        }
        answers.push(line.to_string());
    }
    let wrong = ["value .. in shape", "pdf .. in shape", "samples .. WRONG"];
    assert_wrong("RTXCR", &answers.join("\n"), &wrong);
}

#[test]
fn albedos_are_judged_by_lobe() {
    for model in ["chiang", "gaussian", "cauchy", "kajiya-kay", "d-eon"] {
        let cases = cases(model);
        let with_albedo = |by: f64| {
            answered(&cases, |case, line| {
                line["albedo"] = case["expected"]["albedo"].clone();
                for (name, rgb) in line["albedo"].as_object_mut().unwrap() {
                    if name.as_str() != "r" {
                        multiply(rgb, by);
                    }
                }
            })
        };
        assert_wrong(model, &with_albedo(1.0), &[]);
        let lines = verdicts(&with_albedo(1.1));
        let wrong = lines.iter().filter(|line| line.contains("WRONG"));
        let named = |line: &String| line.starts_with("albedo ") && line.contains("factor 1.1000");
        assert!(
            wrong.clone().count() > 0 && wrong.clone().all(named),
            "{lines:?}"
        );
    }
}
