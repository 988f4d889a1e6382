//! Rejection of bad input, line by line, and the messages that name the field at fault.

use super::{PATHS, eval, good, names, run};
use clap::CommandFactory as _;
use core::f64::consts::{FRAC_PI_2, PI};
use hairis_harness::args::Args;
use hairis_variants::ModelId;
use serde_json::{Value, json};
use std::fs;

/// Returns a good request with the field at a JSON pointer replaced.
fn with(pointer: &str, value: Value) -> Value {
    let mut request = good();
    *request.pointer_mut(pointer).unwrap() = value;
    request
}

/// Returns a good request with a field added to the object at a JSON pointer.
fn and(pointer: &str, name: &str, value: Value) -> Value {
    let mut request = good();
    request.pointer_mut(pointer).unwrap()[name] = value;
    request
}

/// Returns a good request without a field of the object at a JSON pointer.
fn without(pointer: &str, name: &str) -> Value {
    let mut request = good();
    request
        .pointer_mut(pointer)
        .unwrap()
        .as_object_mut()
        .unwrap()
        .remove(name);
    request
}

fn bad_values<'a>() -> Vec<(Value, &'a str)> {
    vec![
        (without("", "model"), "model: missing"),
        (with("/model", json!(3)), "model: must be a string, got 3"),
        (
            and("", "sampler", json!("uniform")),
            "sampler: must be \"published\" or ",
        ),
        (
            and("", "sampler", json!("best")),
            "sampler: must be \"published\" or \"matched\"",
        ),
        (without("", "params"), "params: missing"),
        (
            with("/params", json!([])),
            "params: must be an object, got an array of 0",
        ),
        (without("/params", "gamma_tt"), "params.gamma_tt: missing"),
        (
            and("/params", "gama_tt", json!(1)),
            "params.gama_tt: unknown field, expected one of alpha",
        ),
        (
            and("", "w_i", json!(1)),
            "w_i: unknown field, expected one of model",
        ),
        (
            with("/params/beta/1", json!(0)),
            "params.beta[1]: must be a width in [1e-4, pi] rad, got 0",
        ),
        (
            with("/params/beta/0", json!(9.9e-5)),
            "params.beta[0]: must be a width",
        ),
        (
            with("/params/gamma_g", json!(PI + 1e-5)),
            "params.gamma_g: must be a width",
        ),
        (
            with("/params/gamma_tt", json!(-1)),
            "params.gamma_tt: must be a width",
        ),
        (
            with("/params/alpha/2", json!(1.6)),
            "params.alpha[2]: must be an angle in [-pi/2, pi/2] rad, got 1.6",
        ),
        (
            with("/params/phi_g", json!(-0.1)),
            "params.phi_g: must be an angle in [0, pi] rad, got -0.1",
        ),
        (
            with("/params/i_r/2", json!(-1)),
            "params.i_r[2]: must be finite and at least 0, got -1",
        ),
        (
            with("/params/i_tt/0", json!(1e300)),
            "params.i_tt[0]: too large for single precision, got 1e300",
        ),
        (
            with("/params/i_g", json!(-0.5)),
            "params.i_g: must be finite and at least 0, got -0.5",
        ),
        (
            with("/params/i_trt", json!([1, 2])),
            "params.i_trt: must have 3 numbers, got 2",
        ),
        (
            with("/params/i_trt", json!(1)),
            "params.i_trt: must be an array of 3 numbers, got 1",
        ),
        (
            with("/params/alpha/0", json!("x")),
            "params.alpha[0]: must be a number, got \"x\"",
        ),
        (
            with("/params/alpha/0", Value::Null),
            "params.alpha[0]: must be a number, got null",
        ),
        (without("", "wo"), "wo: missing"),
        (
            with("/wo", json!([0, 0, 0])),
            "wo: must be a unit vector (to 0.001), got length 0",
        ),
        (
            with("/wi", json!([0.0, 0.998, 0.0])),
            "wi: must be a unit vector (to 0.001), got length 0.998",
        ),
        (
            with("/wi", json!([1e200, 1e200, 0.0])),
            "wi: must be a unit vector",
        ),
        (
            with("/wi", json!([0, 1, 0, 0])),
            "wi: must have 3 numbers, got 4",
        ),
        (without("", "wi"), "wi: missing; give wi or xi"),
        (
            and("", "xi", json!([0, 0, 0])),
            "wi: given together with xi",
        ),
        (
            super::with_xi(good(), [0.0, 1.0, 0.0]),
            "xi[1]: must be in [0, 1), got 1",
        ),
        (
            super::with_xi(good(), [0.0, 0.0, -1e-9]),
            "xi[2]: must be in [0, 1), got -0.000000001",
        ),
    ]
}

#[test]
fn each_bad_value_is_refused_by_name_and_the_rest_still_runs() {
    let models: Vec<_> = ModelId::defaults_of_names()
        .map(|id| format!("{:?}", id.name()))
        .collect();
    let unknown = format!("model: must be {}, got \"phong\"", models.join(" or "));
    let mut bad = bad_values();
    bad.push((with("/model", json!("phong")), &unknown));
    let requests: Vec<Value> = bad
        .iter()
        .flat_map(|(request, _)| [good(), request.clone()])
        .collect();
    for path in PATHS {
        let run = eval(path, &requests);
        assert_eq!(run.code, Some(2), "{path}: bad input");
        assert_eq!(
            run.err,
            [format!(
                "hairis: {} of {} lines were refused",
                bad.len(),
                requests.len()
            )],
            "{path}"
        );
        assert_eq!(
            run.out.len(),
            requests.len(),
            "{path}: one line out for each line in"
        );
        for (answers, (request, problem)) in run.json().chunks(2).zip(&bad) {
            assert!(
                answers[0].get("s").is_some(),
                "{path}: the line before {problem:?} got {}",
                answers[0]
            );
            let error = answers[1]["error"].as_str().unwrap_or_default();
            assert!(
                error.starts_with(problem),
                "{path}: {request} got {error:?}, not {problem:?}"
            );
        }
    }
}

#[test]
fn an_offset_beyond_the_fibre_is_refused() {
    let line = |h: &str| {
        format!(
            r#"{{"model":"chiang","params":{{"beta_m":0.3,"beta_n":0.3,"melanin_amount":[0.5,0]}},"h":{h},"wo":[0,1,0],"wi":[0,0,1]}}"#
        )
    };
    for path in PATHS {
        for h in ["-1", "1", "1.0", "-0.0"] {
            let run = run(&["eval", "--path", path], line(h).as_bytes());
            assert_eq!(run.code, Some(0), "{path}, h {h}: {:?}", run.out);
        }
        for h in ["1.5", "-1.0000001", "1e300"] {
            let run = run(&["eval", "--path", path], line(h).as_bytes());
            let error = run.json()[0]["error"]
                .as_str()
                .unwrap_or_default()
                .to_owned();
            let start = "h: must be in [-1, 1], got ";
            assert!(
                run.code == Some(2) && error.starts_with(start),
                "{path}, h {h}: {error}"
            );
        }
    }
}

#[test]
fn amounts_of_melanin_have_ranges() {
    let refused = |melanin: &str| {
        let line = format!(
            r#"{{"model":"chiang","params":{{"beta_m":0.3,"beta_n":0.3,{melanin}}},"wo":[0,1,0],"wi":[0,0,1]}}"#
        );
        let run = run(&["eval"], line.as_bytes());
        run.json()[0]["error"].as_str().unwrap().to_owned()
    };
    for (melanin, problem) in [
        (
            r#""melanin_amount":[1.5,0]"#,
            "params.melanin_amount[0]: must be in [0, 1], got 1.5",
        ),
        (
            r#""melanin_amount":[0.5,-1]"#,
            "params.melanin_amount[1]: must be in [0, 1], got -1",
        ),
        (
            r#""melanin_amount":0.5"#,
            "params.melanin_amount: must be an array of 2 numbers, got 0.5",
        ),
        (
            r#""melanin_amount":[0.5,0],"color":[1,1,1]"#,
            "params.melanin_amount: given together with color; give one of them",
        ),
    ] {
        assert_eq!(refused(melanin), problem);
    }
}

#[test]
fn each_bad_line_is_refused_and_the_rest_still_runs() {
    let text = good().to_string();
    let long = vec![b' '; (1 << 20) + 1];
    let lines: [(&[u8], &str); 11] = [
        (b"", "line: blank"),
        (b" \t\r", "line: blank"),
        (b"{\"model\": \"\xff\"}", "line: not UTF-8 after byte 11"),
        (b"{\"model\": \"gaussian\"", "line: not JSON: EOF"),
        (b"[1, 2]", "line: must be an object, got an array of 2"),
        (b"{\"wo\": [0, NaN, 0]}", "wo[1]: expected value (column"),
        (
            b"{\"params\": {\"beta\": [0.1, 1e400",
            "params.beta[1]: number out of range (column",
        ),
        (b"{\"params\": {\"beta\": [0.1, 0.", "params.beta[1]: EOF"),
        (b"{\"wo\": [0, 1, 0], \"wo\": [0, 1, 0]}", "wo: given twice"),
        (b"{} {}", "line: not JSON: trailing characters"),
        (&long, "line: longer than 1048576 bytes"),
    ];
    let mut input = Vec::new();
    for (line, _) in &lines {
        input.extend_from_slice(line);
        input.extend_from_slice(format!("\n{text}\r\n").as_bytes());
    }
    let run = run(&["eval"], &input);
    assert_eq!(run.code, Some(2), "bad input");
    assert_eq!(
        run.out.len(),
        2 * lines.len(),
        "one line out for each line in"
    );
    for (answers, (_, problem)) in run.json().chunks(2).zip(&lines) {
        let error = answers[0]["error"].as_str().unwrap_or_default();
        assert!(error.starts_with(problem), "got {error:?}, not {problem:?}");
        assert!(
            answers[1].get("s").is_some(),
            "the line after {problem:?} got {}",
            answers[1]
        );
    }
}

#[test]
fn refusals_stay_short() {
    let long = "gamma".repeat(40);
    let deep = format!("{{\"{long}\":").repeat(20) + "x" + &"}".repeat(20);
    let known = and("/params", &long, json!(1)).to_string();
    let number = with("/params/alpha/0", json!(long)).to_string();
    for line in [&deep, &known, &number, &format!("{{\"model\":\"{long}\"}}")] {
        let run = run(&["eval"], line.as_bytes());
        let error = run.json()[0]["error"].as_str().unwrap().to_owned();
        assert!(
            (10..=330).contains(&error.chars().count()),
            "{} characters: {error}",
            error.chars().count()
        );
    }
}

#[test]
fn limits_written_in_double_precision_are_accepted() {
    let requests = [
        with("/params/beta", json!([PI, 1e-4, PI])),
        with("/params/alpha", json!([FRAC_PI_2, -FRAC_PI_2, FRAC_PI_2])),
        with("/params/phi_g", json!(PI)),
        with("/wi", json!([0.0, 1.0009, 0.0])),
        with("/wo", json!([0.9991, 0.0, 0.0])),
        super::with_xi(good(), [0.999_999_999_999, 0.0, 0.999_999_999_999]),
        and("", "sampler", json!("published")),
        and("", "sampler", json!("matched")),
    ];
    for path in PATHS {
        let run = eval(path, &requests);
        assert_eq!(
            (run.code, run.err.len()),
            (Some(0), 0),
            "{path}: {:?}",
            run.out
        );
    }
}

#[test]
fn bad_flags_are_refused_in_one_line() {
    let cases: [&[&str]; 4] = [
        &["eval", "--example", "soft"],
        &["evaluate"],
        &["eval", "--path", "gpu"],
        &["eval", "--paths", "x8"],
    ];
    for args in cases {
        let run = run(args, b"");
        assert_eq!(
            (run.code, run.out.len(), run.err.len()),
            (Some(2), 0, 1),
            "{args:?}: {:?}",
            run.err
        );
        assert!(
            run.err[0].starts_with("hairis: "),
            "{args:?}: {:?}",
            run.err
        );
    }
}

#[test]
fn the_name_that_was_meant_is_named() {
    for (args, meant) in [
        (&["compar"][..], "'compare'"),
        (&["compare", "--quik"], "'--quick'"),
        (&["eval", "--path", "scaler"], "'scalar'"),
    ] {
        let error = &run(args, b"").err[0];
        assert!(
            error.contains(meant) && error.contains("similar"),
            "{error}"
        );
    }
}

/// Without arguments, the program says what it can do, and what it proposes works.
#[test]
fn an_empty_command_line_is_answered() {
    let run = run(&[], b"");
    assert_eq!((run.code, run.err.len()), (Some(0), 0), "{:?}", run.err);
    assert!(run.out.len() <= 20, "{:?}", run.out);
    assert!(
        run.out.iter().all(|line| line.chars().count() <= 100),
        "{:?}",
        run.out
    );
    for command in Args::command().get_subcommands() {
        let name = command.get_name();
        assert!(
            run.out.iter().any(|line| line.contains(name)),
            "{name}: {:?}",
            run.out
        );
    }
}

#[test]
fn the_example_of_every_model_is_answered() {
    for model in ModelId::defaults_of_names() {
        let example = run(&["eval", "--example", model.name()], b"");
        assert_eq!(
            (example.code, example.out.len()),
            (Some(0), 1),
            "{:?}",
            example.err
        );
        for path in PATHS {
            let answer = run(&["eval", "--path", path], example.out[0].as_bytes());
            let pdf = answer.json()[0]["pdf"].as_f64();
            assert!(
                pdf.is_some_and(|pdf| pdf > 0.0),
                "{}: {:?}",
                model.name(),
                answer.out
            );
        }
    }
}

#[test]
fn reports_that_cannot_be_written_are_refused_before_any_work() {
    for name in ["figures", "report.html"] {
        let dir = tempfile::tempdir().unwrap();
        let taken = dir.path().join(name);
        if name == "figures" {
            fs::write(taken, "").unwrap();
        } else {
            fs::create_dir(taken).unwrap();
        }
        let out = ["--out", dir.path().to_str().unwrap()];
        let run = run(&[&["compare", "--quick"], &out[..]].concat(), b"");
        assert_eq!((run.code, run.err.len()), (Some(2), 1), "{:?}", run.err);
        assert!(
            run.err[0].contains("cannot write") && run.err[0].contains(name),
            "{:?}",
            run.err
        );
        let is_result = |name: &String| name.ends_with(".json");
        assert!(!names(dir.path()).iter().any(is_result), "{name}");
    }
}

#[test]
fn help_and_version_are_no_errors() {
    let cases: [&[&str]; 3] = [&["--help"], &["--version"], &["eval", "--help"]];
    for args in cases {
        let run = run(args, b"");
        assert_eq!(
            (run.code, run.err.len()),
            (Some(0), 0),
            "{args:?}: {:?}",
            run.err
        );
        assert!(!run.out.is_empty(), "{args:?} prints something");
    }
}
