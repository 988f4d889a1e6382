//! The program as from a shell: exit codes, and refusals in one line.

use super::{answered, cases, multiply};
use hairis_program::trial::{self, Run};

fn run(args: &[&str], input: &str) -> Run {
    let mut command = trial::command(env!("CARGO_BIN_EXE_hairis-referee"), args);
    Run::of(&mut command, input.as_bytes()).unwrap()
}

#[test]
fn exit_codes_tell_right_from_wrong() {
    let cases = cases("chiang");
    let right = run(&["check", "-"], &answered(&cases, |_, _| ()));
    assert_eq!((right.code, right.err.len()), (Some(0), 0), "{right:?}");
    let wrong = answered(&cases, |_, line| multiply(&mut line["pdf"], 2.0));
    let wrong = run(&["check", "-"], &wrong);
    assert_eq!((wrong.code, wrong.err.len()), (Some(1), 1), "{wrong:?}");
    assert!(
        wrong
            .out
            .iter()
            .any(|line| line.contains("factor 2 (2.00000)")),
        "{wrong:?}"
    );
}

#[test]
fn tables_have_a_name_for_each_column() {
    for model in ["chiang", "gaussian", "cauchy", "kajiya-kay", "d-eon"] {
        let flags = [
            "vectors",
            "--model",
            model,
            "--scenes",
            "9",
            "--directions",
            "3",
            "--csv",
        ];
        let run = run(&flags, "");
        assert_eq!((run.code, run.out.len()), (Some(0), 28), "{run:?}");
        let columns: Vec<_> = run.out.iter().map(|row| row.split(',').count()).collect();
        assert!(
            columns.iter().all(|count| *count == columns[0]),
            "{model}: {columns:?}"
        );
        assert!(run.out[0].contains("expected.pdf") && run.out[0].contains("wo[2]"));
    }
}

#[test]
fn bad_input_is_refused_by_field_and_value() {
    let [case, ..] = &cases("chiang")[..] else {
        panic!("cases")
    };
    let changed = |name: &str, value: &str| {
        let mut line = case.clone();
        line["pdf"] = case["expected"]["pdf"].clone();
        line[name] = serde_json::from_str(value).unwrap();
        line.to_string()
    };
    for (input, words) in [
        (String::new(), "must have a case, got nothing"),
        (
            case.to_string(),
            "line 1: value: missing; give value, pdf, lobes or albedo",
        ),
        (
            changed("wi", "[1, 1, 0]"),
            "line 1: wi: must be a unit vector",
        ),
        (changed("h", "2"), "line 1: h: must be in [-1, 1], got 2"),
        (
            changed("lobes", r#"{"ttt": [1, 1, 1]}"#),
            "line 1: lobes.ttt",
        ),
        (changed("pdf", "null"), "line 1: pdf"),
        (
            changed("albedo", r#"{"r": 1}"#),
            "line 1: albedo.r: must be an array of 3",
        ),
        (
            changed("samples", "1"),
            "line 1: samples: must be an array, got 1",
        ),
        (
            changed("samples", "[null, [1, 0, 0], [0, 2, 0]]"),
            "line 1: samples[2]: must be a unit vector",
        ),
        (
            changed("drawn_with", "0"),
            "line 1: drawn_with: must be above 0, got 0",
        ),
        (
            format!("{}\n{{}}", changed("pdf", "1")),
            "line 2: model: missing",
        ),
    ] {
        let run = run(&["check", "-"], &input);
        assert_eq!(
            (run.code, run.out.len(), run.err.len()),
            (Some(2), 0, 1),
            "{run:?}"
        );
        assert!(run.err[0].contains(words), "{words}: {run:?}");
    }
    for (flags, words) in [
        (["vectors", "--model", "chang"], "--model must be one of"),
        (
            ["check", "nowhere.json", "--tolerance=1e-3"],
            "nowhere.json",
        ),
        (
            ["check", "-", "--tolerance=2"],
            "must be a number from 1e-12 to 0.1",
        ),
    ] {
        let run = run(&flags, "");
        assert_eq!((run.code, run.err.len()), (Some(2), 1), "{run:?}");
        assert!(run.err[0].contains(words), "{words}: {run:?}");
    }
}
