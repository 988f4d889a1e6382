//! Errors that end a run of a program with an exit code other than 0.

use crate::signal::Signal;
use core::fmt;
use hairis::ParamError;
use std::io;
use std::path::{Path, PathBuf};

/// Failure of a run, which `main` prints once, in one line.
#[derive(Debug)]
pub enum Error {
    /// Command line that is not valid: the problem in one line.
    Usage(String),
    /// Failure to read standard input.
    Read(io::Error),
    /// Failure to write to standard output, other than a closed pipe.
    Write(io::Error),
    /// Environment light that could not be used: the file and the reason.
    Environment(String),
    /// File or folder of results that could not be written.
    Output {
        /// Path of the file or folder.
        path: PathBuf,
        /// Cause of the failure.
        source: io::Error,
    },
    /// Part of a study or of a picture, or a folder of parts, that could not be used.
    Part {
        /// Path of the file or folder.
        path: PathBuf,
        /// Cause of the failure.
        problem: String,
    },
    /// Parts of a study or of a picture that were joined although some are missing.
    Missing(String),
    /// Rejected parameters of hair that the program itself made, which is a bug.
    Params(ParamError),
    /// Number of failed checks, each of which has been named on standard error.
    Failed(usize),
    /// Input of which some lines were rejected; each was answered by an error of its own.
    Malformed {
        /// Number of rejected lines.
        lines: u64,
        /// Number of lines in all.
        of: u64,
    },
    /// Signal that asked the run to end, after the finished work was saved.
    Interrupted {
        /// Signal that was received.
        signal: Signal,
        /// Location of the saved work, and how to continue it.
        saved: String,
    },
}

impl Error {
    /// Returns a function for `map_err` that makes [`Error::Output`] of the path and an I/O error.
    pub fn output(path: &Path) -> impl Fn(io::Error) -> Self + '_ {
        |source| Self::Output {
            path: path.to_owned(),
            source,
        }
    }

    /// Returns the exit code of a failed run: 1 for a failed comparison or check, and 2 for bad usage or input. A run that a signal has
    /// ended returns the code that shells report for the signal.
    #[must_use]
    pub const fn exit_code(&self) -> u8 {
        match self {
            Self::Failed(_) | Self::Params(_) => 1,
            Self::Interrupted { signal, .. } => 128 + signal.number(),
            _ => 2,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Usage(problem) | Self::Environment(problem) => f.write_str(problem),
            Self::Read(source) => write!(f, "cannot read standard input: {source}"),
            Self::Write(source) => write!(f, "cannot write standard output: {source}"),
            Self::Output { path, source } => write!(f, "cannot write {}: {source}", path.display()),
            Self::Part { path, problem } => write!(f, "{}: {problem}", path.display()),
            Self::Missing(what) => write!(f, "not complete: {what}"),
            Self::Params(source) => write!(f, "{source}"),
            Self::Failed(1) => f.write_str("1 check failed"),
            Self::Failed(checks) => write!(f, "{checks} checks failed"),
            Self::Malformed { lines, of } => write!(f, "{lines} of {of} lines were refused"),
            Self::Interrupted { signal, saved } => {
                write!(f, "interrupted by {}: {saved}", signal.name())
            }
        }
    }
}

/// Reports no sources, because the text of the source is part of the message.
impl core::error::Error for Error {}

impl From<ParamError> for Error {
    fn from(source: ParamError) -> Self {
        Self::Params(source)
    }
}
