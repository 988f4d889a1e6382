//! `hairis eval`: reads JSON Lines and writes JSON Lines.
//!
//! One line is written for each line read, in order. Lines are answered in blocks as long as the chosen path takes them, in constant memory
//! however long the input is. If the input has no further line ready, a block ends early, so that a program that writes a line and waits
//! for its answer gets it. Answers do not depend on the blocks, because lanes are independent.

mod answer;
mod lines;
mod request;

use crate::args::{CodePath, Eval};
use crate::materials::find_model;
use answer::{answers, block_len};
use hairis_instruments::error::Error;
use hairis_instruments::program::{print, say};
use hairis_materials::material::values_json;
use hairis_variants::ModelId;
use lines::Lines;
use request::Request;
use serde_json::{Value, json};
use std::io::{self, BufReader, BufWriter, ErrorKind, IsTerminal as _, Read, Write};

const BUFFER: usize = 1 << 16;

/// Answers the requests of standard input on standard output.
///
/// If the reader of standard output leaves early, the run ends without an error of its own.
///
/// # Errors
///
/// - [`Error::Malformed`] if any line was rejected, after all others were answered.
/// - [`Error::Read`] or [`Error::Write`] if a stream failed.
pub fn run(flags: &Eval) -> Result<(), Error> {
    if let Some(model) = &flags.example {
        return print(format!("{}\n", example(find_model("--example", model)?)));
    }
    if io::stdin().is_terminal() {
        let example = example(ModelId::Gaussian);
        say("reads one request per line of standard input, until Ctrl-D; this is one to paste:");
        say(&example.to_string());
    }
    let input = BufReader::with_capacity(BUFFER, io::stdin().lock());
    let output = BufWriter::with_capacity(BUFFER, io::stdout().lock());
    stream(flags.path, input, output)
}

/// Returns a request for the value of a model's first preset.
fn example(model: ModelId) -> Value {
    let (_, values) = model.presets().next().expect("every model has presets");
    let mut params = values_json(&values);
    params
        .as_object_mut()
        .into_iter()
        .flatten()
        .for_each(|(_, value)| shorten(value));
    let mut request = json!({
        "model": model.name(),
        "params": params,
        "wo": [0.28, 0.576, 0.768],
        "wi": [0.0, 0.6, -0.8],
    });
    if model.is_near_field() {
        request["h"] = json!(0.3);
    }
    request
}

/// Writes numbers in as few digits as give the same number in single precision.
#[expect(
    clippy::cast_possible_truncation,
    reason = "they were in single precision"
)]
fn shorten(value: &mut Value) {
    if let Value::Array(values) = value {
        values.iter_mut().for_each(shorten);
    } else if let Some(number) = value.as_f64() {
        let short = (number as f32).to_string().parse::<f64>();
        *value = json!(short.unwrap_or(number));
    }
}

/// Answers the requests of `input` on `output`, as [`run`] does for the standard streams.
///
/// # Errors
///
/// Returns the errors of [`run`].
pub fn stream<R: Read, W: Write>(
    path: CodePath,
    input: BufReader<R>,
    mut output: W,
) -> Result<(), Error> {
    let mut lines = Lines::new(input);
    let mut block = Vec::with_capacity(block_len(path));
    let (mut read, mut refused) = (0, 0);
    let mut more = true;
    while more {
        block.clear();
        more = fill(&mut block, block_len(path), &mut lines).map_err(Error::Read)?;
        read += block.len() as u64;
        refused += block.iter().filter(|line| line.is_err()).count() as u64;
        let mut write = || -> io::Result<()> {
            for answer in answers(path, &block)? {
                writeln!(output, "{answer}")?;
            }
            // Flush now: the caller may wait for these answers before it writes on.
            if more && lines.ready() {
                Ok(())
            } else {
                output.flush()
            }
        };
        match write() {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => break,
            other => other.map_err(Error::Write)?,
        }
    }
    if refused == 0 {
        Ok(())
    } else {
        Err(Error::Malformed {
            lines: refused,
            of: read,
        })
    }
}

/// Reads up to `len` lines, or fewer if no more are ready. Returns false at the end of the input.
fn fill<R: Read>(
    block: &mut Vec<Result<Request, String>>,
    len: usize,
    lines: &mut Lines<R>,
) -> io::Result<bool> {
    loop {
        match lines.next()? {
            None => return Ok(false),
            Some(line) => block.push(line.and_then(Request::parse)),
        }
        if block.len() == len || !lines.ready() {
            return Ok(true);
        }
    }
}
