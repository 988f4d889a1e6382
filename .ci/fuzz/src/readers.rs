//! The readers of files: what they take is sound, and what they refuse they refuse in one line.

use hairis_harness::args::CodePath;
use hairis_harness::cmd::eval;
use hairis_instruments::light::{Environment, Light};
use hairis_render::formats::{Curve, Head, Import, Up, import_bytes, import_head_bytes};
use hairis_render::part::Part;
use hairis_study::study::part;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// `hairis eval`: a line out for each line in, whatever it is.
pub fn lines(data: &[u8]) {
    for path in [CodePath::X8, CodePath::F64] {
        let mut out = Vec::new();
        let _ = eval::stream(path, BufReader::new(data), &mut out);
        let expected = data.split(|byte| *byte == b'\n').count()
            - usize::from(data.is_empty() || data.ends_with(b"\n"));
        let lines = out.iter().filter(|byte| **byte == b'\n').count();
        assert_eq!(lines, expected, "lines");
    }
}

/// A file for readers that take a path; each process has its own.
fn file(name: &str, data: &[u8]) -> PathBuf {
    static DIR: LazyLock<PathBuf> = LazyLock::new(|| {
        let memory = Path::new("/dev/shm");
        let dir = if memory.is_dir() {
            memory.to_owned()
        } else {
            std::env::temp_dir()
        };
        let dir = dir.join(format!("hairis-fuzz-{}", std::process::id()));
        std::fs::create_dir_all(&dir).expect("a folder");
        dir
    });
    let path = DIR.join(name);
    std::fs::write(&path, data).expect("written");
    path
}

/// A part file: read or refused in one line.
pub fn parts(data: &[u8]) {
    match part::read(&file("cells-1-of-1.jsonl", data)) {
        Ok(part) => assert!(
            part.finished
                .iter()
                .all(|cell| cell.cell < part.header.cells),
            "cells of the grid"
        ),
        Err(error) => one_line(&error.to_string()),
    }
}

/// A picture's part, whatever its digests: a part that survives being written and joined with
/// itself, or refused.
pub fn picture(data: &[u8]) {
    let Some(part) = Part::from_bytes_unchecked(data) else {
        return;
    };
    assert!(
        Part::from_bytes(&part.to_bytes()).is_some_and(|again| again.to_bytes() == part.to_bytes()),
        "written and read"
    );
    match Part::merge(vec![("a".into(), part.clone()), ("b".into(), part.clone())]) {
        Ok(whole) => assert_eq!(
            whole.film.crop(),
            part.film.crop(),
            "a part joined with itself"
        ),
        Err(error) => one_line(&error.to_string()),
    }
}

/// An environment map: a light, or refused in one line.
pub fn map(data: &[u8]) {
    match Environment::load(file("map", data)) {
        Ok(map) => {
            for xi in [[0.0, 0.0], [0.3, 0.7], [0.999_999, 0.5]] {
                let sample = map.sample(xi);
                assert!(sample.pdf.is_finite() && sample.pdf >= 0.0, "density");
                assert!(
                    sample.radiance.iter().all(|c| c.is_finite() && *c >= 0.0),
                    "radiance"
                );
            }
        }
        Err(error) => one_line(&error.to_string()),
    }
}

/// A file of strands or of a head, of a format by its first bytes: strands or a mesh, or refused.
pub fn hair(data: &[u8]) {
    for name in [
        "fuzz.hair",
        "fuzz.tfx",
        "fuzz.data",
        "fuzz.bin",
        "fuzz.ply",
        "fuzz.txt",
    ] {
        for curve in [Curve::Smooth, Curve::BSpline] {
            let options = Import {
                curve,
                ..Import::default()
            };
            if let Err(error) = import_bytes(Path::new(name), data, &options) {
                one_line(&error.to_string());
            }
        }
    }
    let options = Head {
        scale: 1.0,
        up: Up::Y,
    };
    if let Err(error) = import_head_bytes(Path::new("fuzz.obj"), data, &options) {
        one_line(&error.to_string());
    }
}

fn one_line(error: &str) {
    assert!(!error.is_empty() && !error.contains('\n'), "{error:?}");
}
