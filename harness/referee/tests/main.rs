//! Tests of `hairis-referee`: verdicts on implementations with known faults, on the kernels, and the program itself.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod cli;
mod faults;
mod samples;

use hairis_referee::answers::Answers;
use hairis_referee::args::Vectors;
use hairis_referee::vectors;
use hairis_referee::verdict::{Line, judge};
use serde_json::{Value, json};

/// Returns cases of a model: enough for factors, and few for integrals.
fn cases(model: &str) -> Vec<Value> {
    many_cases(model, 80)
}

/// Returns cases of a model, with so many directions at each shading point.
fn many_cases(model: &str, directions: u32) -> Vec<Value> {
    let flags = Vectors {
        model: model.to_owned(),
        sampler: None,
        scenes: 12,
        directions,
        seed: 1,
        csv: false,
    };
    let text = vectors::text(&flags).unwrap();
    let parse = |line| serde_json::from_str(line).unwrap();
    text.lines().map(parse).collect()
}

/// Returns the answers of a program that changes the right ones.
fn answered(cases: &[Value], change: impl Fn(&Value, &mut Value)) -> String {
    let answer = |case: &Value| {
        let mut line = case.clone();
        for name in ["value", "pdf", "lobes"] {
            line[name] = case["expected"][name].clone();
        }
        change(case, &mut line);
        line.to_string()
    };
    cases.iter().map(answer).collect::<Vec<_>>().join("\n")
}

/// Returns the verdicts on answers, as text.
fn verdicts(answers: &str) -> Vec<String> {
    let answers = Answers::parse(answers).unwrap();
    judge(&answers, 1e-3).iter().map(Line::to_string).collect()
}

/// Multiplies a number, or each number of an array.
fn multiply(value: &mut Value, by: f64) {
    if let Value::Array(items) = value {
        items.iter_mut().for_each(|item| multiply(item, by));
    } else {
        *value = json!(value.as_f64().unwrap() * by);
    }
}

/// Multiplies a lobe of an answer, and makes the value the sum of the lobes again.
fn multiply_lobe(line: &mut Value, lobe: &str, by: f64) {
    multiply(&mut line["lobes"][lobe], by);
    let sum = |c: usize| -> f64 {
        let lobes = line["lobes"].as_object().unwrap();
        lobes.values().map(|rgb| rgb[c].as_f64().unwrap()).sum()
    };
    line["value"] = json!([0, 1, 2].map(sum));
}
