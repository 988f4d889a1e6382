//! The subcommands.

mod merge;
mod render;

pub(crate) use render::environment;

use crate::args::Command;
use hairis_instruments::error::Error;

/// Runs a subcommand.
///
/// # Errors
///
/// Errors of the subcommand.
pub fn run(command: &Command) -> Result<(), Error> {
    match command {
        Command::Render(flags) => render::run(flags),
        Command::Merge(flags) => merge::run(flags),
        Command::Figures(flags) => crate::figures::run(flags),
    }
}
