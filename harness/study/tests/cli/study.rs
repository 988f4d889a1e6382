//! Tests of `hairis study` and `hairis merge`: runs that are stopped, resumed, split, joined and rejected.

mod files;
mod inputs;
mod refused;

use super::{Run, command};
use core::time::Duration;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::sync::OnceLock;
use std::thread;
use std::time::Instant;
use tempfile::TempDir;

/// Number of cells of the runs here, which ask for no figure. Those of files are of the short run.
const CELLS: usize = 12;
/// Name of the part file of a run that is not split.
const WHOLE: &str = "cells-1-of-1.jsonl";

/// Runs `hairis study --tiny` into `dir` on `threads` threads.
fn study(dir: &Path, threads: &str, more: &[&str]) -> Run {
    sized("--tiny", dir, threads, more)
}

/// Runs `hairis study` with the flag `size` into `dir` on `threads` threads.
fn sized(size: &str, dir: &Path, threads: &str, more: &[&str]) -> Run {
    let mut args = vec!["study", size, "--tables", "--out", dir.to_str().unwrap()];
    args.extend(more);
    command(&args)
        .env("RAYON_NUM_THREADS", threads)
        .stdin(Stdio::null())
        .output()
        .unwrap()
        .into()
}

fn merge(out: &Path, parts: &[&Path]) -> Run {
    let mut args = vec!["merge", "--tables", out.to_str().unwrap()];
    args.extend(parts.iter().map(|part| part.to_str().unwrap()));
    command(&args).stdin(Stdio::null()).output().unwrap().into()
}

/// Folder for the figures that a run has kept.
const FIGURES: &str = "kept";

/// Runs a study twice. At first a drawing, which is the last of its files, cannot be written. The figures of that run stay, and are copied
/// to the folder [`FIGURES`].
fn study_and_keep(dir: &Path, threads: &str, more: &[&str]) -> Run {
    let taken = dir.join("figures/study-01-summary.svg");
    fs::create_dir_all(&taken).unwrap();
    let refused = study(dir, threads, more);
    assert_eq!(refused.code, Some(2), "{:?}", refused.err);
    let last = refused.err.last().unwrap();
    assert!(last.contains("study-01-summary.svg"), "{last}");
    copy_figures(dir, &dir.join(FIGURES));
    fs::remove_dir(taken).unwrap();
    let run = study(dir, threads, more);
    let continues = |line: &String| line.contains("continues after") && line.contains("figures");
    assert!(run.err.iter().any(continues), "{:?}", run.err);
    run
}

/// Copies the figures that a run in `from` has kept, so that a run in `to` continues from them. Computing them takes most of a short run.
fn lend(from: &Path, to: &Path) {
    copy_figures(&from.join(FIGURES), to);
}

fn copy_figures(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for file in fs::read_dir(from).unwrap().map(Result::unwrap) {
        if file.path().extension().is_some_and(|end| end == "part") {
            fs::copy(file.path(), to.join(file.file_name())).unwrap();
        }
    }
}

/// Returns an empty folder in that of the build, because no destructor removes a static one, and its lock: one process at a time uses it.
fn shared_folder(name: &str) -> (File, PathBuf) {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let lock = File::create(dir.with_extension("lock")).unwrap();
    lock.lock().unwrap();
    drop(fs::remove_dir_all(&dir));
    (lock, dir)
}

/// Returns the folder of a finished run on one thread, made once.
fn reference() -> &'static Path {
    static DIR: OnceLock<(File, PathBuf)> = OnceLock::new();
    let (_, dir) = DIR.get_or_init(|| {
        let (lock, dir) = shared_folder("study");
        let run = study_and_keep(&dir, "1", &[]);
        assert_eq!(run.code, Some(0), "{:?}", run.err);
        assert!(
            run.out.iter().any(|line| line.contains("geometric mean")),
            "a summary: {:?}",
            run.out
        );
        (lock, dir)
    });
    dir
}

/// Files that depend only on the seed and the build.
const ROWS: &[&str] = if cfg!(feature = "parquet") {
    &[
        "study.csv",
        "study.parquet",
        "difference.csv",
        "refitted.csv",
    ]
} else {
    &["study.csv", "difference.csv", "refitted.csv"]
};

/// Checks that `dir` holds the rows of the reference, byte by byte.
fn assert_same_rows(dir: &Path, what: &str) {
    for name in ROWS {
        let (got, want) = (
            fs::read(dir.join(name)).unwrap(),
            fs::read(reference().join(name)).unwrap(),
        );
        assert!(!want.is_empty() && got == want, "{what}: {name} differs");
    }
}

fn assert_refused(run: &Run, words: &str) {
    assert_eq!(
        (run.code, run.out.len(), run.err.len()),
        (Some(2), 0, 1),
        "{words}: {:?}",
        run.err
    );
    assert!(
        run.err[0].starts_with("hairis: ") && run.err[0].contains(words),
        "{words}: {:?}",
        run.err
    );
}

#[test]
fn rows_do_not_depend_on_the_number_of_threads_or_on_stops() {
    let part = fs::read(reference().join(WHOLE)).unwrap();
    let ends: Vec<usize> = (0..part.len()).filter(|i| part[*i] == b'\n').collect();
    assert_eq!(ends.len(), CELLS + 1, "a line a cell, and one above");
    let dir = TempDir::new().unwrap();
    // Cuts before the end of the first line, so that all cells run; before the end of a cell's line; after another's; and nowhere.
    for cut in [ends[0], ends[5] - 300, ends[8] + 1, part.len()] {
        fs::write(dir.path().join(WHOLE), &part[..cut]).unwrap();
        lend(reference(), dir.path());
        let run = study(dir.path(), "2", &[]);
        assert_eq!(run.code, Some(0), "cut at {cut}: {:?}", run.err);
        assert_same_rows(dir.path(), &format!("cut at {cut}"));
        let whole = ends.iter().filter(|end| **end < cut).count();
        let kept = fs::read(dir.path().join(WHOLE)).unwrap();
        if whole > 1 {
            assert!(
                kept.starts_with(&part[..=ends[whole - 1]]),
                "cut at {cut}: finished cells are kept"
            );
        }
        assert_eq!(
            kept.iter().filter(|byte| **byte == b'\n').count(),
            CELLS + 1,
            "cut at {cut}: each cell once"
        );
    }
}

#[cfg(unix)]
#[test]
fn a_killed_run_goes_on() {
    let dir = TempDir::new().unwrap();
    let part = dir.path().join(WHOLE);
    let lines = || {
        fs::read(&part)
            .unwrap_or_default()
            .iter()
            .filter(|byte| **byte == b'\n')
            .count()
    };
    // SIGKILL, which no process can handle, and signals that request an end.
    for (least, signal, code) in [
        (2, "KILL", None),
        (3, "TERM", Some(143)),
        (5, "INT", Some(130)),
    ] {
        let child = command(&["study", "--tiny", "--out", dir.path().to_str().unwrap()])
            .env("RAYON_NUM_THREADS", "1")
            .stdin(Stdio::null())
            .spawn()
            .unwrap();
        let start = Instant::now();
        while lines() < least && start.elapsed() < Duration::from_secs(60) {
            thread::sleep(Duration::from_millis(1));
        }
        let run = Run::end(child, signal).unwrap();
        assert_eq!(run.code, code, "{:?}", run.err);
        if code.is_some() {
            let last = run.err.last().unwrap();
            assert!(
                last.contains(&format!("interrupted by SIG{signal}: "))
                    && last.contains(&format!("of {CELLS} cells are in "))
                    && last.contains(WHOLE),
                "{last}"
            );
        }
        assert!(lines() >= least, "only {} lines after a minute", lines());
    }
    assert!(
        lines() < CELLS + 1 && !dir.path().join("study.csv").exists(),
        "killed too late to show anything"
    );
    lend(reference(), dir.path());
    let run = study(dir.path(), "2", &[]);
    assert_eq!(run.code, Some(0), "{:?}", run.err);
    assert!(
        (run.err.iter()).any(|line| line.contains(WHOLE) && line.contains("continues after")),
        "{:?}",
        run.err
    );
    assert_same_rows(dir.path(), "killed three times");
}

#[test]
fn parts_joined_are_the_same_as_one_run() {
    let (shared, apart, out) = (
        TempDir::new().unwrap(),
        TempDir::new().unwrap(),
        TempDir::new().unwrap(),
    );
    for (dir, shard) in [(&shared, "1/4"), (&apart, "4/4"), (&shared, "3/4")] {
        let run = study(dir.path(), "1", &["--shard", shard]);
        assert_eq!(
            (run.code, run.out.len()),
            (Some(0), 0),
            "{shard}: {:?}",
            run.err
        );
    }
    // Parts are missing: the message names them, and nothing is written.
    let folders = [shared.path(), apart.path()];
    assert_refused(
        &merge(&out.path().join("new"), &folders),
        "not complete: shard 2/4 missing",
    );
    assert!(!out.path().join("new").exists(), "a folder for nothing");
    let run = study(apart.path(), "1", &["--shard", "2/4"]);
    assert_eq!(run.code, Some(0), "{:?}", run.err);
    lend(reference(), &out.path().join("new"));
    let run = merge(&out.path().join("new"), &folders);
    assert_eq!(run.code, Some(0), "{:?}", run.err);
    assert!(
        run.out.iter().any(|line| line.contains("geometric mean")),
        "a summary: {:?}",
        run.out
    );
    assert_same_rows(&out.path().join("new"), "four parts");

    // A part that was stopped is named too; a part that is given twice does no harm.
    let part = shared.path().join("cells-3-of-4.jsonl");
    let bytes = fs::read(&part).unwrap();
    fs::write(&part, &bytes[..bytes.len() - 10]).unwrap();
    assert_refused(
        &merge(out.path(), &folders),
        "not complete: shard 3/4 has 2 of 3 cells",
    );
    fs::copy(
        apart.path().join("cells-2-of-4.jsonl"),
        shared.path().join("cells-2-of-4.jsonl"),
    )
    .unwrap();
    let run = study(shared.path(), "1", &["--shard", "3/4"]);
    assert_eq!(run.code, Some(0), "{:?}", run.err);
    lend(reference(), out.path());
    assert_eq!(merge(out.path(), &folders).code, Some(0));
    assert_same_rows(out.path(), "a part stopped and one twice");
}

/// Returns the number of timed look-ups of this light in `dir`.
fn look_ups(dir: &Path, environment: &str) -> usize {
    let times = fs::read_to_string(dir.join("times.csv")).unwrap();
    times
        .lines()
        .filter(|line| line.starts_with(&format!(",,,{environment},")))
        .count()
}

#[test]
fn a_whole_run_can_be_merged_too() {
    let out = TempDir::new().unwrap();
    let run = merge(out.path(), &[reference()]);
    assert_eq!(run.code, Some(0), "{:?}", run.err);
    assert_same_rows(out.path(), "one part");
    assert_eq!(
        look_ups(out.path(), "clear sky"),
        1,
        "the sky needs no file"
    );
    assert!(
        !run.err.iter().any(|line| line.contains("--env")),
        "{:?}",
        run.err
    );
}

#[test]
fn a_look_up_is_timed_after_a_merge_if_the_environment_is_at_hand() {
    let (dir, out) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    let [map, other] = ["map.hdr", "other.hdr"].map(|name| dir.path().join(name));
    for (path, level) in [(&map, 128), (&other, 64)] {
        let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n".to_vec();
        bytes.extend((0..8).flat_map(|texel| [level, level, 200, 120 + texel]));
        fs::write(path, bytes).unwrap();
    }
    let env = |path: &Path| ["--env".to_owned(), path.to_str().unwrap().to_owned()];
    let with_map = env(&map);
    let run = study_and_keep(dir.path(), "2", &with_map.each_ref().map(String::as_str));
    assert_eq!(run.code, Some(0), "{:?}", run.err);
    assert_eq!(look_ups(dir.path(), "map.hdr"), 1);

    lend(dir.path(), out.path());
    let run = merge(out.path(), &[dir.path()]);
    assert_eq!(run.code, Some(0), "{:?}", run.err);
    assert!(
        (run.err.iter()).any(|line| line.contains("not timed; pass --env FILE")),
        "{:?}",
        run.err
    );
    assert_eq!(look_ups(out.path(), "map.hdr"), 0);
    let efficiency = fs::read_to_string(out.path().join("efficiency.csv")).unwrap();
    let fields = |line: &str| -> Vec<String> { line.split(',').map(str::to_owned).collect() };
    let names = fields(efficiency.lines().next().unwrap());
    for row in efficiency.lines().skip(1).map(fields) {
        let of = |name: &str| &row[names.iter().position(|of| of == name).unwrap()];
        let is_timed = of("light") != "map.hdr" && of("sampler") != "perfect";
        assert_eq!(!of("look_up_ns").is_empty(), is_timed, "{row:?}");
        assert_eq!(!of("look_up_gain_at_16").is_empty(), is_timed, "{row:?}");
        assert_eq!(
            !of("gain_at_16").is_empty(),
            of("sampler") != "perfect",
            "{row:?}"
        );
    }

    let merged = |path: &Path| {
        let args = [
            out.path().to_str().unwrap().to_owned(),
            dir.path().to_str().unwrap().to_owned(),
        ];
        let args: Vec<String> = ["merge".to_owned()]
            .into_iter()
            .chain(args)
            .chain(env(path))
            .collect();
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        command(&args).stdin(Stdio::null()).output().unwrap().into()
    };
    assert_refused(
        &merged(&other),
        "--env must be the environment of the parts",
    );
    assert_refused(&merged(Path::new("missing.hdr")), "missing.hdr");
    lend(dir.path(), out.path());
    let run = merged(&map);
    assert_eq!(run.code, Some(0), "{:?}", run.err);
    assert_eq!(look_ups(out.path(), "map.hdr"), 1);
    for name in ROWS {
        assert_eq!(
            fs::read(out.path().join(name)).unwrap(),
            fs::read(dir.path().join(name)).unwrap(),
            "{name}"
        );
    }
}

#[test]
fn materials_join_a_study_and_move_no_row() {
    let dir = TempDir::new().unwrap();
    let at = |name: &str| dir.path().join(name);
    let file = at("soft.json");
    let json =
        r#"{"model":"kajiya-kay","params":{"kd":[0.4,0.3,0.2],"ks":[0.1,0.3,0.5],"exponent":20}}"#;
    fs::write(&file, json).unwrap();
    let flags = ["--model", "chiang", "--material", file.to_str().unwrap()];
    let whole = study_and_keep(&at("whole"), "2", &flags);
    assert_eq!(whole.code, Some(0), "{:?}", whole.err);
    for shard in ["1/2", "2/2"] {
        let run = study(
            &at("parts"),
            "2",
            &[&flags[..], &["--shard", shard]].concat(),
        );
        assert_eq!(run.code, Some(0), "{:?}", run.err);
    }
    lend(&at("whole"), &at("merged"));
    let merged = merge(&at("merged"), &[&at("parts")]);
    assert_eq!(merged.code, Some(0), "{:?}", merged.err);
    let read = |of: &str, name: &str| fs::read_to_string(at(of).join(name)).unwrap();
    assert!(
        read("whole", "study.csv") == fs::read_to_string(reference().join("study.csv")).unwrap(),
        "the rows of the grid are as without materials"
    );
    let rows = read("whole", "materials.csv");
    assert_eq!(rows, read("merged", "materials.csv"));
    let has = |words: &str| rows.lines().any(|line| line.starts_with(words));
    assert!(has("soft,kajiya-kay,85.0,uniform,constant,"), "{rows}");
    assert!(
        has("chiang-") && rows.contains(",mean,clear sky,"),
        "{rows}"
    );
    assert!(
        whole.out.iter().any(|line| line.contains("soft")),
        "{:?}",
        whole.out
    );
    // Other flags with the same folder: a part of other materials is rejected.
    assert_refused(&study(&at("whole"), "1", &[]), "materials");
    for (flags, words) in [
        (["--model", "phong"], "--model must be one of gaussian"),
        (
            ["--material", "none.json"],
            "--material none.json: cannot read",
        ),
    ] {
        let refused = study(&at("refused"), "1", &flags);
        assert_eq!(
            (refused.code, refused.err.len()),
            (Some(2), 1),
            "{:?}",
            refused.err
        );
        assert!(refused.err[0].contains(words), "{:?}", refused.err);
    }
}
