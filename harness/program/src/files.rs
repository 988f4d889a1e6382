//! Atomic writes, after which a file exists as a whole or not at all.
//!
//! Symbolic links are followed: the links stay, and the file that they lead to is written. Anything that is not a file, such as a
//! terminal or a pipe, is written directly.

use crate::error::Error;
use core::hash::{Hash as _, Hasher as _};
use serde::Serialize;
use std::fs::{self, File};
use std::hash::DefaultHasher;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Largest number of symbolic links that are followed one after another, as many as Linux follows.
const MOST_LINKS: usize = 40;
/// Suffix of the name of a file that is not whole yet.
const UNFINISHED: &str = ".new";
/// Number of bytes that file systems allow in a name.
pub const LONGEST_NAME: usize = 255;

/// Writes a file under a temporary name and renames it once it is whole.
///
/// # Errors
///
/// Returns [`Error::Output`] with the name of the file, not the temporary name.
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
            // The unfinished file is of no use. The first error is the one to report.
            let _ = fs::remove_file(&unfinished);
        })
    };
    attempt().map_err(Error::output(path))
}

/// Writes `content` as a JSON file, as a whole or not at all.
///
/// # Errors
///
/// Returns [`Error::Output`] with the name of the file, not the temporary name.
pub fn write_json(path: &Path, content: &impl Serialize) -> Result<(), Error> {
    whole(path, |out| {
        serde_json::to_writer_pretty(&mut *out, content)?;
        out.write_all(b"\n")
    })
}

/// Checks that [`whole`] can write a file, before the work for the file begins. Leaves the file as it is.
///
/// # Errors
///
/// Returns [`Error::Output`] with the name of the file, not the temporary name.
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

/// Returns true if the path leads to something that is neither a file nor a folder, such as a device.
fn is_device(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|what| !what.is_file() && !what.is_dir())
}

/// Returns the path of the file that symbolic links lead to. The file need not exist.
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

/// Returns the temporary path of a file that is not whole yet, in the same folder. Names that would become too long are replaced by a
/// hash.
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
