//! `hairis merge`: joins the parts of a study that ran in shards.

use super::study::{check_outputs, finish};
use crate::args::Merge;
use crate::study::output::Study;
use hairis_harness::cmd::environment;
use hairis_instruments::error::Error;
use hairis_instruments::interrupt::Interrupt;
use hairis_instruments::program::say;
use std::fs;

/// Joins the parts, writes the same tables as one run, and prints the verdicts.
///
/// The rows need no environment. The times, which are measured here, need it for the time of its look-up. The parts contain its digest.
///
/// # Errors
///
/// Returns [`Error::Part`] or [`Error::Missing`] if the parts are not all the parts of one study, and [`Error::Environment`] or
/// [`Error::Usage`] if the environment cannot be read or is not that of the parts. Returns [`Error::Output`] before any work is done, if
/// the folder cannot be written, and [`Error::Failed`] at the end, with all files written, if a check failed.
pub fn run(flags: &Merge) -> Result<(), Error> {
    let study = Study::read(&flags.parts)?;
    let (environment, name) = environment(flags.env.as_deref(), flags.layer.as_deref())?;
    let is_theirs = study.has_environment(&environment);
    if !is_theirs && flags.env.is_some() {
        return Err(Error::Usage(format!(
            "--env must be the environment of the parts, got {name}"
        )));
    }
    if !is_theirs {
        say("the look-up of the environment is not timed; pass --env FILE to time it");
    }
    fs::create_dir_all(&flags.out).map_err(Error::output(&flags.out))?;
    check_outputs(&flags.out, study.has_materials())?;
    let environment = is_theirs.then_some(&environment);
    finish(
        study,
        environment,
        &flags.out,
        Interrupt::watch(),
        flags.tables,
    )
}
