//! Records of measurements on a machine: tables with what they depend on.

use crate::machine::Machine;
use std::io;
use std::path::Path;
use std::process::Command;

/// Returns true if a test that measures is to write its record: with `HAIRIS_RECORD=write` in the environment.
#[must_use]
pub fn is_asked() -> bool {
    std::env::var("HAIRIS_RECORD").is_ok_and(|word| word == "write")
}

/// Returns the numbers that follow `key` in the first line of a record that begins with it: all fields that are numbers, in their order.
#[must_use]
pub fn numbers(record: &str, key: &str) -> Option<Vec<f64>> {
    let fields = record.lines().find_map(|line| line.strip_prefix(key))?;
    Some(fields.split(',').filter_map(|x| x.parse().ok()).collect())
}

/// Writes a record: the processor, the commit, the date, what the rows are `about`, the names of the columns, and the rows.
///
/// # Errors
///
/// Returns an error if the system tells no date, or if the file cannot be written.
pub fn write(
    path: &Path,
    machine: &Machine,
    about: &str,
    columns: &str,
    rows: &[String],
) -> io::Result<()> {
    let date = Command::new("date").arg("-I").output()?;
    let text = format!(
        "# CPU: {}\n# commit: {:.8}\n# date: {}# {about}\n{columns}\n{}\n",
        machine.cpu,
        machine.commit,
        String::from_utf8_lossy(&date.stdout),
        rows.join("\n")
    );
    std::fs::write(path, text)
}
