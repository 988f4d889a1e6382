//! Tests of the program, run as from a shell.

mod fit;
mod frames;
mod hair;
mod imported;
mod paths;
mod refused;
mod resumed;

use exr::prelude::{FlatSamples, read_all_flat_layers_from_file};
use std::ffi::OsStr;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

/// Flags of a small picture.
const SMALL: [&str; 4] = ["--strands", "300", "--size", "40x40"];

/// Runs the program in a folder.
fn run(folder: &TempDir, flags: &[impl AsRef<OsStr>]) -> Output {
    let program = env!("CARGO_BIN_EXE_hairis-render");
    Command::new(program)
        .args(flags)
        .current_dir(folder.path())
        .output()
        .expect("it starts")
}

/// Runs the program, and checks that it succeeds.
fn succeed(folder: &TempDir, flags: &[&str]) -> String {
    let output = run(folder, flags);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{flags:?}: {errors}");
    String::from_utf8(output.stdout).expect("text")
}

/// Renders a small picture.
fn render(folder: &TempDir, flags: &[&str]) -> String {
    succeed(folder, &[&["render"], flags, &SMALL].concat())
}

/// Runs the program, and returns the last line of its error: the program's own, after remarks on the hair.
fn refuse(folder: &TempDir, flags: &[&str]) -> String {
    let output = run(folder, flags);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{flags:?}: {errors}");
    let line = errors.lines().last().expect("a line").to_owned();
    assert!(line.starts_with("hairis-render: "), "{flags:?}: {errors}");
    line
}

/// Returns the channels of a picture by name, as bits.
fn channels(folder: &TempDir, file: impl AsRef<Path>) -> Vec<(String, Vec<u32>)> {
    let file = read_all_flat_layers_from_file(folder.path().join(file)).expect("a picture");
    let [layer] = &file.layer_data[..] else {
        panic!("one part")
    };
    let numbers = |samples: &FlatSamples| match samples {
        FlatSamples::F32(numbers) => numbers.iter().map(|number| number.to_bits()).collect(),
        other => panic!("{other:?}"),
    };
    layer
        .channel_data
        .list
        .iter()
        .map(|one| (one.name.to_string(), numbers(&one.sample_data)))
        .collect()
}
