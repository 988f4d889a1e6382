//! Entry point of a command-line program: flags, help, errors and exit codes.

use crate::error::Error;
use clap::Parser;
use std::io::{self, Write};
use std::process::ExitCode;

/// Parses the command line and calls `work`. Prints an error as one line on standard error, after `name`, and returns its exit
/// code.
///
/// If help or the version is asked for, prints that and succeeds without calling `work`.
pub fn run<F: Parser>(name: &str, work: impl FnOnce(&F) -> Result<(), Error>) -> ExitCode {
    match flags().and_then(|flags| flags.map_or(Ok(()), |flags| work(&flags))) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            say(&format!("{name}: {error}"));
            ExitCode::from(error.exit_code())
        }
    }
}

/// The flags; `None` after printing the help or the version.
fn flags<F: Parser>() -> Result<Option<F>, Error> {
    match F::try_parse() {
        Ok(flags) => Ok(Some(flags)),
        Err(error) if error.use_stderr() => Err(Error::Usage(one_line(&error.to_string()))),
        Err(help) => {
            // Ignore a closed pipe, as in `hairis --help | head -1`.
            let _ = help.print();
            Ok(None)
        }
    }
}

/// The first paragraph of clap's message, in one line; the usage that follows it is left to `--help`.
fn one_line(message: &str) -> String {
    let first = message.split("\n\n").next().unwrap_or(message);
    let words: Vec<&str> = first.split_whitespace().collect();
    let line = words.join(" ");
    format!(
        "{} (see --help)",
        line.strip_prefix("error: ").unwrap_or(&line)
    )
}

/// Prints a line on standard error. Ignores write errors.
pub fn say(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}
