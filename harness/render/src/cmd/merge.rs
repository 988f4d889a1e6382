//! Subcommand `hairis-render merge`, which joins the parts that shards have left.

use super::render::{check_out, finish};
use crate::args::Merge;
use crate::layers::Beside;
use crate::part::Part;
use hairis_instruments::error::Error;
use hairis_instruments::program::print;

/// Joins the parts of a picture, and writes the picture with its preview.
///
/// # Errors
///
/// Returns an error if a part cannot be read, is missing or belongs to another run, or if the file cannot be written.
pub(super) fn run(flags: &Merge) -> Result<(), Error> {
    check_out(&flags.out)?;
    let parts = flags
        .parts
        .iter()
        .map(|path| Ok((path.clone(), Part::read(path)?)))
        .collect::<Result<_, Error>>()?;
    let Part { run, film, .. } = Part::merge(parts)?;
    let wrote = finish(&film, &Beside::film(&film, &run), &flags.out, None)?;
    print(wrote)
}
