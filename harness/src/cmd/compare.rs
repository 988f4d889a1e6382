//! `hairis compare`: runs the comparison, prints its tables, and writes `compare.json`, `report.html` and
//! `figures/`.

use crate::cmd::{environment, print_tables};
use crate::compare::{self, CompareConfig, Comparison, Depth};
use crate::config::Compare;
use crate::error::Error;
use crate::files::{whole, writable};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Mutex;

/// Runs the comparison.
///
/// # Errors
///
/// [`Error::Environment`] and [`Error::Output`] before any work is done, if a file cannot be read or the folder cannot
/// be written; [`Error::Failed`] at the end, with all files written, if a check failed.
pub fn run(config: &Compare) -> Result<(), Error> {
    let (environment, name) = environment(config.env.as_deref())?;
    fs::create_dir_all(&config.out).map_err(|source| output(&config.out, source))?;
    let [json_path, page_path] = ["compare.json", "report.html"].map(|name| config.out.join(name));
    for path in [&json_path, &page_path] {
        writable(path)?;
    }

    let bar = Bar::new();
    let settings =
        CompareConfig { seed: config.seed, quick: config.quick, environment: &environment, environment_name: &name };
    let comparison = compare::run(&settings, &|part, done| bar.show(part, done)).map_err(Error::Params)?;
    bar.finish();

    write_json(&json_path, &comparison)?;
    compare::report(&comparison).write(&config.out, "compare")?;
    print(&comparison, &page_path)?;
    let failures = comparison.failures();
    let mut said = format!("wrote {} and {}\n", page_path.display(), json_path.display());
    for failure in &failures {
        said.push_str(&format!("failed: {failure}\n"));
    }
    // Ignore write errors.
    let _ = io::stderr().write_all(said.as_bytes());
    if failures.is_empty() { Ok(()) } else { Err(Error::Failed(failures.len())) }
}

pub(super) fn output(path: &Path, source: io::Error) -> Error {
    Error::Output { path: path.to_owned(), source }
}

/// Writes a JSON file, as a whole or not at all.
pub(super) fn write_json(path: &Path, results: &impl Serialize) -> Result<(), Error> {
    whole(path, |out| {
        serde_json::to_writer_pretty(&mut *out, results)?;
        out.write_all(b"\n")
    })
}

/// The tables on standard output.
fn print(comparison: &Comparison, page: &Path) -> Result<(), Error> {
    let tables = compare::tables(comparison, Depth::Summary);
    print_tables(tables.speed.iter().chain(&tables.agreement).chain(&tables.efficiency).chain(&tables.rays), page)
}

/// Progress bars, one per part, on standard error; nothing where that is no terminal.
struct Bar(Mutex<(ProgressBar, Option<&'static str>)>);

impl Bar {
    fn new() -> Self {
        let bar = ProgressBar::new(1000);
        if let Ok(style) = ProgressStyle::with_template("{msg:>18} {wide_bar} {percent:>3}% {elapsed} (left {eta})") {
            bar.set_style(style);
        }
        Self(Mutex::new((bar, None)))
    }

    fn show(&self, part: &'static str, done: f64) {
        let Ok(mut state) = self.0.lock() else { return };
        if state.1 != Some(part) {
            state.0.reset();
            state.0.set_message(part);
            state.1 = Some(part);
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1000")]
        state.0.set_position((done.clamp(0.0, 1.0) * 1000.0) as u64);
    }

    fn finish(&self) {
        if let Ok(state) = self.0.lock() {
            state.0.finish_and_clear();
        }
    }
}
