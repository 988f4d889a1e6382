//! Command `hairis-study`, which `hairis study`, `merge`, `claims` and `fit` start; all of its functions are in the library.

use hairis_instruments::program;
use hairis_study::args::Args;
use hairis_study::cmd;
use std::process::ExitCode;

fn main() -> ExitCode {
    program::run("hairis", None, |args: &Args| cmd::run(&args.command))
}
