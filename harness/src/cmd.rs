//! Subcommands of `hairis`, one per file, and the helpers that they share.

pub mod claims;
pub mod compare;
pub mod eval;
pub mod fit;
pub mod merge;
pub mod shader;
pub mod study;

use crate::args::Command;
use hairis_instruments::error::Error;
use hairis_instruments::light::{Environment, LightError, Sky};
use hairis_instruments::program::{check_threads, say};
use hairis_instruments::table::Table;
use std::io::{self, Write};
use std::path::Path;

/// Executes a command with its flags.
///
/// # Errors
///
/// Returns an [`Error`] if the command was stopped, or if a check failed.
pub fn run(command: &Command) -> Result<(), Error> {
    if !matches!(command, Command::Eval(_) | Command::Shader(_)) {
        check_threads();
    }
    match command {
        Command::Eval(flags) => eval::run(flags),
        Command::Compare(flags) => compare::run(flags),
        Command::Study(flags) => study::run(flags),
        Command::Claims(flags) => claims::run(flags),
        Command::Merge(flags) => merge::run(flags),
        Command::Shader(flags) => shader::run(flags),
        Command::Fit(flags) => fit::run(flags),
    }
}

/// Loads the environment from a file, or a layer of the file, and returns it with its name in reports; without a file, returns the
/// procedural sky. Oddities of the file are reported on standard error. A map without light is an error.
fn environment(path: Option<&Path>, layer: Option<&str>) -> Result<(Environment, String), Error> {
    let Some(path) = path else {
        return Ok((Sky::default().environment(), "procedural sky".to_owned()));
    };
    let environment = Environment::load_layer(path, layer).map_err(Error::Environment)?;
    if environment.is_black() {
        return Err(Error::Environment(LightError::black(
            path,
            environment.repairs(),
        )));
    }
    environment.notes().iter().for_each(|note| say(note));
    Ok((environment, path.display().to_string()))
}

/// Prints tables on standard output. If the reader closes the pipe early, names the file that has the tables on standard error.
fn print_tables<'a>(tables: impl Iterator<Item = &'a Table>, file: &Path) -> Result<(), Error> {
    let mut out = io::stdout().lock();
    for table in tables {
        match writeln!(out, "{}", table.to_text(None)).and_then(|()| out.flush()) {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {
                say(&format!(
                    "standard output was closed; the tables are in {}",
                    file.display()
                ));
                return Ok(());
            }
            result => result.map_err(Error::Write)?,
        }
    }
    Ok(())
}

/// Reports the failures on standard error, and returns an error if there are any.
fn report_failures(failures: &[String]) -> Result<(), Error> {
    failures
        .iter()
        .for_each(|failure| say(&format!("failed: {failure}")));
    if failures.is_empty() {
        Ok(())
    } else {
        Err(Error::Failed(failures.len()))
    }
}
