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
use std::io::{self, Write as _};

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

/// Prints lines on standard output. Ignores a closed pipe, as in `hairis-render render head | true`,
/// because all results are in files.
pub(crate) fn print(lines: &str) -> Result<(), Error> {
    let mut out = io::stdout().lock();
    match out.write_all(lines.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Error::Write(error)),
        _ => Ok(()),
    }
}
