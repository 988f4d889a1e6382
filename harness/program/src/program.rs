//! Entry points of command-line programs: flags, help, errors and exit codes.

use crate::error::Error;
use clap::{ArgMatches, Command, Parser};
use core::num::NonZero;
use std::ffi::OsStr;
use std::io::{self, Write};
use std::process::ExitCode;
use std::{env, thread};

/// Environment variable that sets the number of threads of rayon.
const THREADS: &str = "RAYON_NUM_THREADS";

/// Parses the command line and calls `work`. Prints an error as one line on standard error, after `name`, and returns its exit code.
///
/// If the command line asks for help or the version, prints that and succeeds without calling `work`. An empty command line asks for
/// `entrance`, if there is one: what the program can do, and what to try.
pub fn run<F: Parser>(
    name: &str,
    entrance: Option<&str>,
    work: impl FnOnce(&F) -> Result<(), Error>,
) -> ExitCode {
    let result = match entrance {
        Some(text) if env::args_os().len() < 2 => print(text),
        _ => asked(work),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            say(&format!("{name}: {error}"));
            ExitCode::from(error.exit_code())
        }
    }
}

/// Parses the flags and calls `work` with them, unless they ask for help.
fn asked<F: Parser>(work: impl FnOnce(&F) -> Result<(), Error>) -> Result<(), Error> {
    flags()?.map_or(Ok(()), |flags| work(&flags))
}

/// Parses the flags; returns `None` after printing the help or the version.
fn flags<F: Parser>() -> Result<Option<F>, Error> {
    match matches(F::command()).and_then(|matches| F::from_arg_matches(&matches)) {
        Ok(flags) => Ok(Some(flags)),
        Err(error) if error.use_stderr() => Err(Error::Usage(one_line(&error.to_string()))),
        Err(help) => {
            // Ignore a closed pipe, as in `hairis --help | head -1`.
            let _ = help.print();
            Ok(None)
        }
    }
}

/// Parses the words of the command line. A negative number counts as the value of the flag before it, which may reject it, and not as a
/// flag.
fn matches(command: Command) -> Result<ArgMatches, clap::Error> {
    let with_numbers = |command: Command| {
        command.mut_args(|arg| {
            let takes_values = arg.get_action().takes_values();
            arg.allow_negative_numbers(takes_values)
        })
    };
    with_numbers(command)
        .mut_subcommands(with_numbers)
        .try_get_matches()
}

/// Returns the first paragraph of clap's message in one line, with the name that it takes for the one that was meant. The usage that
/// follows is left to `--help`.
fn one_line(message: &str) -> String {
    let in_one = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut parts = message.split("\n\n").map(in_one);
    let first = parts.next().unwrap_or_default();
    let line = first.strip_prefix("error: ").unwrap_or(&first);
    let tip = parts.find_map(|part| Some(format!("; {}", part.strip_prefix("tip: ")?)));
    format!("{line}{} (see --help)", tip.unwrap_or_default())
}

/// Prints a remark if the number of threads in the variable `RAYON_NUM_THREADS` is not a number, or exceeds the number of cores.
/// Programs with parallel work call this first.
pub fn check_threads() {
    let cores = thread::available_parallelism().map_or(1, NonZero::get);
    let wanted = env::var_os(THREADS);
    if let Some(remark) = wanted.and_then(|wanted| remark_on_threads(&wanted, cores)) {
        say(&remark);
    }
}

/// Returns the remark on a value of the variable `RAYON_NUM_THREADS` on a machine with so many cores, or `None` if the value is not odd. A value of 0 is rayon's default, as if the
/// variable were not set.
#[must_use]
pub fn remark_on_threads(wanted: &OsStr, cores: usize) -> Option<String> {
    let count = wanted.to_str().and_then(|text| text.parse::<usize>().ok());
    match count {
        None => Some(format!(
            "{THREADS} must be a whole number of threads, got {wanted:?}: using {cores}, one per core"
        )),
        Some(count) if count > cores => Some(format!(
            "{THREADS} should be at most {cores}, the cores that this process may use, got {count}: threads will share cores"
        )),
        Some(_) => None,
    }
}

/// Prints a text on standard output. A reader that closes the pipe early, as `head` does, is not an error.
///
/// # Errors
///
/// Returns [`Error::Write`] for every failure other than a closed pipe.
pub fn print(text: impl AsRef<[u8]>) -> Result<(), Error> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_ref()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Error::Write(error)),
        _ => Ok(()),
    }
}

/// Prints a line on standard error and ignores write errors. Control characters, which names of files may contain, are escaped.
pub fn say(line: &str) {
    let mut text = String::new();
    for character in line.chars() {
        if character.is_control() {
            text.extend(character.escape_default());
        } else {
            text.push(character);
        }
    }
    let _ = writeln!(io::stderr(), "{text}");
}
