//! Files that grow by whole records, and that one process at a time writes to.

use crate::error::Error;
use std::fs::{File, TryLockError};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// A file that is only ever appended to. The system frees it when the process ends, however it
/// ends.
#[derive(Debug)]
pub struct Appended {
    path: PathBuf,
    /// The cause once a record might be torn: nothing must follow it.
    file: Mutex<Result<File, io::Error>>,
}

impl Appended {
    /// Opens a file, or makes an empty one. The caller reads it, and [cuts](Self::cut) off what is
    /// not whole.
    ///
    /// # Errors
    ///
    /// [`Error::Output`] if it cannot be written, [`Error::Part`] if another process is writing to
    /// it.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let file = File::options()
            .append(true)
            .create(true)
            .read(true)
            .open(path)
            .map_err(Error::output(path))?;
        // File systems without locks go without.
        if matches!(file.try_lock(), Err(TryLockError::WouldBlock)) {
            return Err(Error::Part {
                path: path.to_owned(),
                problem: "another process is writing to it".to_owned(),
            });
        }
        Ok(Self::of(path, file))
    }

    fn of(path: &Path, file: File) -> Self {
        Self {
            path: path.to_owned(),
            file: Mutex::new(Ok(file)),
        }
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Cuts off all but the first bytes, if there are more: records that are not whole.
    ///
    /// # Errors
    ///
    /// As [`append`](Self::append).
    pub fn cut(&self, whole: usize) -> Result<(), Error> {
        self.change(|file| {
            let whole = whole as u64;
            if file.metadata()?.len() > whole {
                file.set_len(whole)?;
            }
            Ok(())
        })
    }

    /// Appends records.
    ///
    /// # Errors
    ///
    /// [`Error::Output`] if they cannot be written, or earlier ones could not.
    pub fn append(&self, records: &[u8]) -> Result<(), Error> {
        self.change(|file| file.write_all(records))
    }

    fn change(&self, change: impl FnOnce(&mut File) -> io::Result<()>) -> Result<(), Error> {
        let output = Error::output(&self.path);
        let mut file = self
            .file
            .lock()
            .map_err(|_| output(io::Error::other("another thread failed")))?;
        if let Err(cause) = file.as_mut().map_or(Ok(()), change) {
            *file = Err(cause);
        }
        // Other threads fail by the same cause: whichever is reported names it.
        let copy = |cause: &io::Error| output(io::Error::new(cause.kind(), cause.to_string()));
        file.as_ref().map(|_| ()).map_err(copy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn records_follow_the_whole_ones() {
        let dir = tempfile::TempDir::new().expect("a folder");
        let path = dir.path().join("a");
        fs::write(&path, "one\ntwo\nthr").expect("written");
        let file = Appended::open(&path).expect("free");
        let again = Appended::open(&path).expect_err("in use").to_string();
        assert!(again.contains("another process"), "{again}");
        file.cut(8).expect("cut");
        file.cut(100).expect("nothing to cut");
        file.append(b"three\n").expect("written");
        drop(file);
        assert_eq!(fs::read(&path).expect("read"), b"one\ntwo\nthree\n");
        Appended::open(&path).expect("free again");
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn nothing_follows_a_record_that_could_not_be_written() {
        let path = Path::new("/dev/full");
        let full = File::options()
            .append(true)
            .open(path)
            .expect("Linux has it");
        let file = Appended::of(path, full);
        // Of several threads any may be the one whose error is reported: all of them name the
        // cause.
        for _ in 0..3 {
            let error = file.append(b"one\n").expect_err("full").to_string();
            assert!(
                error.starts_with("cannot write /dev/full: No space left"),
                "{error}"
            );
        }
        assert!(
            file.file.lock().is_ok_and(|file| file.is_err()),
            "nothing is written after that"
        );
    }
}
