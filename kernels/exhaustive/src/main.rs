//! Elementary functions of [`hairis::model::math`] at every float of their domains, on one lane and on every level of this CPU, against
//! double precision. Functions of several numbers are evaluated on the sets that [`pairs`] states.
//!
//! - `hairis-exhaustive RECORD`: sweeps over all floats, and writes a row for each result to RECORD; functions that the file has are
//!   left out, so that a run that was stopped goes on. Takes minutes.
//! - `hairis-exhaustive check RECORD [STRIDE]`: sweeps over one step in STRIDE (1009 if it is left out) from an offset that differs
//!   from run to run and is printed, and fails if an error is larger than that of the record, if levels differ in a bit that must
//!   have the same bits, or if an exception is raised.

mod floats;
mod functions;
mod pairs;
mod sweep;

use core::error::Error;
use functions::{Function, each_function};
use hairis::simd::Level;
use pairs::each_pair;
use std::env::args;
use std::fs;
use std::io::Write;
use std::time::{SystemTime, UNIX_EPOCH};
use sweep::{Choice, Found, Worst, sweep};

const HEAD: &str = "\
# Largest errors of elementary functions over all floats of their domains, by hairis-exhaustive.
# CPU: any
function,result,first,last,arguments,unit,one lane,one lane at,fused,fused at";

/// Number of fields of a row.
const ROW: usize = 10;

/// Numbers at which an error is largest.
fn place<F: Function>(at: [f32; 4]) -> String {
    at[..F::NUMBERS]
        .iter()
        .map(|x| format!("{x:e}"))
        .collect::<Vec<_>>()
        .join(" ")
}

/// Rows of a function, one for each result.
fn rows<F: Function>(found: &Found) -> Vec<String> {
    let rows = F::RESULTS.iter().enumerate().map(|(i, result)| {
        let [first, last] = F::DOMAIN;
        let [one, fused] = found.worst.map(|worst| worst[i]);
        format!(
            "\"{}\",{result},{first:e},{last:e},{},{},{:.4e},{},{:.4e},{}",
            F::NAME,
            found.arguments,
            F::UNIT.name(),
            one.error,
            place::<F>(one.at),
            fused.error,
            place::<F>(fused.at)
        )
    });
    rows.collect()
}

/// Sentences about what must not be, whatever the errors are.
fn faults<F: Function>(found: &Found) -> Vec<String> {
    let mut faults = Vec::new();
    if found.differing > 0 {
        faults.push(format!(
            "{}: {} results differ in a bit between levels",
            F::NAME,
            found.differing
        ));
    }
    for (flags, lanes) in found.flags.into_iter().zip(["one lane", "lanes that fuse"]) {
        if flags != 0 {
            faults.push(format!(
                "{} on {lanes} raises exceptions, flags {flags:#x}",
                F::NAME
            ));
        }
    }
    faults
}

fn record(path: &str) -> Result<Vec<String>, Box<dyn Error>> {
    if !Level::available().any(Level::fuses) {
        return Err("a record needs a CPU with a level that fuses".into());
    }
    let mut text = fs::read_to_string(path).unwrap_or_default();
    if text.is_empty() {
        text = format!("{HEAD}\n");
        fs::write(path, &text)?;
    }
    let mut all = Vec::new();
    macro_rules! visits {
        ($Function:ty) => {{
            type F = $Function;
            if !text.contains(&format!("\n\"{}\",", F::NAME)) {
                let found = sweep::<F>(Choice {
                    stride: 1,
                    offset: 0,
                });
                let rows = rows::<F>(&found).join("\n");
                println!("{rows}");
                // At once: a run that is stopped keeps its rows.
                writeln!(fs::OpenOptions::new().append(true).open(path)?, "{rows}")?;
                all.extend(faults::<F>(&found));
            }
        }};
    }
    each_function!(visits);
    each_pair!(visits);
    Ok(all)
}

/// Largest errors of a row of the record, on one lane and on lanes that fuse.
fn recorded(text: &str, function: &str, result: &str) -> Result<[f64; 2], Box<dyn Error>> {
    let start = format!("\"{function}\",{result},");
    let row = text.lines().find_map(|line| line.strip_prefix(&start));
    let row = row.ok_or_else(|| format!("the record must have a row {start}"))?;
    let fields: Vec<&str> = row.split(',').collect();
    let [_, _, _, _, one, _, fused, _] = fields[..] else {
        return Err(format!("a row must have {} fields: {row}", ROW).into());
    };
    Ok([one.parse()?, fused.parse()?])
}

fn check(path: &str, choice: Choice) -> Result<Vec<String>, Box<dyn Error>> {
    let text =
        fs::read_to_string(path).map_err(|error| format!("{path} must be a record: {error}"))?;
    let mut all = Vec::new();
    let (mut arguments, mut closest) = (0, 0.0_f64);
    let fuses = Level::available().any(Level::fuses);
    macro_rules! visits {
        ($Function:ty) => {{
            type F = $Function;
            let found = sweep::<F>(choice);
            arguments += found.arguments;
            all.extend(faults::<F>(&found));
            for (i, result) in F::RESULTS.iter().enumerate() {
                let most = recorded(&text, F::NAME, result)?;
                let arithmetics = if fuses { 2 } else { 1 };
                let all_lanes = ["one lane", "lanes that fuse"];
                for ((worst, most), lanes) in found
                    .worst
                    .iter()
                    .zip(most)
                    .zip(all_lanes)
                    .take(arithmetics)
                {
                    let Worst { error, at } = worst[i];
                    closest = closest.max(error / most);
                    // The record has five digits.
                    if error > most * 1.0001 {
                        all.push(format!(
                            "{} {result} on {lanes}: {error:.4e} at {}, {most:.4e} in the record",
                            F::NAME,
                            place::<F>(at)
                        ));
                    }
                }
            }
        }};
    }
    each_function!(visits);
    each_pair!(visits);
    println!("{arguments} arguments: largest error {closest:.3} of the record");
    Ok(all)
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let faults = match words[..] {
        ["check", path, ref rest @ ..] if rest.len() < 2 => {
            let stride = rest.first().map_or(Ok(1009), |word| word.parse())?;
            let now = SystemTime::now().duration_since(UNIX_EPOCH)?;
            let offset = u64::from(now.subsec_nanos()) % stride;
            println!("one step in {stride}, from the {offset}th on");
            check(path, Choice { stride, offset })?
        }
        [path] if path != "check" && !path.starts_with('-') => record(path)?,
        _ => {
            return Err(
                "usage: hairis-exhaustive RECORD | hairis-exhaustive check RECORD [STRIDE]".into(),
            );
        }
    };
    if faults.is_empty() {
        return Ok(());
    }
    Err(faults.join("\n").into())
}
