//! Files that a study reads beside its parts, which are environments and claims; and a standard output that nobody reads.

use super::{CELLS, Run, assert_refused, lend, merge, reference};
use crate::cli::{command, run};
use exr::prelude::write_rgb_file;
use hairis_study::study::output::Study;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use tempfile::TempDir;

/// Writes an `OpenEXR` map of one colour.
fn map(dir: &Path, [width, height]: [usize; 2], pixel: [f32; 3]) -> PathBuf {
    let path = dir.join("map.exr");
    write_rgb_file(&path, width, height, |_, _| pixel.into()).unwrap();
    path
}

#[test]
fn maps_without_light_are_refused() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("out");
    for (pixel, words) in [
        (
            [0.0; 3],
            "map.exr: the map gives no light; pass another file",
        ),
        (
            [f32::NAN; 3],
            "map.exr: the map gives no light: 24 NaN and 0 negative channels count as 0; pass another file",
        ),
    ] {
        let path = map(dir.path(), [4, 2], pixel);
        let args = [
            "study",
            "--quick",
            "--out",
            out.to_str().unwrap(),
            "--env",
            path.to_str().unwrap(),
        ];
        assert_refused(&run(&args, b""), words);
    }
    assert!(!out.exists(), "nothing was written");
}

#[test]
fn a_layer_that_is_not_there_is_refused() {
    let dir = TempDir::new().unwrap();
    let path = map(dir.path(), [4, 2], [1.0; 3]);
    let words = "map.exr: --layer must be a layer with colour of the file, got beauty; it has one without a name (R G B)";
    let mut args = vec!["study", "--quick", "--env", path.to_str().unwrap()];
    args.extend(["--layer", "beauty"]);
    assert_refused(&run(&args, b""), words);
}

/// Computes one cell in a folder of any name. Merging this part alone is rejected in one line.
#[cfg(unix)]
#[test]
fn any_path_works() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt as _;
    for name in ["日本".as_bytes(), b"\xff\xfe", b"a 'b'\n\"c\""] {
        let dir = TempDir::new().unwrap();
        let inside = dir.path().join(OsStr::from_bytes(name));
        fs::create_dir(&inside).unwrap();
        let sky = map(&inside, [4, 2], [1.0; 3]);
        let call = |args: &[&OsStr]| {
            let output = command(&[]).args(args).stdin(Stdio::null()).output();
            Run::from(output.unwrap())
        };
        let [study, merge, tiny, out, env, shard, first] = [
            "study", "merge", "--tiny", "--out", "--env", "--shard", "1/12",
        ]
        .map(OsStr::new);
        let (here, sky) = (inside.as_os_str(), sky.as_os_str());
        let run = call(&[study, tiny, shard, first, out, here, env, sky]);
        assert_eq!(run.code, Some(0), "{name:?}: {:?}", run.err);
        let lines = run.err.len();
        assert!(inside.join("cells-1-of-12.jsonl").exists(), "{name:?}");
        // A resumed run prints as many lines.
        assert_eq!(
            call(&[study, tiny, shard, first, out, here, env, sky])
                .err
                .len(),
            lines
        );
        let joined = inside.join("joined");
        let run = call(&[merge, joined.as_os_str(), here]);
        assert_eq!((run.code, run.err.len()), (Some(2), 1), "{:?}", run.err);
    }
}

#[test]
fn a_stretched_map_is_reported() {
    let dir = TempDir::new().unwrap();
    let path = map(dir.path(), [4, 4], [1.0; 3]);
    // The folder cannot be made, so that the run ends before its work begins.
    let out = path.join("out");
    let run = run(
        &[
            "study",
            "--quick",
            "--out",
            out.to_str().unwrap(),
            "--env",
            path.to_str().unwrap(),
        ],
        b"",
    );
    assert_eq!((run.code, run.err.len()), (Some(2), 2), "{:?}", run.err);
    assert!(
        run.err[0].contains("4 x 4 is not 2:1; it is stretched"),
        "{:?}",
        run.err
    );
}

/// Returns a `claims.json` that belongs to the reference.
fn claims() -> Value {
    let header = hairis_study::study::part::read(&reference().join(super::WHOLE))
        .unwrap()
        .header;
    json!({
        "settings": { "seed": 1, "quick": true, "cells": CELLS, "samples": header.samples },
        "machine": { "commit": "abc" },
        "claims": [{ "quotation": "always", "source": "5", "verdict": "false", "sentence": "not here" }],
    })
}

#[test]
fn claims_of_another_run_stay_out_of_the_report() {
    let with = |field: &str, value: Value| {
        let mut claims = claims();
        claims["settings"][field] = value;
        claims.to_string()
    };
    let study = Study::read(&[reference().to_owned()]).unwrap();
    for (text, problem) in [
        (
            with("quick", json!(false)),
            "it belongs to a run with quick false, expected true",
        ),
        (
            with("cells", json!(3024)),
            "it belongs to a run with cells 3024, expected 12",
        ),
        ("{\"claims\":[{\"quo".to_owned(), "it is damaged"),
        ("{\"claims\":7}".to_owned(), "it is damaged"),
    ] {
        assert_eq!(
            study.claims(text.as_bytes()),
            Err(problem.to_owned()),
            "{text}"
        );
    }
    for (text, problem) in [
        (claims().to_string(), None),
        (
            with("seed", json!(2)),
            Some("it belongs to a run with seed 2, expected 1"),
        ),
    ] {
        let dir = TempDir::new().unwrap();
        fs::write(dir.path().join("claims.json"), &text).unwrap();
        lend(reference(), dir.path());
        let run = merge(dir.path(), &[reference()]);
        assert_eq!(run.code, Some(0), "{text}: {:?}", run.err);
        let page = fs::read_to_string(dir.path().join("report.html")).unwrap();
        assert_eq!(
            page.contains("The paper's claims") || page.contains("The paper&#39;s claims"),
            problem.is_none(),
            "{text}"
        );
        let said = run
            .err
            .iter()
            .find(|line| line.contains("claims.json: left out of the report"));
        assert_eq!(said.is_some(), problem.is_some(), "{text}: {:?}", run.err);
        assert!(
            problem.is_none_or(|problem| said.is_some_and(|said| said.contains(problem))),
            "{text}: {said:?}"
        );
    }
}

#[test]
fn a_reader_that_leaves_is_told_where_the_tables_are() {
    let dir = TempDir::new().unwrap();
    lend(reference(), dir.path());
    let args = [
        "merge",
        "--tables",
        dir.path().to_str().unwrap(),
        reference().to_str().unwrap(),
    ];
    let mut child = command(&args).stdin(Stdio::null()).spawn().unwrap();
    drop(child.stdout.take());
    let run: Run = child.wait_with_output().unwrap().into();
    assert_eq!(run.code, Some(0), "{:?}", run.err);
    let words = format!(
        "standard output was closed; the tables are in {}",
        dir.path().join("report.html").display()
    );
    let told = |line: &String| line.starts_with(&words);
    assert!(run.err.iter().any(told), "{:?}", run.err);
}
