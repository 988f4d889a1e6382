//! `hairis referee`: values of the models in double precision, and verdicts on those of other programs. The functions of its binary,
//! `hairis-referee`.

pub mod answers;
pub mod args;
mod draws;
#[cfg(any(doc, doctest))]
pub mod guide;
pub mod integrals;
pub mod samples;
pub mod vectors;
pub mod verdict;

use answers::Answers;
use args::{Args, Command};
use hairis_program::error::Error;
use hairis_program::program::print;
use std::fs;
use std::io::{self, Read as _};
use std::path::Path;

/// Writes cases, or judges answers.
///
/// # Errors
///
/// - [`Error::Usage`] if a flag or the file of answers is not valid.
/// - [`Error::Failed`] with the number of quantities that are wrong, after the verdict on each was printed.
/// - [`Error::Read`] or [`Error::Write`] if a stream failed.
pub fn run(args: &Args) -> Result<(), Error> {
    match &args.command {
        Command::Vectors(flags) => print(vectors::text(flags)?),
        Command::Check(flags) => {
            let answers = Answers::parse(&read(&flags.file)?)
                .map_err(|problem| Error::Usage(format!("{}: {problem}", flags.file.display())))?;
            let judged = verdict::judge(&answers, flags.tolerance);
            let lines: String = judged.iter().map(|line| format!("{line}\n")).collect();
            print(lines)?;
            match judged.iter().filter(|line| !line.is_right()).count() {
                0 => Ok(()),
                wrong => Err(Error::Failed(wrong)),
            }
        }
    }
}

/// Reads a file, or standard input for the name `-`.
fn read(file: &Path) -> Result<String, Error> {
    if file == Path::new("-") {
        let mut text = String::new();
        io::stdin().read_to_string(&mut text).map_err(Error::Read)?;
        return Ok(text);
    }
    fs::read_to_string(file).map_err(|error| Error::Usage(format!("{}: {error}", file.display())))
}
