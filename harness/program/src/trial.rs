//! Runs of a program, as its tests start it: with input, exit code and lines.

use serde_json::Value;
use std::fs::{self, DirEntry};
use std::io::{self, Write};
use std::path::Path;
#[cfg(unix)]
use std::process::Child;
use std::process::{Command, Output, Stdio};
use std::thread;

/// Result of a run of a program.
#[derive(Clone, Debug)]
pub struct Run {
    /// Exit code, or `None` if a signal has ended the program.
    pub code: Option<i32>,
    /// Lines of standard output.
    pub out: Vec<String>,
    /// Lines of standard error.
    pub err: Vec<String>,
}

/// Returns the command of a program with these arguments, whose input and outputs are pipes.
#[must_use]
pub fn command(program: &str, args: &[&str]) -> Command {
    let mut command = Command::new(program);
    command
        .args(args)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

impl Run {
    /// Executes a command of [`command`] with this input, and waits for its end.
    ///
    /// # Errors
    ///
    /// Returns an error if the program does not start.
    ///
    /// # Panics
    ///
    /// Panics if an output is not UTF-8.
    pub fn of(command: &mut Command, input: &[u8]) -> io::Result<Self> {
        let mut child = command.spawn()?;
        let stdin = child.stdin.take();
        thread::scope(|scope| {
            // A run that rejects its flags reads nothing, and then the rest of the input is lost.
            scope.spawn(move || stdin.map(|mut stdin| stdin.write_all(input)));
            child.wait_with_output().map(Self::from)
        })
    }

    /// Returns the lines of standard output as JSON.
    ///
    /// # Panics
    ///
    /// Panics if a line is not JSON.
    #[must_use]
    pub fn json(&self) -> Vec<Value> {
        let parsed = |line: &String| serde_json::from_str(line).expect("JSON");
        self.out.iter().map(parsed).collect()
    }

    /// Sends a signal, such as `TERM`, to a process, and waits for the process to end.
    ///
    /// # Errors
    ///
    /// Returns an error if the process has ended before, or cannot be waited for.
    ///
    /// # Panics
    ///
    /// Panics if an output is not UTF-8.
    #[cfg(unix)]
    pub fn end(child: Child, signal: &str) -> io::Result<Self> {
        let sent = Command::new("kill")
            .args([format!("-{signal}"), child.id().to_string()])
            .status()?;
        if !sent.success() {
            return Err(io::Error::other("the process has ended before the signal"));
        }
        child.wait_with_output().map(Self::from)
    }
}

impl From<Output> for Run {
    fn from(output: Output) -> Self {
        let lines = |bytes: Vec<u8>| {
            let text = String::from_utf8(bytes).expect("text in UTF-8");
            text.lines().map(str::to_owned).collect()
        };
        Self {
            code: output.status.code(),
            out: lines(output.stdout),
            err: lines(output.stderr),
        }
    }
}

/// Returns the names of the files in a folder, sorted.
///
/// # Panics
///
/// Panics if the folder cannot be read, or has a name that is not UTF-8.
#[must_use]
pub fn names(dir: &Path) -> Vec<String> {
    let entries = fs::read_dir(dir).expect("a folder");
    let name = |entry: io::Result<DirEntry>| entry.expect("an entry").file_name();
    let mut names: Vec<_> = entries
        .map(|entry| name(entry).into_string().expect("a name in UTF-8"))
        .collect();
    names.sort();
    names
}
