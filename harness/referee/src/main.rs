//! Command `hairis-referee`, which `hairis referee` starts; all of its functions are in the library.

use std::process::ExitCode;

fn main() -> ExitCode {
    hairis_program::program::run("hairis", None, hairis_referee::run)
}
