//! Refusals of `hairis fit`.

use super::{names, run};
use std::fs;

#[test]
fn fixed_fields_that_the_start_lacks_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let flags = ["fit", "--from", "gaussian", "--to", "chiang"];
    let out = ["--out", dir.path().to_str().unwrap()];
    let instead = "fix sigma_a, which the start has in its place";
    for (more, words) in [
        (&["--fix", "melanin"][..], instead),
        (&["--fix", "eta", "--fix", "color"], instead),
        (&["--fix", "color", "--over", "presets"], instead),
        (&["--fix", "fur"], "--fix must be one of beta_m, "),
    ] {
        let run = run(&[&flags[..], more, &out].concat(), b"");
        assert_eq!((run.code, run.err.len()), (Some(2), 1), "{:?}", run.err);
        assert!(run.err[0].contains(words), "{more:?}: {:?}", run.err);
    }
    assert!(names(dir.path()).is_empty(), "nothing is written");
}

#[test]
fn reports_that_cannot_be_written_are_refused_before_any_work() {
    let fit: &[&str] = &["fit", "--from", "gaussian", "--to", "cauchy"];
    for name in ["figures", "report.html"] {
        let dir = tempfile::tempdir().unwrap();
        let taken = dir.path().join(name);
        if name == "figures" {
            fs::write(taken, "").unwrap();
        } else {
            fs::create_dir(taken).unwrap();
        }
        let out = ["--out", dir.path().to_str().unwrap()];
        let run = run(&[fit, &out].concat(), b"");
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
