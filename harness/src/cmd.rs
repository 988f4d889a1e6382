//! The subcommands, one a file.

pub mod compare;
pub mod eval;

use crate::config::Run;
use crate::error::Error;

/// Does what a checked run asks for.
///
/// # Errors
///
/// Whatever stopped it, or what it found wrong: see [`Error`].
pub fn run(run: &Run) -> Result<(), Error> {
    match run {
        Run::Eval(config) => eval::run(config),
        Run::Compare(config) => compare::run(config),
    }
}
