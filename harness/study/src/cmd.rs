//! Subcommands of `hairis` that this program executes, one per file.

pub mod claims;
pub mod fit;
pub mod merge;
pub mod study;

use crate::args::Command;
use hairis_instruments::error::Error;
use hairis_instruments::program::check_threads;

/// Executes a command with its flags.
///
/// # Errors
///
/// Returns an [`Error`] if the command was stopped, or if a check failed.
pub fn run(command: &Command) -> Result<(), Error> {
    check_threads();
    match command {
        Command::Study(flags) => study::run(flags),
        Command::Claims(flags) => claims::run(flags),
        Command::Fit(flags) => fit::run(flags),
        Command::Merge(flags) => merge::run(flags),
    }
}
