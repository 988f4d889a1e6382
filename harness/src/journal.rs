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

#[cfg(test)]
mod tests {
    use super::*;
    use hairis_instruments::interrupt::Signal;
    use std::path::PathBuf;

    const ODD: [f64; 4] = [-0.0, f64::NAN, f64::INFINITY, 0.1 + 0.2];

    fn open(dir: &tempfile::TempDir, seed: u64) -> Journal {
        Journal::open(dir.path(), "claims", &seed, Interrupt::default()).expect("a file")
    }

    /// Returns the numbers, and whether `find` was called.
    fn get(journal: &Journal, key: &str) -> ([u64; 4], bool) {
        let mut is_new = false;
        let find = || {
            is_new = true;
            Ok::<_, Error>(ODD)
        };
        let numbers = journal.numbers(key, find).expect("kept");
        (numbers.map(f64::to_bits), is_new)
    }

    fn only_file(dir: &tempfile::TempDir) -> PathBuf {
        let mut files = fs::read_dir(dir.path()).expect("a folder");
        files.next().expect("a file").expect("read").path()
    }

    #[test]
    fn numbers_come_back_bit_for_bit_from_any_byte() {
        let dir = tempfile::TempDir::new().expect("a folder");
        let bits = ODD.map(f64::to_bits);
        let journal = open(&dir, 1);
        assert_eq!([get(&journal, "a"), get(&journal, "b")], [(bits, true); 2]);
        let other = open(&dir, 2);
        assert_eq!(get(&other, "a"), (bits, true), "other settings");
        other.remove();
        drop(journal);
        let (path, whole) = (only_file(&dir), fs::read(only_file(&dir)).expect("read"));
        let lines: Vec<&[u8]> = whole.split_inclusive(|byte| *byte == b'\n').collect();
        for cut in 0..=whole.len() {
            fs::write(&path, &whole[..cut]).expect("written");
            let journal = open(&dir, 1);
            let first = lines[0].len() + lines[1].len();
            assert_eq!(get(&journal, "a"), (bits, cut < first), "cut at {cut}");
            assert_eq!(
                get(&journal, "b"),
                (bits, cut < whole.len()),
                "cut at {cut}"
            );
            drop(journal);
            assert!(fs::read(&path).expect("read") == whole, "cut at {cut}");
        }
        let mut damaged = whole.clone();
        damaged[lines[0].len() + 20] ^= 1;
        fs::write(&path, &damaged).expect("written");
        let journal = open(&dir, 1);
        assert_eq!([get(&journal, "a").1, get(&journal, "b").1], [true, false]);
        journal.remove();
        assert!(!path.exists());
    }

    #[test]
    fn a_signal_ends_the_run_and_what_it_found_stays() {
        let dir = tempfile::TempDir::new().expect("a folder");
        let interrupt = Interrupt::default();
        let journal = Journal::open(dir.path(), "claims", &1, interrupt.clone()).expect("a file");
        get(&journal, "a");
        interrupt.raise(Signal::Interrupt);
        let find = || -> Result<[f64; 1], Error> { unreachable!("no further figure is begun") };
        let error = journal.numbers("b", find).expect_err("a signal");
        assert_eq!(error.exit_code(), 130);
        assert!(error.to_string().contains("claims-"), "{error}");
        drop(journal);
        assert!(!get(&open(&dir, 1), "a").1);
    }
}
