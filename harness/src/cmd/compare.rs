//! `hairis compare`: runs the comparison, prints its tables, and writes `compare.json`, `report.html` and
//! `figures/`.

use crate::cmd::{environment, print_tables};
use crate::compare::{self, CompareConfig, Comparison, Depth, Part};
use crate::config::Compare;
use crate::error::Error;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use std::fs::{self, File};
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
        File::options().append(true).create(true).open(path).map_err(|source| output(path, source))?;
    }

    let bar = Bar::new();
    let settings =
        CompareConfig { seed: config.seed, quick: config.quick, environment: &environment, environment_name: &name };
    let comparison = compare::run(&settings, &|part, done| bar.show(part, done)).map_err(Error::Params)?;
    bar.finish();

    write(&json_path, &json(&comparison)?)?;
    compare::report(&comparison).write(&config.out, "compare")?;
    print(&comparison).map_err(Error::Write)?;
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

pub(super) fn write(path: &Path, text: &str) -> Result<(), Error> {
    fs::write(path, text).map_err(|source| output(path, source))
}

/// Content of a JSON file.
pub(super) fn json(results: &impl Serialize) -> Result<String, Error> {
    let mut text = serde_json::to_string_pretty(results).map_err(|source| Error::Write(source.into()))?;
    text.push('\n');
    Ok(text)
}

/// The tables on standard output.
fn print(comparison: &Comparison) -> io::Result<()> {
    let tables = compare::tables(comparison, Depth::Summary);
    print_tables(tables.speed.iter().chain(&tables.agreement).chain(&tables.efficiency))
}

/// Progress bars, one per part, on standard error; nothing where that is no terminal.
struct Bar(Mutex<(ProgressBar, Option<Part>)>);

impl Bar {
    fn new() -> Self {
        let bar = ProgressBar::new(1000);
        if let Ok(style) = ProgressStyle::with_template("{msg:>18} {wide_bar} {percent:>3}% {elapsed} (left {eta})") {
            bar.set_style(style);
        }
        Self(Mutex::new((bar, None)))
    }

    fn show(&self, part: Part, done: f64) {
        let Ok(mut state) = self.0.lock() else { return };
        if state.1 != Some(part) {
            state.0.reset();
            state.0.set_message(part.label());
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
