//! The subcommands, one per file.

pub mod claims;
pub mod compare;
pub mod eval;
pub mod merge;
pub mod study;

use crate::config::Run;
use crate::error::Error;
use crate::light::{Environment, Sky};
use crate::table::Table;
use std::io::{self, Write};
use std::path::Path;

/// Executes a checked run.
///
/// # Errors
///
/// [`Error`] if it was stopped, or if a check failed.
pub fn run(run: &Run) -> Result<(), Error> {
    match run {
        Run::Eval(config) => eval::run(config),
        Run::Compare(config) => compare::run(config),
        Run::Study(config) => study::run(config),
        Run::Claims(config) => claims::run(config),
        Run::Merge(config) => merge::run(config),
    }
}

/// The environment in a file, or the procedural sky if there is none, and its name in reports.
fn environment(path: Option<&Path>) -> Result<(Environment, String), Error> {
    match path {
        Some(path) => Ok((Environment::load(path).map_err(Error::Environment)?, path.display().to_string())),
        None => Ok((Sky::default().environment(), "procedural sky".to_owned())),
    }
}

/// Prints tables on standard output. Ignores a closed pipe.
fn print_tables<'a>(tables: impl Iterator<Item = &'a Table>) -> io::Result<()> {
    let mut out = io::stdout().lock();
    for table in tables {
        match writeln!(out, "{}", table.to_terminal()) {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(()),
            result => result?,
        }
    }
    Ok(())
}

/// Prints a line on standard error. Ignores write errors.
fn say(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}
