//! Subcommands that are programs of their own, which `hairis` finds and starts.

use crate::args::Words;
use hairis_instruments::error::Error;
use std::env::{self, consts::EXE_SUFFIX};
use std::io::ErrorKind;
use std::path::PathBuf;
use std::process::Command;

/// Program that executes subcommands of `hairis`.
pub(super) struct Other {
    /// Name of the program and of its package.
    name: &'static str,
    /// Folder of the package in the repository.
    folder: &'static str,
}

/// Program of `study`, `merge`, `claims` and `fit`.
pub(super) const STUDY: Other = Other {
    name: "hairis-study",
    folder: "harness/study",
};

/// Program of `shader`.
pub(super) const SHADER: Other = Other {
    name: "hairis-shader",
    folder: "harness/shader",
};

/// Program of `referee`.
pub(super) const REFEREE: Other = Other {
    name: "hairis-referee",
    folder: "harness/referee",
};

impl Other {
    /// Starts the program with the words of the command line, after `subcommand` if the program has several. Ends with the exit code of
    /// the program; on Unix the program takes the place of this process.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Usage`] if the program is missing or does not start.
    pub(super) fn run(&self, subcommand: Option<&str>, words: &Words) -> Result<(), Error> {
        let mut command = Command::new(self.path());
        command.args(subcommand).args(&words.words);
        let Err(error) = become_process(&mut command);
        let Self { name, folder } = self;
        Err(Error::Usage(if error.kind() == ErrorKind::NotFound {
            let again = subcommand.map_or(String::new(), |word| format!("{word} "));
            format!(
                "the program {name} is neither beside hairis nor on PATH; run `cargo install --path {folder}`, or in a clone \
                 `cargo run --release -p {name} -- {again}...`"
            )
        } else {
            format!("cannot start {}: {error}", self.path().display())
        }))
    }

    /// Returns the path of the program beside this one, or else its name, which is looked for on PATH.
    fn path(&self) -> PathBuf {
        let file = format!("{}{EXE_SUFFIX}", self.name);
        let beside = env::current_exe().map(|this| this.with_file_name(&file));
        match beside {
            Ok(path) if path.is_file() => path,
            _ => file.into(),
        }
    }
}

/// Replaces this process by a program; returns only if the program does not start.
#[cfg(unix)]
fn become_process(command: &mut Command) -> Result<core::convert::Infallible, std::io::Error> {
    use std::os::unix::process::CommandExt as _;
    Err(command.exec())
}

/// Waits for a program and ends with its exit code; returns only if the program does not start.
#[cfg(not(unix))]
fn become_process(command: &mut Command) -> Result<core::convert::Infallible, std::io::Error> {
    let status = command.status()?;
    std::process::exit(status.code().unwrap_or(2))
}
