//! `hairis study`: runs the study, or its part; once all is there, prints its summary and writes its tables.

use crate::cmd::{environment, print_tables, say};
use crate::config::Study as Config;
use crate::difference::Difference;
use crate::error::Error;
use crate::light::Environment;
use crate::study::output::{Study, Times};
use crate::study::part::{Part, read};
use crate::study::{self, Plan, Shard};
use indicatif::{ProgressBar, ProgressStyle};
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

/// Runs the study. Continues an interrupted one.
///
/// # Errors
///
/// [`Error::Environment`], [`Error::Output`] and [`Error::Part`] before any work is done, if a file cannot be read or
/// written, or is of another study; [`Error::Failed`] at the end, with all files written, if a check failed.
pub fn run(config: &Config) -> Result<(), Error> {
    let (environment, _) = environment(config.env.as_deref())?;
    let plan = Plan { seed: config.seed, quick: config.quick, environment: &environment };
    let cells = plan.grid().len();
    if config.shard.of() > cells {
        let shard = config.shard;
        return Err(Error::Usage(format!("--shard N must be at most {cells}, the number of cells, got \"{shard}\"")));
    }
    fs::create_dir_all(&config.out).map_err(|source| Error::Output { path: config.out.clone(), source })?;
    let (part, finished) = Part::open(&config.out, &plan.header(config.shard))?;

    let owned = || (0..plan.grid().len()).filter(|index| config.shard.owns(*index));
    let mut done = vec![false; plan.grid().len()];
    for cell in &finished {
        done[cell.cell] = true;
    }
    let todo: Vec<usize> = owned().filter(|index| !done[*index]).collect();
    if !finished.is_empty() && !todo.is_empty() {
        say(&format!("{}: continues after {} of {} cells", part.path().display(), finished.len(), owned().count()));
    }
    let bar = bar(todo.len());
    study::run(&plan, &todo, |cell| {
        part.keep(&cell)?;
        bar.inc(1);
        Ok::<(), Error>(())
    })?;
    bar.finish_and_clear();

    if config.shard == Shard::WHOLE {
        let study = Study::join(&[(part.path().to_owned(), read(part.path())?)])?;
        finish(&study, Some(&environment), &config.out)
    } else {
        say(&format!("wrote {}; `hairis merge` joins it with the others", part.path().display()));
        Ok(())
    }
}

/// Measures times, computes how different the models look, writes the tables and prints the summary.
pub(super) fn finish(study: &Study, environment: Option<&Environment>, out: &Path) -> Result<(), Error> {
    let (seed, quick) = study.settings();
    let times = Times::measure(seed, quick, environment).with_rays(seed, quick, environment);
    let difference = Difference::over(study.grid())?;
    study.write(out, &times, &difference)?;
    study.report(&times, &difference, claims(out, study).as_ref()).write(out, "study")?;
    let page = out.join("report.html");
    print_tables(study.summary(&times).iter().chain(&difference.tables()), &page)?;
    let [rows, others @ ..] = ["study", "efficiency", "difference"].map(|name| out.join(name).display().to_string());
    let parquet = if cfg!(feature = "parquet") { " and .parquet" } else { "" };
    say(&format!("wrote {rows}.csv{parquet}, {} as .csv{parquet}, and {rows}.json", others.join(" and ")));
    say(&format!("wrote {} and figures/", page.display()));
    let failures = study.failures();
    failures.iter().for_each(|failure| say(&format!("failed: {failure}")));
    if failures.is_empty() { Ok(()) } else { Err(Error::Failed(failures.len())) }
}

/// Result of `hairis claims` in `out`, if any and if it is of the same settings; else the reason on standard error.
fn claims(out: &Path, study: &Study) -> Option<serde_json::Value> {
    let path = out.join("claims.json");
    let unused = |problem: String| {
        say(&format!("{}: left out of the report: {problem}; run `hairis claims` again", path.display()));
        None
    };
    let bytes = match fs::read(&path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == ErrorKind::NotFound => return None,
        Err(error) => return unused(format!("cannot read: {error}")),
    };
    let Ok(claims) = serde_json::from_slice::<serde_json::Value>(&bytes) else {
        return unused("it is damaged".to_owned());
    };
    match study.refusal_of(&claims) {
        Some(problem) => unused(problem),
        None => Some(claims),
    }
}

/// Progress bar over the remaining cells, on standard error; nothing where that is no terminal.
fn bar(cells: usize) -> ProgressBar {
    let bar = ProgressBar::new(cells as u64);
    if let Ok(style) = ProgressStyle::with_template("cells {pos:>4} of {len} {wide_bar} {elapsed} (left {eta})") {
        bar.set_style(style);
    }
    bar
}
