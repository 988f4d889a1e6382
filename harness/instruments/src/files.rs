//! Atomic writes: a file exists as a whole or not at all.

use crate::error::Error;
use serde::Serialize;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Writes a file under another name and renames it once it is whole.
///
/// # Errors
///
/// [`Error::Output`] with the file's own name.
pub fn whole(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), Error> {
    let unfinished = unfinished(path);
    let attempt = || {
        let mut out = BufWriter::new(File::create(&unfinished)?);
        write(&mut out)?;
        out.flush()?;
        fs::rename(&unfinished, path)
    };
    attempt().map_err(|source| {
        // What there is of it is of no use. The first error is the one to report.
        let _ = fs::remove_file(&unfinished);
        Error::output(path)(source)
    })
}

/// Writes a JSON file, as a whole or not at all.
///
/// # Errors
///
/// [`Error::Output`] with the file's own name.
pub fn write_json(path: &Path, content: &impl Serialize) -> Result<(), Error> {
    whole(path, |out| {
        serde_json::to_writer_pretty(&mut *out, content)?;
        out.write_all(b"\n")
    })
}

/// Checks that [`whole`] can write a file, before the work for it begins. Leaves the file as it is.
///
/// # Errors
///
/// [`Error::Output`] with the file's own name.
pub fn writable(path: &Path) -> Result<(), Error> {
    let attempt = || {
        if path.is_dir() {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        let unfinished = unfinished(path);
        File::create(&unfinished)?;
        fs::remove_file(&unfinished)
    };
    attempt().map_err(Error::output(path))
}

/// Name of a file while it is not whole.
fn unfinished(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".new");
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_whole_or_as_it_was() {
        let dir = tempfile::TempDir::new().expect("a folder");
        let path = dir.path().join("figures.json");
        let names = || fs::read_dir(dir.path()).expect("read").count();
        writable(&path).expect("a new file");
        assert_eq!(names(), 0, "asking leaves nothing");
        whole(&path, |out| out.write_all(b"before")).expect("written");
        writable(&path).expect("an old file");
        let full = |out: &mut BufWriter<File>| {
            out.write_all(b"half of it")?;
            Err(io::Error::from(io::ErrorKind::StorageFull))
        };
        let error = whole(&path, full).expect_err("full").to_string();
        assert!(
            error.contains("figures.json") && !error.contains(".new"),
            "{error}"
        );
        assert_eq!(
            (fs::read(&path).expect("read"), names()),
            (b"before".to_vec(), 1)
        );
        assert!(writable(dir.path()).is_err(), "a folder");
        assert!(
            writable(&dir.path().join("none/file")).is_err(),
            "no folder"
        );
    }
}
