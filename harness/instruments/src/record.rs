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

/// Returns the first numbers after `key` in the first line of a record that begins with it.
///
/// # Panics
///
/// Panics if the record has no such line, or if it has fewer numbers there.
#[must_use]
pub fn numbers<const N: usize>(record: &str, key: &str) -> [f64; N] {
    let mut lines = record.lines();
    let row = lines.find_map(|line| line.strip_prefix(key));
    let mut fields = row.unwrap_or_default().split(',');
    core::array::from_fn(|_| {
        let number = fields.next().and_then(|field| field.parse().ok());
        number.unwrap_or_else(|| panic!("the record must have {N} numbers after {key}: {row:?}"))
    })
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
