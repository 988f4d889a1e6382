//! Atomic writes: a file exists as a whole or not at all.
//!
//! Symbolic links are followed: they stay, and the file that they lead to is written. What is no file, such as a terminal
//! or a pipe, is written directly.

use crate::error::Error;
use core::hash::{Hash as _, Hasher as _};
use serde::Serialize;
use std::fs::{self, File};
use std::hash::DefaultHasher;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Symbolic links behind each other, as many as Linux follows.
const MOST_LINKS: usize = 40;
/// Ending of a file that is not whole.
const UNFINISHED: &str = ".new";
/// Bytes that file systems allow in a name.
const LONGEST_NAME: usize = 255;

/// Writes a file under another name and renames it once it is whole.
///
/// # Errors
///
/// [`Error::Output`] with the file's own name.
pub fn whole(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), Error> {
    let fill = |path: &Path| {
        let mut out = BufWriter::new(File::create(path)?);
        write(&mut out)?;
        out.flush()
    };
    let attempt = || {
        if is_device(path) {
            return fill(path);
        }
        let target = behind_links(path)?;
        let unfinished = unfinished(&target);
        let renamed = fill(&unfinished).and_then(|()| fs::rename(&unfinished, target));
        renamed.inspect_err(|_| {
            // What there is of it is of no use. The first error is the one to report.
            let _ = fs::remove_file(&unfinished);
        })
    };
    attempt().map_err(Error::output(path))
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
        if is_device(path) {
            return File::options().write(true).open(path).map(drop);
        }
        let unfinished = unfinished(&behind_links(path)?);
        File::create(&unfinished)?;
        fs::remove_file(&unfinished)
    };
    attempt().map_err(Error::output(path))
}

/// Whether there is something that is neither a file nor a folder.
fn is_device(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|what| !what.is_file() && !what.is_dir())
}

/// The path of the file that symbolic links lead to. There need not be a file.
fn behind_links(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            Ok(link) => path = path.parent().unwrap_or(Path::new("")).join(link),
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("too many symbolic links"))
}

/// Name of a file while it is not whole, in the same folder.
fn unfinished(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    if name.len() + UNFINISHED.len() > LONGEST_NAME {
        let mut hash = DefaultHasher::new();
        name.hash(&mut hash);
        name = format!("{:016x}", hash.finish()).into();
    }
    name.push(UNFINISHED);
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

    #[cfg(unix)]
    #[test]
    fn links_stay_and_their_files_are_written() {
        use std::os::unix::fs::symlink;
        let dir = tempfile::TempDir::new().expect("a folder");
        let at = |name: &str| dir.path().join(name);
        fs::create_dir(at("far")).expect("made");
        symlink("far/second", at("first")).expect("linked");
        symlink("../file", at("far/second")).expect("linked");
        // There is no file yet, then there is one.
        for text in [b"one", b"two"] {
            writable(&at("first")).expect("writable");
            whole(&at("first"), |out| out.write_all(text)).expect("written");
            assert_eq!(fs::read(at("file")).expect("read"), text);
        }
        for link in ["first", "far/second"] {
            let link = fs::symlink_metadata(at(link)).expect("there");
            assert!(link.is_symlink(), "{link:?}");
        }
        assert_eq!(fs::read_dir(dir.path()).expect("read").count(), 3);
        symlink("loop", at("loop")).expect("linked");
        let error = whole(&at("loop"), |_| Ok(()))
            .expect_err("a loop")
            .to_string();
        assert!(error.contains("too many symbolic links"), "{error}");
        symlink("/dev/null", at("null")).expect("linked");
        writable(&at("null")).expect("a device");
        whole(&at("null"), |out| out.write_all(b"gone")).expect("a device");
        assert!(is_device(Path::new("/dev/null")));
    }

    #[test]
    fn the_longest_names_are_written() {
        let dir = tempfile::TempDir::new().expect("a folder");
        let path = dir.path().join("a".repeat(LONGEST_NAME));
        writable(&path).expect("writable");
        whole(&path, |out| out.write_all(b"text")).expect("written");
        assert_eq!(fs::read(&path).expect("read"), b"text");
    }
}
