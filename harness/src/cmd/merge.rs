//! `hairis merge`: joins the parts of a study.

use super::environment;
use super::study::{check_outputs, finish};
use crate::args::Merge;
use crate::study::output::Study;
use hairis_instruments::error::Error;
use hairis_instruments::interrupt::Interrupt;
use hairis_instruments::program::say;
use std::fs;

/// Joins them, writes the same tables as one run, and prints the summary.
///
/// The rows need no environment; the times, which are measured here, need it for its look-up. The parts contain its digest.
///
/// # Errors
///
/// [`Error::Part`] and [`Error::Missing`] if the parts are not those of one study, all of them; [`Error::Environment`] and
/// [`Error::Usage`] if the environment cannot be read or is not theirs; [`Error::Output`] before any work is done, if the
/// folder cannot be written; [`Error::Failed`] at the end, with all files written, if a check failed.
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
    finish(study, environment, &flags.out, Interrupt::watch())
}
