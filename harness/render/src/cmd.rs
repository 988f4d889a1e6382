//! The subcommands.

mod fit;
mod merge;
mod place;
mod render;

pub(crate) use place::environment;
pub(crate) use render::picture_size;

use crate::args::Command;
use hairis_instruments::error::Error;
use hairis_instruments::program::check_threads;

/// Runs a subcommand.
///
/// # Errors
///
/// Errors of the subcommand.
pub fn run(command: &Command) -> Result<(), Error> {
    check_threads();
    match command {
        Command::Render(flags) => render::run(flags),
        Command::Merge(flags) => merge::run(flags),
        Command::Figures(flags) => crate::figures::run(flags),
        Command::Fit(flags) => fit::run(flags),
    }
}
