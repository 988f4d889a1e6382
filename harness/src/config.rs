//! A checked run, made of raw flags.

use crate::args::{self, Args, Command};
use crate::error::Error;
use clap::ValueEnum;
use std::path::PathBuf;

/// What to do, with everything checked that can be before the work starts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Run {
    /// `hairis eval`.
    Eval(Eval),
    /// `hairis compare`.
    Compare(Compare),
}

/// A run of `hairis compare`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Compare {
    /// Whether to make it short.
    pub quick: bool,
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Folder for the results.
    pub out: PathBuf,
    /// Environment light; the procedural sky if there is none.
    pub env: Option<PathBuf>,
}

/// A run of `hairis eval`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Eval {
    /// The code that answers.
    pub path: Path,
}

/// One of the ways to compute the same numbers. All give the same fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Path {
    /// One direction a call, in single precision
    Scalar,
    /// Eight lines a call, in single precision: eight materials and gather points, one a lane
    X8,
    /// Slices in, slices out, in single precision: neighbouring lines on the same hair with the same wo are one call
    Batch,
    /// The paper's formulas line by line, in double precision, on input rounded as for the others
    F64,
}

impl Run {
    /// The run that `args` ask for.
    ///
    /// # Errors
    ///
    /// [`Error::Usage`] if flags contradict each other or have values out of range.
    pub fn check(args: Args) -> Result<Self, Error> {
        match args.command {
            Command::Eval(eval) => Ok(Self::Eval(Eval { path: eval.path })),
            Command::Compare(args::Compare { quick, seed, out, env }) => {
                if out.as_os_str().is_empty() {
                    return Err(Error::Usage("--out needs the name of a folder".to_owned()));
                }
                Ok(Self::Compare(Compare { quick, seed, out, env }))
            }
        }
    }
}
