//! `hairis study`: runs the study or a part of it. Once the study is complete, prints its verdicts and writes its tables.

use crate::args::Study as Flags;
use crate::difference::Difference;
use crate::study::output::Study;
use crate::study::part::{Part, read};
use crate::study::{self, Plan, Size};
use hairis_harness::cmd::{environment, report_failures};
use hairis_harness::journal::Journal;
use hairis_harness::materials;
use hairis_instruments::error::Error;
use hairis_instruments::interrupt::Interrupt;
use hairis_instruments::light::Environment;
use hairis_instruments::program::say;
use hairis_instruments::progress::{bar, share_bar, show_share};
use hairis_instruments::report::Report;
use hairis_instruments::shard::Shard;
use hairis_instruments::terminal::conclude;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

/// Runs the study or the given shard of it. Continues an interrupted run.
///
/// # Errors
///
/// Returns [`Error::Usage`], [`Error::Environment`], [`Error::Output`] or [`Error::Part`] before any work is done, if the shard is invalid,
/// or if a file cannot be read or written or belongs to another study. Returns [`Error::Failed`] at the end, with all files written, if a
/// check failed. Returns [`Error::Interrupted`] after a signal, with all cells kept that were begun.
pub fn run(flags: &Flags) -> Result<(), Error> {
    let shard: Shard = flags
        .shard
        .parse()
        .map_err(|problem| Error::Usage(format!("--shard {problem}")))?;
    let (environment, _) = environment(flags.env.as_deref(), flags.layer.as_deref())?;
    let materials = materials::of_flags(&flags.model, &flags.material)?;
    let plan = Plan {
        seed: flags.seed,
        size: Size::of_flags(flags.quick, flags.tiny),
        materials: &materials,
        lights: (&environment).into(),
    };
    let header = plan.header(shard);
    let cells = header.work();
    if shard.of() > cells {
        return Err(Error::Usage(format!(
            "--shard N must be at most {cells}, the number of cells, got \"{shard}\""
        )));
    }
    fs::create_dir_all(&flags.out).map_err(Error::output(&flags.out))?;
    let (part, finished) = Part::open(&flags.out, &header)?;
    if shard == Shard::WHOLE {
        check_outputs(&flags.out, !materials.is_empty())?;
    }

    let mut todo: Vec<usize> = (0..cells).filter(|index| shard.owns(*index)).collect();
    let owned = todo.len();
    todo.retain(|index| finished.iter().all(|cell| cell.cell != *index));
    if !finished.is_empty() && !todo.is_empty() {
        say(&format!(
            "{}: continues after {} of {owned} cells",
            part.path().display(),
            finished.len()
        ));
    }
    let bar = bar(
        todo.len() as u64,
        "cells {pos:>4} of {len} {wide_bar} {elapsed} (left {eta})",
    );
    let interrupt = Interrupt::watch();
    study::run(&plan, &todo, |cell| {
        part.keep(&cell)?;
        bar.inc(1);
        interrupt.check(|| {
            let done = finished.len() as u64 + bar.position();
            let path = part.path().display();
            format!("{done} of {owned} cells are in {path}; the same command goes on from there")
        })
    })?;
    bar.finish_and_clear();

    if shard == Shard::WHOLE {
        let study = Study::join(&[(part.path().to_owned(), read(part.path())?)])?;
        finish(
            study,
            Some(&environment),
            &flags.out,
            interrupt,
            flags.tables,
        )
    } else {
        say(&format!(
            "wrote {}; `hairis merge` joins it with the others",
            part.path().display()
        ));
        Ok(())
    }
}

/// Checks that [`finish`] can write its files, before the work for them begins.
pub(super) fn check_outputs(out: &Path, has_materials: bool) -> Result<(), Error> {
    Study::writable(out, has_materials)?;
    Report::writable(out)
}

/// Computes how different the models look, measures times, writes the tables and prints the verdicts.
pub(super) fn finish(
    mut study: Study,
    environment: Option<&Environment>,
    out: &Path,
    interrupt: Interrupt,
    tables: bool,
) -> Result<(), Error> {
    let journal = Journal::open(out, "difference", study.header(), interrupt)?;
    let bar = share_bar("refits {wide_bar} {percent:>3}% {elapsed} (left {eta})");
    // Measuring V on the refits takes about as long as the fits.
    let show = |first: f64| {
        let bar = &bar;
        move |done: usize, of: usize| show_share(bar, first + 0.5 * done as f64 / of as f64)
    };
    let difference = Difference::over(study.grid(), &journal, &show(0.0))?;
    study.refit(&difference, environment, &journal, &show(0.5))?;
    bar.finish_and_clear();
    study.time(environment);
    journal.check()?;
    study.write(out, &difference)?;
    let report = study.report(&difference, claims(out, &study).as_ref());
    report.write(out, "study")?;
    journal.remove();
    let tables = tables.then(|| {
        let tables = study.summary().into_iter().chain(study.materials());
        tables.chain(difference.tables()).collect::<Vec<_>>()
    });
    let [page, rows] =
        ["report.html", "study.csv"].map(|name| out.join(name).display().to_string());
    let files = format!("{page}; rows in {rows}, and further tables beside it");
    conclude(&report, &files, tables.as_deref())?;
    report_failures(&study.failures())
}

/// Returns the result of `hairis claims` in `out` if it has the same settings as the study. Otherwise returns none; a result that is not
/// used is reported on standard error.
fn claims(out: &Path, study: &Study) -> Option<serde_json::Value> {
    let path = out.join("claims.json");
    let claims = match fs::read(&path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return None,
        Err(error) => Err(format!("cannot read: {error}")),
        Ok(content) => study.claims(&content),
    };
    let unused = |problem: &String| {
        say(&format!(
            "{}: left out of the report: {problem}; run `hairis claims` again",
            path.display()
        ));
    };
    claims.inspect_err(unused).ok()
}
