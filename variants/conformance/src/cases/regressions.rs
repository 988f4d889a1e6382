//! Seeds of cases that have failed, which are kept in the tree of the package under test.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Regressions of one test: lines `cc SEED TEST PROPERTY` of a file, each below the code of its smallest case.
#[derive(Clone, Debug)]
pub struct Regressions {
    file: PathBuf,
    test: &'static str,
}

impl Regressions {
    pub(super) fn new(package: &str, test: &'static str) -> Self {
        let file = Path::new(package).join("proptest-regressions/conformance.txt");
        Self { file, test }
    }

    /// Returns the seeds of a property.
    ///
    /// # Panics
    ///
    /// Panics if a line of the file is not a seed.
    pub(super) fn seeds(&self, property: &str) -> Vec<u64> {
        let text = fs::read_to_string(&self.file).unwrap_or_default();
        let lines = text.lines().filter_map(|line| line.strip_prefix("cc "));
        let seed = |line: &str| {
            let [seed, test, name] = line.split(' ').collect::<Vec<_>>()[..] else {
                panic!(
                    "{:?}: must be \"cc SEED TEST PROPERTY\", got {line:?}",
                    self.file
                )
            };
            let seed = u64::from_str_radix(seed, 16);
            let seed = seed.unwrap_or_else(|error| panic!("{:?}: {line:?}: {error}", self.file));
            (test == self.test && name == property).then_some(seed)
        };
        lines.filter_map(seed).collect()
    }

    /// Adds the seed of a failure, unless the file already has it. A file that cannot be written stays as it is.
    pub(super) fn add(&self, property: &str, seed: u64, code: &str) {
        if self.seeds(property).contains(&seed) {
            return;
        }
        let comment: String = code.lines().map(|line| format!("# {line}\n")).collect();
        let text = format!("{comment}cc {seed:016x} {} {property}\n", self.test);
        let _ = self.file.parent().map(fs::create_dir_all);
        let written = fs::OpenOptions::new()
            .create(true)
            .append(true)
            .open(&self.file);
        let written = written.and_then(|mut file| file.write_all(text.as_bytes()));
        match written {
            Ok(()) => println!("kept in {}", self.file.display()),
            Err(error) => println!("{}: {error}", self.file.display()),
        }
    }
}
