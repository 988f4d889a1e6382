//! Subcommands of `hairis`, one per file, and the helpers that they share. Some are programs of their own, which are found and started.

pub mod compare;
pub mod eval;
mod other;

use crate::args::Command;
use hairis_instruments::error::Error;
use hairis_instruments::light::{Environment, LightError, Sky};
use hairis_instruments::program::{check_threads, say};
use std::path::Path;

/// Executes a command with its flags.
///
/// # Errors
///
/// Returns an [`Error`] if the command was stopped, or if a check failed.
pub fn run(command: &Command) -> Result<(), Error> {
    match command {
        Command::Eval(flags) => eval::run(flags),
        Command::Compare(flags) => {
            check_threads();
            compare::run(flags)
        }
        Command::Study(words) => other::STUDY.run(Some("study"), words),
        Command::Claims(words) => other::STUDY.run(Some("claims"), words),
        Command::Merge(words) => other::STUDY.run(Some("merge"), words),
        Command::Fit(words) => other::STUDY.run(Some("fit"), words),
        Command::Referee(words) => other::REFEREE.run(None, words),
        Command::Shader(words) => other::SHADER.run(None, words),
    }
}

/// Loads the environment from a file, or a layer of the file, and returns it with its name in reports; without a file, returns the
/// procedural sky. Oddities of the file are reported on standard error.
///
/// # Errors
///
/// Returns [`Error::Environment`] if the file cannot be read, or if its map gives no light.
pub fn environment(
    path: Option<&Path>,
    layer: Option<&str>,
) -> Result<(Environment, String), Error> {
    let Some(path) = path else {
        return Ok((Sky::default().environment(), "procedural sky".to_owned()));
    };
    let environment = Environment::load_layer(path, layer)?;
    if environment.is_black() {
        return Err(LightError::black(path, environment.repairs()).into());
    }
    environment.notes().iter().for_each(|note| say(note));
    Ok((environment, path.display().to_string()))
}

/// Reports the failures on standard error, and returns an error if there are any.
///
/// # Errors
///
/// Returns [`Error::Failed`] with their number.
pub fn report_failures(failures: &[String]) -> Result<(), Error> {
    failures
        .iter()
        .for_each(|failure| say(&format!("failed: {failure}")));
    if failures.is_empty() {
        Ok(())
    } else {
        Err(Error::Failed(failures.len()))
    }
}
