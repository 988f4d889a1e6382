//! The binary: flags in, exit code out.

use hairis_render::{args, cmd};
use std::process::ExitCode;

fn main() -> ExitCode {
    let result = args::parse().and_then(|args| args.map_or(Ok(()), cmd::run));
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("hairis-render: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}
