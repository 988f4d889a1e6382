//! Environment maps that `compare` refuses or remarks on.

use super::run;
use exr::prelude::write_rgb_file;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Writes an `OpenEXR` map of one colour.
fn map(dir: &Path, [width, height]: [usize; 2], pixel: [f32; 3]) -> PathBuf {
    let path = dir.join("map.exr");
    write_rgb_file(&path, width, height, |_, _| pixel.into()).unwrap();
    path
}

/// Runs a comparison under a map, which ends with exit code 2, and returns its lines on standard error.
fn refused(map: &Path, out: &Path, more: &[&str]) -> Vec<String> {
    let paths = [out, map].map(|path| path.to_str().unwrap());
    let args = ["compare", "--quick", "--out", paths[0], "--env", paths[1]];
    let run = run(&[&args, more].concat(), b"");
    assert_eq!((run.code, run.out.len()), (Some(2), 0), "{:?}", run.err);
    run.err
}

#[test]
fn maps_without_light_and_layers_that_are_not_there_are_refused() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("out");
    let nothing = "map.exr: the map gives no light";
    let nan = "map.exr: the map gives no light: 24 NaN and 0 negative channels count as 0; pass another file";
    let layer = "map.exr: --layer must be a layer with colour of the file, got beauty; it has one without a name (R G B)";
    for (pixel, more, words) in [
        ([0.0; 3], &[][..], nothing),
        ([f32::NAN; 3], &[], nan),
        ([1.0; 3], &["--layer", "beauty"], layer),
    ] {
        let err = refused(&map(dir.path(), [4, 2], pixel), &out, more);
        assert!(err.len() == 1 && err[0].contains(words), "{err:?}");
    }
    assert!(!out.exists(), "nothing was written");
}

#[test]
fn a_stretched_map_is_reported() {
    let dir = TempDir::new().unwrap();
    let path = map(dir.path(), [4, 4], [1.0; 3]);
    // The folder cannot be made, so that the run ends before its work begins.
    let err = refused(&path, &path.join("out"), &[]);
    let words = "4 x 4 is not 2:1; it is stretched";
    assert!(err.len() == 2 && err[0].contains(words), "{err:?}");
}
