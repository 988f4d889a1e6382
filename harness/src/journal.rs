//! Figures that a run has found so far, kept in a file so that a killed run continues from them.
//!
//! Each line has the bits of some numbers, their key and a checksum. The name of the file has a digest of everything that the numbers
//! depend on, and its first line spells that out, so that a run with other settings has another file.

use crate::sealed::{checksum, line, unseal};
use hairis_instruments::appended::Appended;
use hairis_instruments::error::Error;
use hairis_instruments::interrupt::Interrupt;
use hairis_instruments::program::say;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fs;
use std::path::Path;

/// Figures by key, kept in a file if there is one. Without a file, a journal holds no earlier figures.
#[derive(Debug, Default)]
pub struct Journal {
    file: Option<Appended>,
    found: HashMap<String, Vec<u64>>,
    interrupt: Interrupt,
}

/// Line of the file.
#[derive(Serialize, Deserialize)]
struct Entry {
    key: String,
    /// Bit patterns of the numbers.
    bits: Vec<u64>,
}

/// First line of the file, with the settings of the run.
#[derive(Serialize)]
struct Header<'a, S> {
    format: &'static str,
    settings: &'a S,
}

impl Journal {
    /// Opens the figures `NAME-DIGEST.part` in a folder, for a run with these settings that `interrupt` may end.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Output`] if the file cannot be written, and [`Error::Part`] if another process is writing to it.
    pub fn open(
        dir: &Path,
        name: &str,
        settings: &impl Serialize,
        interrupt: Interrupt,
    ) -> Result<Self, Error> {
        let header = Header {
            format: "hairis-figures-1",
            settings,
        };
        let first = line(&header).map_err(Error::output(dir))?;
        let path = dir.join(format!("{name}-{}.part", checksum(&first)));
        let file = Appended::open(&path)?;
        let bytes = fs::read(&path).map_err(Error::output(&path))?;
        let whole = bytes
            .iter()
            .rposition(|byte| *byte == b'\n')
            .map_or(0, |last| last + 1);
        let (mut found, mut damaged) = (HashMap::new(), 0);
        match bytes[..whole].strip_prefix(&first[..]) {
            Some(lines) => {
                file.cut(whole)?;
                for line in lines.split_inclusive(|byte| *byte == b'\n') {
                    match entry(line) {
                        Some(Entry { key, bits }) => drop(found.insert(key, bits)),
                        None => damaged += 1,
                    }
                }
            }
            None => {
                damaged = usize::from(whole > 0);
                file.cut(0)?;
                file.append(&first)?;
            }
        }
        if damaged > 0 {
            say(&format!(
                "{}: {damaged} damaged lines; computed again",
                path.display()
            ));
        }
        if !found.is_empty() {
            let count = found.len();
            say(&format!(
                "{}: continues after {count} figures",
                path.display()
            ));
        }
        Ok(Self {
            file: Some(file),
            found,
            interrupt,
        })
    }

    /// Returns true if an earlier run has found the numbers of a key.
    #[must_use]
    pub fn has(&self, key: &str) -> bool {
        self.found.contains_key(key)
    }

    /// Returns the numbers of a key, bit for bit as an earlier run has found them. If there are none, computes them with `find` and appends
    /// them to the file, if there is one.
    ///
    /// # Errors
    ///
    /// Returns the errors of `find`, [`Error::Output`] if the numbers cannot be kept, and [`Error::Interrupted`] after a signal.
    pub fn numbers<const N: usize, E>(
        &self,
        key: &str,
        find: impl FnOnce() -> Result<[f64; N], E>,
    ) -> Result<[f64; N], Error>
    where
        Error: From<E>,
    {
        let found = self
            .found
            .get(key)
            .and_then(|bits| bits.as_slice().try_into().ok());
        if let Some(bits) = found {
            return Ok(<[u64; N]>::map(bits, f64::from_bits));
        }
        self.check()?;
        let numbers = find()?;
        if let Some(file) = &self.file {
            let entry = Entry {
                key: key.to_owned(),
                bits: numbers.map(f64::to_bits).to_vec(),
            };
            file.append(&line(&entry).map_err(Error::output(file.path()))?)?;
        }
        Ok(numbers)
    }

    /// Returns an error if a signal has requested the end of the run, so that its caller stops.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Interrupted`] after a signal.
    pub fn check(&self) -> Result<(), Error> {
        self.interrupt.check(|| {
            let path = self.file.as_ref().map(Appended::path);
            format!(
                "the figures so far are in {}; the same command goes on from there",
                path.unwrap_or(Path::new("memory")).display()
            )
        })
    }

    /// Removes the file of a run whose results are written.
    pub fn remove(self) {
        if let Some(file) = self.file {
            // An error is ignored, because a file that is gone need not be removed.
            let _ = fs::remove_file(file.path());
        }
    }
}

fn entry(line: &[u8]) -> Option<Entry> {
    let (content, is_right) = unseal(line.strip_suffix(b"\n")?)?;
    serde_json::from_slice(&content).ok().filter(|_| is_right)
}
