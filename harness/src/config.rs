//! A checked run, made of raw flags.

use crate::args::{self, Args, Command};
use crate::error::Error;
use crate::study::Shard;
use clap::ValueEnum;
use std::path::PathBuf;

/// A run, checked as far as possible before the work starts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Run {
    /// `hairis eval`.
    Eval(Eval),
    /// `hairis compare`.
    Compare(Compare),
    /// `hairis study`.
    Study(Study),
    /// `hairis claims`.
    Claims(Claims),
    /// `hairis merge`.
    Merge(Merge),
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

/// A run of `hairis study`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Study {
    /// Whether to make it short.
    pub quick: bool,
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Folder for the results.
    pub out: PathBuf,
    /// Environment light; the procedural sky if there is none.
    pub env: Option<PathBuf>,
    /// The part to compute.
    pub shard: Shard,
}

/// A run of `hairis claims`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claims {
    /// Whether to make it short.
    pub quick: bool,
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Folder for the results.
    pub out: PathBuf,
}

/// A run of `hairis merge`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Merge {
    /// Folder for the results.
    pub out: PathBuf,
    /// Folders that hold the parts.
    pub parts: Vec<PathBuf>,
    /// Environment light of the parts, if it is available.
    pub env: Option<PathBuf>,
}

/// A run of `hairis eval`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Eval {
    /// The code path that computes the answers.
    pub path: Path,
}

/// Code path. All give the same fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Path {
    /// One direction per call, in single precision
    Scalar,
    /// Eight lines per call, in single precision: eight materials and shading points, one per lane
    X8,
    /// Slices, in single precision: neighbouring lines on the same hair with the same wo share a call
    Batch,
    /// The formulas line by line, in double precision, on the input as it is: the other paths round it
    F64,
}

impl Run {
    /// Checks `args`.
    ///
    /// # Errors
    ///
    /// [`Error::Usage`] if flags contradict each other or have values out of range.
    pub fn check(args: Args) -> Result<Self, Error> {
        match args.command {
            Command::Eval(eval) => Ok(Self::Eval(Eval { path: eval.path })),
            Command::Compare(args::Compare { quick, seed, out, env }) => {
                Ok(Self::Compare(Compare { quick, seed, out: folder(out)?, env }))
            }
            Command::Claims(args::Claims { quick, seed, out }) => {
                Ok(Self::Claims(Claims { quick, seed, out: folder(out)? }))
            }
            Command::Study(args::Study { quick, seed, out, env, shard }) => {
                let shard = match shard {
                    Some(text) => text.parse().map_err(|problem| Error::Usage(format!("--shard {problem}")))?,
                    None => Shard::WHOLE,
                };
                Ok(Self::Study(Study { quick, seed, out, env, shard }))
            }
            Command::Merge(args::Merge { out, parts, env }) => Ok(Self::Merge(Merge { out, parts, env })),
        }
    }
}

/// A folder that has a name.
fn folder(out: PathBuf) -> Result<PathBuf, Error> {
    if out.as_os_str().is_empty() {
        return Err(Error::Usage("--out needs the name of a folder".to_owned()));
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser as _;

    #[test]
    fn no_command_overwrites_the_report_of_another() {
        let out = |command| {
            let run = Run::check(Args::try_parse_from(["hairis", command]).expect("no flag is required"));
            match run.expect("the defaults are accepted") {
                Run::Compare(Compare { out, .. }) | Run::Study(Study { out, .. }) | Run::Claims(Claims { out, .. }) => {
                    out
                }
                run => panic!("{run:?} writes no report"),
            }
        };
        assert_ne!(out("compare"), out("study"), "both write a report.html");
        assert_eq!(out("claims"), out("study"), "the report of the study shows the verdicts");
    }
}
