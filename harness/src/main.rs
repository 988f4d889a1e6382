//! Command `hairis`; all of its functions are in the library.

use hairis_harness::args::{Args, ENTRANCE};
use hairis_harness::cmd;
use hairis_instruments::program;
use std::process::ExitCode;

fn main() -> ExitCode {
    program::run("hairis", Some(ENTRANCE), |args: &Args| {
        cmd::run(&args.command)
    })
}
