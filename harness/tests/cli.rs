//! Tests of the binary `hairis`, which is run as scripts run it.

mod agreement;
mod claims;
mod exact;
mod refusals;
mod shader;
mod streams;
mod study;

use crate::cases::Case;
use serde_json::{Value, json};
use std::fs;
use std::io::Write;
use std::path::Path;
#[cfg(unix)]
use std::process::Child;
use std::process::{Command, Output, Stdio};
use std::thread;

const PATHS: [&str; 4] = ["scalar", "x8", "batch", "f64"];

/// Result of a run of the binary.
struct Run {
    code: Option<i32>,
    out: Vec<String>,
    err: Vec<String>,
}

impl Run {
    fn json(&self) -> Vec<Value> {
        self.out
            .iter()
            .map(|line| serde_json::from_str(line).unwrap())
            .collect()
    }
}

fn command(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hairis"));
    command
        .args(args)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

/// Sends a signal to a process, and waits for the process to end.
#[cfg(unix)]
fn end(child: Child, signal: &str) -> Run {
    let sent = Command::new("kill")
        .args([format!("-{signal}"), child.id().to_string()])
        .status();
    assert!(sent.unwrap().success(), "it runs");
    child.wait_with_output().unwrap().into()
}

fn run(args: &[&str], input: &[u8]) -> Run {
    let mut child = command(args).spawn().unwrap();
    let (mut stdin, input) = (child.stdin.take().unwrap(), input.to_vec());
    // A run that rejects its flags reads nothing.
    let writer = thread::spawn(move || drop(stdin.write_all(&input)));
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    output.into()
}

impl From<Output> for Run {
    fn from(output: Output) -> Self {
        let lines = |bytes: Vec<u8>| {
            String::from_utf8(bytes)
                .unwrap()
                .lines()
                .map(str::to_owned)
                .collect()
        };
        Self {
            code: output.status.code(),
            out: lines(output.stdout),
            err: lines(output.stderr),
        }
    }
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

/// Returns the names of the files in a folder, sorted.
fn names(dir: &Path) -> Vec<String> {
    let entries = fs::read_dir(dir).unwrap();
    let mut names: Vec<_> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .unwrap()
        .iter()
        .map(|x| x.as_f64().unwrap())
        .collect()
}
