//! Subcommands of `hairis-render`, which turn flags into pictures, tables and pages.

mod fit;
mod merge;
mod place;
mod render;

use crate::args::Command;
use hairis_instruments::error::Error;
use hairis_instruments::program::check_threads;

/// Runs a subcommand of `hairis-render` with the flags that were given.
///
/// # Errors
///
/// Returns the error of the subcommand, such as a flag out of its range or a file that cannot be written.
pub fn run(command: &Command) -> Result<(), Error> {
    check_threads();
    match command {
        Command::Render(flags) => render::run(flags),
        Command::Merge(flags) => merge::run(flags),
        Command::Figures(flags) => crate::figures::run(flags),
        Command::Fit(flags) => fit::run(flags),
    }
}
