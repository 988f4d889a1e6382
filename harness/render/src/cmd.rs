//! The subcommands.

mod merge;
mod render;

pub(crate) use render::environment;

use crate::args::{Args, Command};
use hairis_harness::error::Error;

/// Runs a subcommand.
///
/// # Errors
///
/// Errors of the subcommand.
pub fn run(args: Args) -> Result<(), Error> {
    match args.command {
        Command::Render(flags) => render::run(&flags),
        Command::Merge(flags) => merge::run(&flags),
        Command::Figures(flags) => crate::figures::run(&flags),
    }
}
