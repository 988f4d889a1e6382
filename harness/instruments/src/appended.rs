//! Files that grow by whole records, and to which only one process at a time writes.

use crate::error::Error;
use std::fs::{File, TryLockError};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// File that is only ever appended to, locked for this process. The system releases the lock when the process ends, however it ends.
#[derive(Debug)]
pub struct Appended {
    path: PathBuf,
    /// File, or the cause of a failed write: a record may then be torn, so nothing must follow it.
    file: Mutex<Result<File, io::Error>>,
}

impl Appended {
    /// Opens a file, or makes an empty one, and locks it. The caller reads the file, and [cuts](Self::cut) off an incomplete record at
    /// the end.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Output`] if the file cannot be opened for writing, and [`Error::Part`] if another process is writing to it.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let file = File::options()
            .append(true)
            .create(true)
            .read(true)
            .open(path)
            .map_err(Error::output(path))?;
        // On file systems without locks the file stays unlocked.
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

    /// Returns the path of the file, as it was passed to [`open`](Self::open).
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Cuts the file off after the first `whole` bytes, if it is longer, to drop an incomplete record.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`append`](Self::append).
    pub fn cut(&self, whole: usize) -> Result<(), Error> {
        self.change(|file| {
            let whole = whole as u64;
            if file.metadata()?.len() > whole {
                file.set_len(whole)?;
            }
            Ok(())
        })
    }

    /// Appends records, which must be whole, to the end of the file.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Output`] if the records cannot be written, or if an earlier write failed.
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
        // Other threads fail with the same cause, so that whichever error is reported names it.
        let copy = |cause: &io::Error| output(io::Error::new(cause.kind(), cause.to_string()));
        file.as_ref().map(|_| ()).map_err(copy)
    }
}
