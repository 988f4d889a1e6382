//! Bad input, which ends with exit code 2 and one line that names it, before anything is rendered.

use super::{refuse, run};
use std::fs;
use tempfile::TempDir;

/// Checks that clap rejects flags with the flag, the value and the values that are allowed.
#[test]
fn bad_flags_are_refused() {
    let folder = TempDir::new().expect("a folder");
    for (flags, words) in [
        (&["render", "nowhere"][..], &["nowhere", "head"][..]),
        (
            &["render", "head", "--size", "0x40"],
            &["--size", "0x40", "1 to 16384"],
        ),
        (
            &["render", "head", "--size", "20000x40"],
            &["--size", "20000x40", "1 to 16384"],
        ),
        (
            &["render", "head", "--mis", "all"],
            &["--mis", "all", "both"],
        ),
        (&["figures", "--shard", "3/2"], &["--shard", "3/2"]),
        (
            &["figures", "--env", "a.exr", "--env", "./a.exr"],
            &["--env", "a.exr twice"],
        ),
        (&["figures", "--layer", "beauty"], &["--env"]),
    ] {
        let output = run(&folder, flags);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{flags:?}: {errors}");
        assert!(
            words.iter().all(|word| errors.contains(word)),
            "{flags:?}: {errors}"
        );
    }
    assert_eq!(
        fs::read_dir(folder.path()).expect("there").count(),
        0,
        "nothing is written"
    );
}

#[test]
fn bad_values_are_refused_in_one_line() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("file"), "no folder").expect("written");
    fs::write(folder.path().join("cut.hair"), b"HAIR\x01\0\0\0").expect("written");
    fs::write(folder.path().join("file.hair"), [0; 200]).expect("written");
    fs::write(folder.path().join("cut.tfx"), [0; 90]).expect("written");
    fs::write(
        folder.path().join("cut.hdr"),
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n\x02\x02",
    )
    .expect("written");
    for (flags, words) in [
        (&["--spp", "0"][..], &["--spp", "got 0"][..]),
        (&["--aa", "0"], &["--aa", "got 0"]),
        (&["--depth", "0"], &["--depth", "got 0"]),
        (
            &["--integrator", "gather", "--depth", "4"],
            &["--depth", "path", "got gather"],
        ),
        (
            &["--integrator", "path", "--aa", "4"],
            &["--aa", "gather", "got path"],
        ),
        (&["--time", "0"], &["--time", "got 0"]),
        (&["--exposure", "nan"], &["--exposure", "NaN"]),
        (&["--crop", "0,0,9999,1"], &["--crop"]),
        (&["--hair", "green"], &["green", "blond"]),
        (&["--model", "phong"], &["phong", "gaussian"]),
        (&["--sampler", "best"], &["best", "matched"]),
        (&["--strands", "0"], &["strands", "0"]),
        (&["--out", "file/a.exr", "--strands", "300"], &["file"]),
        (&["--out", "a.png"], &[".exr", "a.png"]),
        (&["--import", "none.hair"], &["none.hair"]),
        (&["--import", "cut.hair"], &["cut.hair"]),
        (&["--import", "cut.tfx"], &["cut.tfx"]),
        (&["--env", "cut.hdr"], &["cut.hdr"]),
        (
            &["--env", "cut.hdr", "--layer", "beauty"],
            &["cut.hdr", "no layers"],
        ),
        // Numbers below 0 are values and no flags.
        (&["--exposure", "-1"], &["--exposure", "got -1"]),
        (&["--backdrop", "-0.5"], &["--backdrop", "got -0.5"]),
        (&["--spp", "-1"], &["-1", "--spp"]),
        (&["--crop", "-1,0,5,5"], &["--crop", "-1,0,5,5"]),
        (&["--size", "-1x40"], &["--size", "-1x40"]),
        (
            &["--import", "file.hair", "--scale", "-1"],
            &["scale", "got -1"],
        ),
        (
            &["--hair", "default", "--integrator", "path"],
            &["default", "--energy per-wo"],
        ),
    ] {
        let all: Vec<&str> = ["render", "head"].iter().chain(flags).copied().collect();
        let line = refuse(&folder, &all);
        assert!(
            words.iter().all(|word| line.contains(word)),
            "{flags:?}: {line}"
        );
    }
    assert!(
        !folder.path().join("out/render/head.exr").exists(),
        "nothing is rendered"
    );
}

#[test]
fn without_arguments_it_shows_what_to_try_on_one_terminal() {
    let folder = TempDir::new().expect("a folder");
    let text = String::from_utf8(run(&folder, &[""; 0]).stdout).expect("UTF-8");
    let lines: Vec<&str> = text.lines().collect();
    let tries = lines
        .iter()
        .filter(|line| line.starts_with("  hairis-render "));
    assert_eq!(tries.count(), 3, "{text}");
    let widest = lines.iter().map(|line| line.len()).max();
    assert!(lines.len() <= 20 && widest <= Some(80), "{text}");
}
