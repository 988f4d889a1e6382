//! The command line `hairis`: parse, dispatch, exit code. All else is in the library.

use hairis_harness::error::Error;
use hairis_harness::{args, cmd};
use std::io::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // The one place that prints an error. Ignore write errors.
            let _ = writeln!(std::io::stderr(), "hairis: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn run() -> Result<(), Error> {
    match args::parse()? {
        Some(args) => cmd::run(&args.command),
        None => Ok(()),
    }
}
