//! `hairis compare`: runs the comparison, prints its verdicts, and writes `compare.json`, `report.html` and
//! `figures/`.

use super::{environment, report_failures};
use crate::args::Compare;
use crate::compare::{self, CompareSettings};
use crate::materials;
use hairis_instruments::error::Error;
use hairis_instruments::files::{writable, write_json};
use hairis_instruments::progress::{share_bar, show_share};
use hairis_instruments::report::Report;
use hairis_instruments::terminal::conclude;
use std::fs;

/// Runs the comparison, writes its files and prints its verdicts, or its tables.
///
/// # Errors
///
/// Returns [`Error::Environment`] or [`Error::Output`] before any work is done, if a file cannot be read or the folder cannot be written.
/// Returns [`Error::Failed`] at the end, with all files written, if a check failed.
pub fn run(flags: &Compare) -> Result<(), Error> {
    let (environment, name) = environment(flags.env.as_deref(), flags.layer.as_deref())?;
    let materials = materials::of_flags(&flags.model, &flags.material)?;
    fs::create_dir_all(&flags.out).map_err(Error::output(&flags.out))?;
    let [json, page] = ["compare.json", "report.html"].map(|name| flags.out.join(name));
    writable(&json)?;
    Report::writable(&flags.out)?;

    let bar = share_bar("{msg:>18} {wide_bar} {percent:>3}% {elapsed} (left {eta})");
    let environment_notes = environment.notes();
    let settings = CompareSettings {
        seed: flags.seed,
        quick: flags.quick,
        environment: name,
        environment_notes,
    };
    let comparison = compare::run(settings, &environment, &materials, &|part, done| {
        if bar.message() != part {
            bar.reset();
            bar.set_message(part);
        }
        show_share(&bar, done);
    })?;
    bar.finish_and_clear();

    write_json(&json, &comparison)?;
    let report = compare::report(&comparison);
    report.write(&flags.out, "compare")?;
    let files = format!("{}, and all figures in {}", page.display(), json.display());
    let tables = flags.tables.then(|| compare::summary_tables(&comparison));
    conclude(&report, &files, tables.as_deref())?;
    report_failures(&comparison.failures())
}
