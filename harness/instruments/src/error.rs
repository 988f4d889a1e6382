//! Errors that end a run of `hairis` with an exit code other than 0.

use crate::interrupt::Signal;
use crate::light::LightError;
use core::fmt;
use hairis::ParamError;
use std::io;
use std::path::{Path, PathBuf};

/// Failure of a run; `main` prints it once, in one line.
#[derive(Debug)]
pub enum Error {
    /// The command line is not valid.
    Usage(String),
    /// Standard input could not be read.
    Read(io::Error),
    /// Standard output could not be written, except for a closed pipe.
    Write(io::Error),
    /// The environment light could not be used.
    Environment(LightError),
    /// A file or folder of results could not be written.
    Output {
        /// The file or folder.
        path: PathBuf,
        /// The cause.
        source: io::Error,
    },
    /// A part of a study or of a picture, or a folder of them, could not be used.
    Part {
        /// The file or folder.
        path: PathBuf,
        /// The cause.
        problem: String,
    },
    /// Parts of a study or of a picture were joined, but some are missing.
    Missing(String),
    /// Hair that the program itself made was refused: a bug.
    Params(ParamError),
    /// Checks failed; each has been named on standard error.
    Failed(usize),
    /// Some lines of the input were refused; each was answered by an error of its own.
    Malformed {
        /// Number of refused lines.
        lines: u64,
        /// Number of lines in all.
        of: u64,
    },
    /// A signal asked the run to end, and what it had done is saved.
    Interrupted {
        /// The signal.
        signal: Signal,
        /// Place of the saved work, and how to continue it.
        saved: String,
    },
}

impl Error {
    /// A file or folder of results that cannot be written: for `map_err`.
    pub fn output(path: &Path) -> impl Fn(io::Error) -> Self + '_ {
        |source| Self::Output {
            path: path.to_owned(),
            source,
        }
    }

    /// The exit code: 1 for a failed comparison or check, 2 for bad usage or input, and what shells
    /// report for a process that a signal has ended.
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
            Self::Usage(problem) => f.write_str(problem),
            Self::Read(source) => write!(f, "cannot read standard input: {source}"),
            Self::Write(source) => write!(f, "cannot write standard output: {source}"),
            Self::Environment(source) => write!(f, "{source}"),
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

/// Without sources: the text of each is part of the message.
impl core::error::Error for Error {}

impl From<ParamError> for Error {
    fn from(source: ParamError) -> Self {
        Self::Params(source)
    }
}
