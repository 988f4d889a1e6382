//! `hairis claims`: computes the paper's claims, prints the verdicts, and writes `claims.json`.

use crate::args::Claims;
use crate::claims;
use crate::study::Size;
use hairis_harness::journal::Journal;
use hairis_instruments::error::Error;
use hairis_instruments::files::{writable, write_json};
use hairis_instruments::interrupt::Interrupt;
use hairis_instruments::progress::{share_bar, show_share};
use hairis_instruments::terminal::conclude;
use std::fs;

/// Computes the claims of the paper, prints the verdicts, or all tables, and writes `claims.json`. Continues an interrupted run.
///
/// # Errors
///
/// Returns [`Error::Output`] before any work is done, if the folder cannot be written, and [`Error::Interrupted`] after a signal. A false
/// claim is not an error.
pub fn run(flags: &Claims) -> Result<(), Error> {
    fs::create_dir_all(&flags.out).map_err(Error::output(&flags.out))?;
    let path = flags.out.join("claims.json");
    writable(&path)?;

    let bar = share_bar("claims {wide_bar} {percent:>3}% {elapsed} (left {eta})");
    let size = Size::of_flags(flags.quick, flags.tiny);
    let header = claims::header(flags.seed, size);
    let journal = Journal::open(&flags.out, "claims", &header, Interrupt::watch())?;
    let show = |done| show_share(&bar, done);
    let claims = claims::run(flags.seed, size, &journal, &show)?;
    bar.finish_and_clear();

    write_json(&path, &claims)?;
    journal.remove();
    let tables = flags.tables.then(|| claims::tables(&claims));
    let head = claims::report(&claims);
    conclude(&head, &path.display().to_string(), tables.as_deref())
}
