//! Tests of the binary `hairis`, which is run as scripts run it.

mod agreement;
mod exact;
mod maps;
mod other;
mod refusals;
mod streams;

use crate::cases::Case;
use hairis_program::trial::{self, Run, names};
use serde_json::{Value, json};
use std::process::Command;

const PATHS: [&str; 4] = ["scalar", "x8", "batch", "f64"];

fn command(args: &[&str]) -> Command {
    trial::command(env!("CARGO_BIN_EXE_hairis"), args)
}

fn run(args: &[&str], input: &[u8]) -> Run {
    Run::of(&mut command(args), input).unwrap()
}

fn eval(path: &str, requests: &[Value]) -> Run {
    let lines: Vec<String> = requests.iter().map(Value::to_string).collect();
    run(&["eval", "--path", path], lines.join("\n").as_bytes())
}

/// Returns a request that is answered.
fn good() -> Value {
    json!({
        "model": "gaussian",
        "params": {
            "alpha": [-0.13, 0.065, 0.2], "beta": [0.13, 0.065, 0.26], "gamma_tt": 0.17, "gamma_g": 0.17, "phi_g": 0.61,
            "i_r": [0.3, 0.3, 0.3], "i_tt": [0.8, 0.6, 0.4], "i_trt": [0.7, 0.5, 0.3], "i_g": 0.5
        },
        "wo": [0.6, 0.8, 0.0],
        "wi": [0.0, 1.0, 0.0]
    })
}

/// Returns the request of a case, with every number written as it is in single precision.
fn request(model: &str, case: &Case) -> Value {
    let d = &case.desc;
    let three = |x: [f32; 3]| x.map(f64::from);
    json!({
        "model": model,
        "params": {
            "alpha": three(d.alpha), "beta": three(d.beta),
            "gamma_tt": f64::from(d.gamma_tt), "gamma_g": f64::from(d.gamma_g), "phi_g": f64::from(d.phi_g),
            "i_r": three(d.i_r), "i_tt": three(d.i_tt), "i_trt": three(d.i_trt),
            "i_g": f64::from(d.i_g)
        },
        "wo": three(case.wo.into()),
        "wi": three(case.wi.into())
    })
}

/// Returns a request for the sample of `xi` in place of the value at wi.
fn with_xi(mut request: Value, xi: [f64; 3]) -> Value {
    request.as_object_mut().unwrap().remove("wi");
    request["xi"] = json!(xi);
    request
}

fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .unwrap()
        .iter()
        .map(|x| x.as_f64().unwrap())
        .collect()
}
