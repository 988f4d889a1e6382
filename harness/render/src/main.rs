//! Command `hairis-render`; everything else is in the library.

use hairis_instruments::program;
use hairis_render::args::Args;
use hairis_render::cmd;
use std::process::ExitCode;

fn main() -> ExitCode {
    program::run("hairis-render", |args: &Args| cmd::run(&args.command))
}
