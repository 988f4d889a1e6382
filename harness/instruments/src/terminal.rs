//! Terminal that output is read on: its width, text broken to it, and the end of a command.

use crate::error::Error;
use crate::program::{print, say};
use crate::report::Report;
use crate::table::Table;
use std::io::{self, Write as _, stderr, stdout};
use terminal_size::{Width, terminal_size_of};

pub use crate::wrap::wrapped;

/// Width of text where no terminal says otherwise, and the largest in any, in columns.
pub const WIDTH: usize = 100;

/// Returns the columns of the terminal that standard output is shown on, or none if it is no terminal.
#[must_use]
pub fn columns() -> Option<u16> {
    terminal_size_of(stdout()).map(|(Width(columns), _)| columns)
}

/// Returns the width of sentences on standard output or, if that is no terminal, on standard error: that of the terminal, and at most
/// [`WIDTH`].
#[must_use]
pub fn width() -> usize {
    let size = terminal_size_of(stdout()).or_else(|| terminal_size_of(stderr()));
    size.map_or(WIDTH, |(Width(columns), _)| usize::from(columns).min(WIDTH))
}

/// Ends a command with the head of its report on standard output. If `tables` are given, these are standard output, as wide as the
/// terminal or as plain text, and the head goes to standard error. If the reader closes the pipe early, names the file that has the tables.
///
/// # Errors
///
/// Returns [`Error::Write`] for every failure other than a closed pipe.
pub fn conclude(report: &Report, files: &str, tables: Option<&[Table]>) -> Result<(), Error> {
    let head = report.headline(width(), files);
    let Some(tables) = tables else {
        return print(head);
    };
    print_tables(tables, files)?;
    eprint!("{head}");
    Ok(())
}

/// Prints tables on standard output. If the reader closes the pipe early, says on standard error which files have them.
///
/// # Errors
///
/// Returns [`Error::Write`] for every failure other than a closed pipe.
fn print_tables(tables: &[Table], files: &str) -> Result<(), Error> {
    let mut out = stdout().lock();
    for table in tables {
        let text = table.to_text(columns());
        match writeln!(out, "{text}").and_then(|()| out.flush()) {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {
                say(&format!(
                    "standard output was closed; the tables are in {files}"
                ));
                return Ok(());
            }
            result => result.map_err(Error::Write)?,
        }
    }
    Ok(())
}
