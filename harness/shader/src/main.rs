//! Command `hairis-shader`, which `hairis shader` starts; all of its functions are in the library.

use hairis_program::program;
use std::process::ExitCode;

fn main() -> ExitCode {
    program::run("hairis", None, hairis_shader::run)
}
