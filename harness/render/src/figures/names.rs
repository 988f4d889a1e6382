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
pub(super) fn of_files(paths: &[PathBuf]) -> Result<Vec<String>, Error> {
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
pub(super) fn of_pictures(titles: &[String]) -> Vec<String> {
    numbered(
        titles
            .iter()
            .map(|title| title.replace(|c: char| !c.is_ascii_alphanumeric(), "-")),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(paths: &[&str]) -> Vec<String> {
        let paths: Vec<PathBuf> = paths.iter().map(PathBuf::from).collect();
        of_files(&paths).expect("different")
    }

    #[test]
    fn names_of_maps_are_as_short_as_they_can_be() {
        assert_eq!(names(&["/a/b/sky.exr"]), ["sky.exr"]);
        assert_eq!(
            names(&["m1/map.exr", "./m2/map.exr", "other.exr"]),
            ["m1/map.exr", "m2/map.exr", "other.exr"]
        );
        assert_eq!(
            names(&["map.exr", "m1/map.exr", "x/m1/map.exr"]),
            ["map.exr", "m1/map.exr", "x/m1/map.exr"]
        );
        assert_eq!(names(&["/map.exr", "map.exr"]), ["/map.exr", "map.exr"]);
        let twice = ["a.exr", "./a.exr"].map(PathBuf::from);
        let error = of_files(&twice).expect_err("the same").to_string();
        assert!(
            error.contains("--env") && error.contains("a.exr twice"),
            "{error}"
        );
    }

    #[cfg(unix)]
    #[test]
    fn names_that_are_no_text_stay_apart() {
        use std::os::unix::ffi::OsStrExt as _;
        let paths = [&b"\xfe.exr"[..], b"\xff.exr"]
            .map(|name| PathBuf::from(std::ffi::OsStr::from_bytes(name)));
        let names = of_files(&paths).expect("different");
        assert_ne!(names[0], names[1]);
    }

    #[test]
    fn pictures_of_scenes_stay_apart() {
        let titles = ["env (a/b.exr)", "env (a-b.exr)", "env (A b.exr)", "area"].map(str::to_owned);
        assert_eq!(
            of_pictures(&titles),
            [
                "env--a-b-exr-",
                "env--a-b-exr--2",
                "env--A-b-exr--3",
                "area"
            ]
        );
    }
}
