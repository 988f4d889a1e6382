//! `hairis claims`: computes the paper's claims, prints them, and writes `claims.json`.

use crate::claims;
use crate::cmd::compare::{output, write_json};
use crate::cmd::{print_tables, say};
use crate::config::Claims;
use crate::error::Error;
use crate::files::writable;
use indicatif::{ProgressBar, ProgressStyle};
use std::fs;

/// Computes the claims.
///
/// # Errors
///
/// [`Error::Output`] before any work is done, if the folder cannot be written. A false claim is no error.
pub fn run(config: &Claims) -> Result<(), Error> {
    fs::create_dir_all(&config.out).map_err(|source| output(&config.out, source))?;
    let path = config.out.join("claims.json");
    writable(&path)?;

    let bar = ProgressBar::new(1000);
    if let Ok(style) = ProgressStyle::with_template("claims {wide_bar} {percent:>3}% {elapsed} (left {eta})") {
        bar.set_style(style);
    }
    let claims = claims::run(config.seed, config.quick, &|done| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1000")]
        bar.set_position((done.clamp(0.0, 1.0) * 1000.0) as u64);
    })?;
    bar.finish_and_clear();

    write_json(&path, &claims)?;
    print_tables(claims::tables(&claims).iter(), &path)?;
    say(&format!("wrote {}", path.display()));
    Ok(())
}
