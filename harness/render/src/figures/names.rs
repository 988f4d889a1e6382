//! Unique names of maps and of pictures.

use hairis_instruments::error::Error;
use hairis_materials::numbered;
use std::path::{Component, Path, PathBuf};

/// Returns a name for each file: the last part of its path, after as many folders as are needed to
/// make the name unique.
///
/// # Errors
///
/// Returns a usage error if a path is given twice.
pub fn of_files(paths: &[PathBuf]) -> Result<Vec<String>, Error> {
    let parts = |path: &Path| -> PathBuf {
        path.components()
            .filter(|part| *part != Component::CurDir)
            .collect()
    };
    let all: Vec<PathBuf> = paths.iter().map(|path| parts(path)).collect();
    for (place, path) in all.iter().enumerate() {
        if all[..place].contains(path) {
            return Err(Error::Usage(format!(
                "--env must be given once for each map, got {} twice",
                path.display()
            )));
        }
    }
    let last = |path: &Path, count: usize| -> PathBuf {
        let skipped = path.components().count().saturating_sub(count);
        path.components().skip(skipped).collect()
    };
    let name = |path: &PathBuf| {
        let is_own = |count: usize| {
            all.iter()
                .filter(|other| last(other, count) == last(path, count))
                .count()
                == 1
        };
        let count = (1..=path.components().count()).find(|count| is_own(*count));
        last(path, count.unwrap_or(usize::MAX))
            .to_string_lossy()
            .into_owned()
    };
    // Names that are not Unicode may look alike.
    Ok(numbered(all.iter().map(name)))
}

/// Returns the beginnings of the names of picture files, made from the titles of scenes.
#[must_use]
pub fn of_pictures(titles: &[String]) -> Vec<String> {
    numbered(
        titles
            .iter()
            .map(|title| title.replace(|c: char| !c.is_ascii_alphanumeric(), "-")),
    )
}
