//! `hairis merge`: joins the parts of a study.

use crate::cmd::study::finish;
use crate::config::Merge;
use crate::error::Error;
use crate::study::output::Study;
use std::fs;

/// Joins them, writes the same tables as one run, and prints the summary.
///
/// # Errors
///
/// [`Error::Part`] and [`Error::Missing`] if the parts are not those of one study, all of them; [`Error::Output`] if
/// its tables cannot be written; [`Error::Failed`] at the end, with all files written, if a check failed.
pub fn run(config: &Merge) -> Result<(), Error> {
    let study = Study::read(&config.parts)?;
    fs::create_dir_all(&config.out).map_err(|source| Error::Output { path: config.out.clone(), source })?;
    finish(&study, &config.out)
}
