//! Materials from files, each under a name of its own.

use crate::material::MaterialSpec;
use std::collections::HashSet;
use std::fs::File;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

/// Length of the longest file that is read, in bytes: enough for thousands of materials.
const LONGEST: u64 = 1 << 20;

/// Reads the materials of files, each under a unique name. A material is named after its file; if the file has several materials, their
/// places in the file are appended, and if another material has the same name already, a number.
///
/// # Errors
///
/// Returns an error that names the file if the file cannot be read, or the file and the field if a material is rejected.
pub fn read(paths: &[PathBuf]) -> Result<Vec<(String, MaterialSpec)>, String> {
    let (mut names, mut all) = (Vec::new(), Vec::new());
    for path in paths {
        let refuse = |problem: String| format!("{}: {problem}", path.display());
        let materials = text(path)
            .and_then(|text| MaterialSpec::parse_all(&text))
            .map_err(refuse)?;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        names.extend((1..=materials.len()).map(|place| match materials.len() {
            1 => stem.clone().into_owned(),
            _ => format!("{stem}-{place}"),
        }));
        all.extend(materials);
    }
    Ok(numbered(names.into_iter()).into_iter().zip(all).collect())
}

/// Makes names unique by appending a number to every name that has occurred before. Capitals do not count as a difference, because file
/// systems may not tell them apart.
#[must_use]
pub fn numbered(names: impl Iterator<Item = String>) -> Vec<String> {
    let mut taken = HashSet::new();
    let mut own = |name: String| {
        let numbers = (2..).map(|number: u32| format!("{name}-{number}"));
        let mut candidates = [name.clone()].into_iter().chain(numbers);
        candidates
            .find(|candidate| taken.insert(candidate.to_lowercase()))
            .unwrap_or(name)
    };
    names.map(&mut own).collect()
}

/// Returns the text of a file, which must be UTF-8 of at most [`LONGEST`] bytes.
fn text(path: &Path) -> Result<String, String> {
    let cannot = |error: io::Error| format!("cannot read: {error}");
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|file| file.take(LONGEST + 1).read_to_end(&mut bytes))
        .map_err(cannot)?;
    if bytes.len() as u64 > LONGEST {
        return Err(format!("must have at most {LONGEST} bytes, has more"));
    }
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err("must be UTF-8, got UTF-16: save it as UTF-8".to_owned());
    }
    String::from_utf8(bytes).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        format!("must be UTF-8, got something else after byte {place}")
    })
}
