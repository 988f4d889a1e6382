//! Tests of `hairis claims`: its file, its seed and its threads.

use super::{Run, command};
use core::time::Duration;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::OnceLock;
use std::thread;
use std::time::Instant;
use tempfile::TempDir;

fn tiny(dir: &Path, threads: &str, seed: &str) -> Command {
    let out = dir.to_str().unwrap();
    let mut command = command(&["claims", "--tiny", "--seed", seed, "--out", out]);
    command
        .env("RAYON_NUM_THREADS", threads)
        .stdin(Stdio::null());
    command
}

fn claims(dir: &Path, threads: &str, seed: &str) -> Run {
    tiny(dir, threads, seed).output().unwrap().into()
}

/// Returns `claims.json` of a run, without the claim that depends on times.
fn untimed(threads: &str, seed: &str) -> Value {
    untimed_in(&TempDir::new().unwrap(), threads, seed)
}

fn untimed_in(dir: &TempDir, threads: &str, seed: &str) -> Value {
    let run = claims(dir.path(), threads, seed);
    assert_eq!(run.code, Some(0), "{:?}", run.err);
    assert_eq!(
        fs::read_dir(dir.path()).unwrap().count(),
        1,
        "one file is left"
    );
    let mut json: Value =
        serde_json::from_slice(&fs::read(dir.path().join("claims.json")).unwrap()).unwrap();
    let all = json["claims"].as_array_mut().unwrap();
    let before = all.len();
    all.retain(|claim| claim["figures"][0]["origin"] != "timed");
    assert_eq!(all.len(), before - 1, "one claim is timed");
    json
}

/// Returns the run of seed 1 on one thread.
fn reference() -> &'static Value {
    static CLAIMS: OnceLock<Value> = OnceLock::new();
    CLAIMS.get_or_init(|| untimed("1", "1"))
}

/// A run that a signal has ended continues from the figures that it had, of quadrature and of samples. It has two threads, and the
/// reference one.
#[cfg(unix)]
#[test]
fn a_killed_run_goes_on() {
    let dir = TempDir::new().unwrap();
    let lines = || {
        let mut files = fs::read_dir(dir.path()).unwrap();
        let text = files.find_map(|file| {
            let path = file.unwrap().path();
            let is_part = path.extension().is_some_and(|end| end == "part");
            is_part.then(|| fs::read_to_string(path).unwrap_or_default())
        });
        text.unwrap_or_default().lines().count()
    };
    for (least, signal, code) in [(3, "TERM", Some(143)), (12, "KILL", None)] {
        let child = tiny(dir.path(), "2", "1").spawn().unwrap();
        let start = Instant::now();
        while lines() < least && start.elapsed() < Duration::from_secs(120) {
            thread::sleep(Duration::from_millis(1));
        }
        let run = Run::end(child, signal).unwrap();
        assert_eq!(run.code, code, "{:?}", run.err);
        assert!(!dir.path().join("claims.json").exists(), "killed too late");
        if code.is_some() {
            let last = run.err.last().unwrap();
            assert!(
                last.contains("interrupted by SIGTERM: the figures so far are in ")
                    && last.contains("claims-"),
                "{last}"
            );
        }
    }
    assert_eq!(&untimed_in(&dir, "2", "1"), reference());
}

#[test]
fn the_file_is_complete_and_depends_on_the_seed() {
    let one = reference();
    let other = untimed("2", "2");
    assert_ne!(one["claims"], other["claims"], "another seed");
    assert_eq!(
        (&one["settings"]["seed"], &one["settings"]["quick"]),
        (&1.into(), &true.into())
    );
    assert!(one["machine"]["cpu"].is_string(), "{}", one["machine"]);
    for claim in one["claims"].as_array().unwrap() {
        for key in ["id", "quotation", "source", "verdict", "sentence"] {
            assert!(
                claim[key].as_str().is_some_and(|text| !text.is_empty()),
                "{key} of {claim}"
            );
        }
        assert!(
            ["holds", "holds within limits", "false"].contains(&claim["verdict"].as_str().unwrap()),
            "{claim}"
        );
        assert!(
            claim["threshold"]["bound"].is_number() && claim["threshold"]["limits"].is_string(),
            "{claim}"
        );
        for figure in claim["figures"].as_array().unwrap() {
            assert!(
                figure["value"].is_number() && figure["error"].is_number(),
                "{figure}"
            );
            assert!(
                figure["unit"].is_string() && figure["role"].is_string(),
                "{figure}"
            );
        }
    }
}

#[test]
#[cfg(unix)]
fn a_full_disk_leaves_the_file_as_it_was() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("claims.json");
    fs::write(&path, "before").unwrap();
    // No file may grow beyond a kilobyte or two. The signal for that is ignored, as in any program that checks its writes.
    let script = "trap '' XFSZ; ulimit -f 2; exec \"$0\" claims --tiny --out \"$1\"";
    let output = Command::new("sh")
        .args([
            "-c",
            script,
            env!("CARGO_BIN_EXE_hairis-study"),
            dir.path().to_str().unwrap(),
        ])
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(
        error.starts_with("hairis: cannot write") && error.contains(".part: File too large"),
        "{error}"
    );
    assert_eq!(fs::read_to_string(&path).unwrap(), "before");
    assert_eq!(
        fs::read_dir(dir.path()).unwrap().count(),
        2,
        "the figures so far are left, and nothing else"
    );
}

#[test]
fn a_folder_that_cannot_be_written_is_refused() {
    let dir = TempDir::new().unwrap();
    fs::write(dir.path().join("file"), "").unwrap();
    fs::create_dir(dir.path().join("claims.json")).unwrap();
    for out in [dir.path().join("file/out"), dir.path().to_owned()] {
        let run = claims(&out, "1", "1");
        assert_eq!(
            (run.code, run.out.len(), run.err.len()),
            (Some(2), 0, 1),
            "{:?}",
            run.err
        );
        assert!(
            run.err[0].starts_with("hairis: cannot write"),
            "{:?}",
            run.err
        );
    }
}
