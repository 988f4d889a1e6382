//! Command `hairis-render`; everything else is in the library.

use hairis_instruments::program;
use hairis_render::args::{Args, ENTRANCE};
use hairis_render::cmd;
use std::process::ExitCode;

fn main() -> ExitCode {
    program::run("hairis-render", Some(ENTRANCE), |args: &Args| {
        cmd::run(&args.command)
    })
}
