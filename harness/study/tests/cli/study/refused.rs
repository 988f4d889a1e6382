//! Studies that are rejected because of their flags, or of files that belong to another study.

use super::{FIGURES, WHOLE, assert_refused, lend, merge, reference, study};
use crate::cli::{names, run};
use hairis_study::study::part;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

#[test]
fn shards_that_are_none_are_refused() {
    let dir = TempDir::new().unwrap();
    let shape = "--shard must be I/N with whole numbers";
    for (shard, words) in [
        ("5/4", "--shard I must be from 1 to N, got \"5/4\""),
        (
            "13/13",
            "--shard N must be at most 12, the number of cells, got \"13/13\"",
        ),
        ("99999/100000", "--shard N must be at most 12"),
        ("0/4", "--shard I must be from 1 to N"),
        ("0/0", "--shard I must be from 1 to N"),
        ("x", shape),
        ("1", shape),
        ("1/x", shape),
        ("1/2/3", shape),
        ("1.5/2", shape),
        ("", shape),
    ] {
        assert_refused(&study(dir.path(), "1", &["--shard", shard]), words);
    }
    assert_refused(&study(dir.path(), "1", &["--shard=-1/4"]), shape);
    assert_eq!(
        fs::read_dir(dir.path()).unwrap().count(),
        0,
        "nothing was written"
    );
}

#[test]
fn other_bad_flags_are_refused() {
    for (args, words) in [
        (&["study", "--seed", "x"][..], "--seed"),
        (&["study", "--out", ""], "--out"),
        (&["study", "--quik"], "--quik"),
        (&["study", "--env", "missing.hdr"], "missing.hdr"),
        (&["claims", "--seed", "x"], "--seed"),
        (&["claims", "--out", ""], "--out"),
        (&["claims", "--quik"], "--quik"),
        (&["merge"], "OUT_DIR"),
        (&["merge", "out"], "PART_DIR"),
        (&["merge", "out", ""], "PART_DIR"),
        (&["merge", "out", ".", "--env"], "--env"),
    ] {
        assert_refused(&run(args, b""), words);
    }
}

/// Returns a folder with a copy of the reference's part file.
fn copied() -> TempDir {
    let dir = TempDir::new().unwrap();
    fs::copy(reference().join(WHOLE), dir.path().join(WHOLE)).unwrap();
    dir
}

#[test]
fn cells_of_another_run_are_refused() {
    let dir = copied();
    let before = fs::read(dir.path().join(WHOLE)).unwrap();
    let words = "cells-1-of-1.jsonl: belongs to a run with seed 1, expected 2; pass another --out or delete the file";
    assert_refused(&study(dir.path(), "1", &["--seed", "2"]), words);
    let path = dir.path().to_str().unwrap();
    assert_refused(
        &run(&["study", "--out", path], b""),
        "belongs to a run with quick true, expected false",
    );
    assert_eq!(
        fs::read(dir.path().join(WHOLE)).unwrap(),
        before,
        "a refused file is left alone"
    );

    // As of an older program, or of another instruction set.
    let whole = part::read(&dir.path().join(WHOLE)).unwrap();
    for field in ["format", "version", "commit", "level", "environment"] {
        let mut header = serde_json::to_value(&whole.header).unwrap();
        header[field] = "other".into();
        fs::write(dir.path().join(WHOLE), part::line(&header).unwrap()).unwrap();
        assert_refused(
            &study(dir.path(), "1", &[]),
            &format!("belongs to a run with {field} \"other\""),
        );
    }
    // The format before there were rays has no pools in its header.
    let mut header = serde_json::to_value(&whole.header).unwrap();
    header["format"] = "hairis-study-3".into();
    header.as_object_mut().unwrap().remove("pools");
    fs::write(dir.path().join(WHOLE), part::line(&header).unwrap()).unwrap();
    assert_refused(
        &study(dir.path(), "1", &[]),
        "belongs to a run with format \"hairis-study-3\"",
    );
}

#[test]
fn files_that_are_no_parts_are_refused_and_left_alone() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join(WHOLE);
    for text in ["something else\n", "something without an end", "{}\n", "\n"] {
        fs::write(&path, text).unwrap();
        assert_refused(
            &study(dir.path(), "1", &[]),
            "cells-1-of-1.jsonl: is no part of a study",
        );
        assert_refused(
            &merge(dir.path(), &[dir.path()]),
            "cells-1-of-1.jsonl: is no part of a study",
        );
        assert_eq!(fs::read_to_string(&path).unwrap(), text);
    }
}

#[test]
fn damage_before_the_last_line_is_refused() {
    let dir = copied();
    let path = dir.path().join(WHOLE);
    let text = fs::read_to_string(&path).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let with = |number: usize, line: &str| {
        let mut lines = lines.clone();
        lines[number - 1] = line;
        fs::write(&path, format!("{}\n", lines.join("\n"))).unwrap();
    };
    with(7, &lines[6][..100]);
    assert_refused(
        &study(dir.path(), "1", &[]),
        "line 7 is damaged: not a cell",
    );
    let sealed = |cell: usize| {
        let line = part::line(&part::Finished {
            cell,
            rows: Vec::new(),
        })
        .unwrap();
        String::from_utf8(line).unwrap().trim_end().to_owned()
    };
    with(9, &sealed(12));
    assert_refused(
        &study(dir.path(), "1", &[]),
        "line 9 is damaged: cell 12 is not of shard 1/1",
    );
    with(3, &sealed(4));
    assert_refused(
        &merge(dir.path(), &[dir.path()]),
        "line 3 is damaged: 0 rows",
    );
    with(4, &lines[3].replacen("1.", "2.", 1));
    let words = "line 4 is damaged: its checksum is wrong; delete the line, and `hairis study` computes it again";
    assert_refused(&merge(dir.path(), &[dir.path()]), words);
    // The message asks to delete the line.
    with(4, "");
    let text = fs::read_to_string(&path).unwrap().replace("\n\n", "\n");
    fs::write(&path, text).unwrap();
    lend(reference(), dir.path());
    assert_eq!(
        study(dir.path(), "2", &[]).code,
        Some(0),
        "the line is computed again"
    );
}

#[test]
fn parts_that_do_not_belong_together_are_refused() {
    let out = TempDir::new().unwrap();
    let shard = |seed: &str, shard: &str| {
        let dir = TempDir::new().unwrap();
        // Only the first line matters here.
        let run = study(dir.path(), "2", &["--seed", seed, "--shard", shard]);
        assert_eq!(run.code, Some(0), "{:?}", run.err);
        dir
    };
    let (first, other_seed, other_split) =
        (shard("1", "1/6"), shard("2", "2/6"), shard("1", "3/10"));
    let merged = |a: &TempDir, b: &TempDir| merge(out.path(), &[a.path(), b.path()]);
    assert_refused(
        &merged(&first, &other_seed),
        "cells-2-of-6.jsonl: belongs to a run with seed 2, but",
    );
    assert_refused(
        &merged(&first, &other_split),
        "cells-3-of-10.jsonl: is one of 10 parts, but",
    );
    assert_refused(
        &merge(out.path(), &[out.path()]),
        "contains no part of a study",
    );
    assert_refused(
        &merge(out.path(), &[Path::new("/nonexistent")]),
        "/nonexistent: cannot read",
    );

    // The same cell with other figures.
    let changed = TempDir::new().unwrap();
    let name = "cells-1-of-6.jsonl";
    let mut read = part::read(&first.path().join(name)).unwrap();
    read.finished[0].rows[0][0] = Some(2.0);
    let mut text = part::line(&read.header).unwrap();
    read.finished
        .iter()
        .for_each(|cell| text.extend(part::line(cell).unwrap()));
    fs::write(changed.path().join(name), text).unwrap();
    assert_refused(&merged(&first, &changed), "differs in cell");
}

#[test]
fn a_folder_that_cannot_be_written_is_refused() {
    let dir = TempDir::new().unwrap();
    fs::write(dir.path().join("file"), "").unwrap();
    assert_refused(
        &study(&dir.path().join("file/out"), "1", &[]),
        "cannot write",
    );
    fs::create_dir(dir.path().join(WHOLE)).unwrap();
    assert_refused(&study(dir.path(), "1", &[]), "cannot write");
}

#[test]
fn files_that_cannot_be_written_are_refused_before_any_work() {
    let is_result =
        |name: &String| !name.ends_with(".jsonl") && !name.ends_with(".part") && name != FIGURES;
    let results: Vec<String> = names(reference()).into_iter().filter(is_result).collect();
    for name in ["figures", "report.html", "study.csv", "refitted.csv"] {
        assert!(results.iter().any(|result| result == name), "{results:?}");
    }
    for name in &results {
        let dir = TempDir::new().unwrap();
        let taken = dir.path().join(name);
        if name == "figures" {
            fs::write(taken, "").unwrap();
        } else {
            fs::create_dir(taken).unwrap();
        }
        assert_refused(&study(dir.path(), "1", &[]), name);
        let part = fs::read_to_string(dir.path().join(WHOLE)).unwrap();
        assert_eq!(part.lines().count(), 1, "{name}: no cell is computed");
        assert_refused(&merge(dir.path(), &[reference()]), name);
        let is_kept = |name: &String| name.ends_with(".part");
        assert!(
            !names(dir.path()).iter().any(is_kept),
            "{name}: no model is refitted"
        );
    }
    // The reference has no materials.
    let dir = TempDir::new().unwrap();
    fs::create_dir(dir.path().join("materials.csv")).unwrap();
    assert_refused(
        &study(dir.path(), "1", &["--model", "chiang"]),
        "materials.csv",
    );
}
