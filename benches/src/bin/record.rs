//! Turns a folder of Criterion results into a record: `record FOLDER`.
//!
//! Prints a CSV. Comments at its beginning state the CPU, the compiler, the commit and the levels; then follows one row per bench.
//! Times are in ns per direction, per shading point for `prepare`, and per argument for `math`. A row has the median over Criterion's
//! samples, the bounds of its 95% confidence interval, and the median absolute deviation of a sample.

use core::error::Error;
use core::fmt::Write;
use hairis::simd::Level;
use hairis_benches::cpu;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{env, fs};

fn main() -> ExitCode {
    let words: Vec<String> = env::args().skip(1).collect();
    let done = match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["cpu"] => Ok(slug(&cpu::name()) + "\n"),
        [folder] => record(Path::new(folder)),
        _ => Err("usage: record FOLDER | record cpu".into()),
    };
    match done {
        Ok(text) => {
            print!("{text}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("record: {error}");
            ExitCode::from(2)
        }
    }
}

fn record(folder: &Path) -> Result<String, Box<dyn Error>> {
    let mut rows = Vec::new();
    benches(folder, &mut rows)?;
    if rows.is_empty() {
        return Err(format!("no benches in {}", folder.display()).into());
    }
    rows.sort();
    let modified = if output("git", &["status", "--porcelain"])?.is_empty() {
        ""
    } else {
        ", modified"
    };
    let mut text = String::new();
    writeln!(text, "# CPU: {}", cpu::name())?;
    for line in output("rustc", &["-vV"])?
        .lines()
        .filter(|line| !line.is_empty())
    {
        writeln!(text, "# {line}")?;
    }
    writeln!(
        text,
        "# commit: {}{modified}",
        output("git", &["rev-parse", "HEAD"])?.trim()
    )?;
    writeln!(
        text,
        "# compiled for {}; eight lanes run on {}",
        Level::portable(),
        Level::detect()
    )?;
    writeln!(text, "group,entry,level,ns,ns_low,ns_high,ns_deviation")?;
    for (_, row) in rows {
        writeln!(text, "{row}")?;
    }
    Ok(text)
}

/// Appends the sort key and the row of every bench below a folder to `rows`.
fn benches(folder: &Path, rows: &mut Vec<([String; 3], String)>) -> Result<(), Box<dyn Error>> {
    for entry in fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))? {
        let path = entry?.path();
        if !path.is_dir() {
            continue;
        }
        if path.ends_with("new") && path.join("estimates.json").exists() {
            rows.push(row(&path)?);
        } else {
            benches(&path, rows)?;
        }
    }
    Ok(())
}

fn row(folder: &Path) -> Result<([String; 3], String), Box<dyn Error>> {
    let bench = json(&folder.join("benchmark.json"))?;
    let estimates = json(&folder.join("estimates.json"))?;
    let text = |key: &str| bench[key].as_str().unwrap_or_default().to_owned();
    let key = [text("group_id"), text("function_id"), text("value_str")];
    let elements = bench["throughput"]["Elements"]
        .as_f64()
        .ok_or_else(|| format!("{key:?} has no throughput"))?;
    let ns = |value: &Value| {
        value
            .as_f64()
            .map(|ns| ns / elements)
            .ok_or_else(|| format!("{key:?}: no estimate"))
    };
    let (median, interval) = (
        &estimates["median"],
        &estimates["median"]["confidence_interval"],
    );
    let row = format!(
        "{},{},{},{:.3},{:.3},{:.3},{:.3}",
        key[0],
        key[1],
        key[2],
        ns(&median["point_estimate"])?,
        ns(&interval["lower_bound"])?,
        ns(&interval["upper_bound"])?,
        ns(&estimates["median_abs_dev"]["point_estimate"])?,
    );
    Ok((key, row))
}

fn json(path: &PathBuf) -> Result<Value, Box<dyn Error>> {
    let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(serde_json::from_str(&text)?)
}

fn output(program: &str, words: &[&str]) -> Result<String, Box<dyn Error>> {
    let done = Command::new(program)
        .args(words)
        .output()
        .map_err(|error| format!("{program}: {error}"))?;
    if !done.status.success() {
        return Err(format!("{program} {words:?}: {}", done.status).into());
    }
    Ok(String::from_utf8(done.stdout)?)
}

/// Returns the name of a CPU in lower case with hyphens, as the name of a folder.
fn slug(cpu: &str) -> String {
    let plain = cpu.replace("(R)", "").replace("(TM)", "").to_lowercase();
    let words = plain
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-")
}
