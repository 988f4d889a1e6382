//! Figures of the page as a CSV table for other programs.

use super::done::Done;
use super::dual::{self, Pair};
use super::measure::{Measured, Plan};
use super::page::kind;
use super::rates::level;
use super::verdict::Gain;
use crate::args::Figures;
use crate::lights::RectangleSampling;
use crate::numbers::Sequence;
use crate::protocol::{Measure, Reach, Runs, reach, slope_of};
use clap::ValueEnum;
use hairis_instruments::columns::Columns;
use hairis_instruments::error::Error;
use hairis_instruments::files::{whole, write_json};
use hairis_instruments::machine;
use hairis_instruments::machine::Machine;
use hairis_instruments::stats::Estimate;
use serde::Serialize;
use std::ffi::OsString;
use std::path::Path;

/// Settings that the figures depend on, which are written as `figures.json`.
#[derive(Clone, Debug, Serialize)]
pub(super) struct FiguresSettings {
    /// Command line without folders: maps and materials appear by name alone.
    command: String,
    /// Width and height of pictures in pixels.
    side: u32,
    /// Count of strands of hair.
    strands: usize,
    /// Count of pictures from which each error is estimated.
    pictures_per_error: u32,
    /// Meaning of the times.
    time: &'static str,
    machine: Machine,
}

/// Returns the settings of a run, with the names of its maps.
pub(super) fn settings(plan: &Plan, flags: &Figures, maps: &[String]) -> FiguresSettings {
    FiguresSettings {
        command: command(flags, maps),
        side: plan.side,
        strands: plan.strands,
        pictures_per_error: plan.runs,
        time: "seconds of a thread, per picture",
        machine: machine!(),
    }
}

/// Writes `figures.csv` with the figures, and `figures.json` with the settings they depend on.
pub(super) fn write(done: &Done, settings: &FiguresSettings, out: &Path) -> Result<(), Error> {
    let mut rows = Vec::new();
    for measured in &done.scenes {
        scene(measured, &mut rows);
    }
    for preset in &done.presets {
        for (model, brightness, look) in preset.differences() {
            let start = Start {
                scene: "models".to_owned(),
                light: "paths".to_owned(),
                hair: preset.name().to_owned(),
                sampler: model,
                protocol: "",
                samples: Some(preset.samples()),
            };
            let what = "brightness relative to the published model";
            rows.push(start.row(what, Estimate::exact(brightness), false));
            let what = "relative difference of the look";
            rows.push(start.row(what, Estimate::exact(look), false));
        }
    }
    for pair in &done.dual {
        compared(pair, &mut rows);
    }
    whole(&out.join("figures.csv"), |file| {
        columns(&rows).write_csv(file)
    })?;
    write_json(&out.join("figures.json"), settings)
}

/// Columns that identify a figure.
#[derive(Clone, Debug)]
pub struct Start {
    /// Title of the scene.
    pub scene: String,
    /// Light that is estimated.
    pub light: String,
    /// Name of the hair.
    pub hair: String,
    /// Name of the sampler, or of the model.
    pub sampler: &'static str,
    /// Protocol of the comparison: an equal count of samples, or equal time.
    pub protocol: &'static str,
    /// Samples per pixel, if the figure belongs to one count of samples.
    pub samples: Option<u32>,
}

/// Row of the table: one figure with its standard error.
#[derive(Clone, Debug)]
pub struct Row {
    start: Start,
    figure: String,
    estimate: Estimate,
    is_below: bool,
}

impl Start {
    /// Returns the row of a figure, and marks it if an error is below the reference.
    #[must_use]
    pub fn row(&self, figure: &str, estimate: Estimate, is_below: bool) -> Row {
        Row {
            start: self.clone(),
            figure: figure.to_owned(),
            estimate,
            is_below,
        }
    }
}

/// Returns the rows as columns of a CSV file.
#[must_use]
pub fn columns(rows: &[Row]) -> Columns {
    let text = |of: fn(&Start) -> String| rows.iter().map(move |row| of(&row.start));
    Columns::default()
        .text("scene", text(|start| start.scene.clone()))
        .text("light", text(|start| start.light.clone()))
        .text("hair", text(|start| start.hair.clone()))
        .text("sampler", text(|start| start.sampler.to_owned()))
        .text("protocol", text(|start| start.protocol.to_owned()))
        .text(
            "samples",
            text(|start| {
                start
                    .samples
                    .map_or_else(String::new, |samples| samples.to_string())
            }),
        )
        .text("figure", rows.iter().map(|row| row.figure.clone()))
        .number("value", rows.iter().map(|row| digits(row.estimate.value)))
        .number(
            "standard_error",
            rows.iter().map(|row| digits(row.estimate.standard_error)),
        )
        .text(
            "below_reference",
            rows.iter().map(|row| if row.is_below { "yes" } else { "" }),
        )
}

/// Returns the command line without folders, as Bash reads it: maps and materials appear by name alone.
#[must_use]
pub fn command(flags: &Figures, maps: &[String]) -> String {
    let mut words: Vec<OsString> = vec!["hairis-render".into(), "figures".into()];
    let mut add = |name: &str, value: Option<OsString>| {
        words.push(format!("--{name}").into());
        words.extend(value);
    };
    if flags.quick {
        add("quick", None);
    }
    for map in maps {
        add("env", Some(map.into()));
    }
    for scene in &flags.scene {
        add("scene", Some(scene.word().into()));
    }
    for material in &flags.material {
        add("material", material.file_name().map(OsString::from));
    }
    for set in &flags.set {
        add("set", Some(set.into()));
    }
    if let Some(integrator) = flags.integrator {
        add("integrator", spelled(integrator));
    }
    if flags.xi != Sequence::Sobol {
        add("xi", spelled(flags.xi));
    }
    if flags.rectangles != RectangleSampling::default() {
        add("rectangles", spelled(flags.rectangles));
    }
    if flags.models {
        add("models", None);
    }
    add("seed", Some(flags.seed.to_string().into()));
    crate::layers::words(words)
}

/// Returns the value of a flag, as the command line spells it.
fn spelled(value: impl ValueEnum) -> Option<OsString> {
    let value = value.to_possible_value()?;
    Some(value.get_name().into())
}

/// Adds the rows of a scene.
fn scene(measured: &Measured, rows: &mut Vec<Row>) {
    let start = Start {
        scene: measured.title(),
        light: kind(measured).replace(',', ""),
        hair: measured.hair.clone(),
        sampler: measured.best(),
        protocol: "",
        samples: None,
    };
    let visible = Estimate::exact(measured.visible);
    rows.push(start.row(
        "share of the rays towards lights that reach them",
        visible,
        false,
    ));
    let Some(best) = measured.samplers.last() else {
        return;
    };
    let level = level(measured);
    for sampler in &measured.samplers {
        let start = Start {
            sampler: sampler.name,
            ..start.clone()
        };
        let at = |protocol, runs: &Runs| Start {
            protocol,
            samples: Some(runs.samples),
            ..start.clone()
        };
        for (runs, best) in sampler.runs.iter().zip(&best.runs) {
            figures(
                &at("equal samples", runs),
                runs,
                (measured.best(), best),
                rows,
            );
        }
        let runs = &sampler.equal_time;
        let best = (measured.best(), &best.equal_time);
        figures(&at("equal time", runs), runs, best, rows);
        for measure in Measure::ALL {
            if let Some(slope) = slope_of(&sampler.runs, measure) {
                let what = format!("slope of log {}", measure.name());
                rows.push(start.row(&what, slope, false));
            }
        }
        if let Some(Reach::At(both)) = reach(&sampler.runs, Measure::RelMse, level) {
            for (what, estimate) in ["samples", "time"].into_iter().zip(both) {
                let what = format!("{what} to relMSE {}", digits(level));
                rows.push(start.row(&what, estimate, false));
            }
        }
    }
}

/// Adds the rows of a sampler at a count of samples.
fn figures(start: &Start, runs: &Runs, (name_of_best, best): (&str, &Runs), rows: &mut Vec<Row>) {
    rows.push(start.row("time", Estimate::exact(runs.seconds), false));
    rows.push(start.row("variance per sample", runs.variance, false));
    for measure in Measure::ALL {
        let name = measure.name();
        rows.push(start.row(name, runs.mean(measure), runs.is_below_reference(measure)));
        for (what, with_time) in [("", false), (" × time", true)] {
            let Gain { ratio, is_below } = Gain::new(runs, best, measure, with_time);
            let what = format!("{name}{what} relative to {name_of_best}");
            rows.push(start.row(&what, ratio, is_below));
        }
    }
}

/// Rounds a number to five significant digits.
fn digits(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}

/// Adds the rows of dual scattering beside paths.
fn compared(pair: &Pair, rows: &mut Vec<Row>) {
    let start = Start {
        scene: dual::SCENE.word().to_owned(),
        light: "paths".to_owned(),
        hair: pair.preset.to_owned(),
        sampler: pair.model,
        protocol: "",
        samples: Some(pair.samples),
    };
    let mut add = |what: &str, value| rows.push(start.row(what, Estimate::exact(value), false));
    for (name, mean) in ["red", "green", "blue"].into_iter().zip(pair.means) {
        add(
            &format!("mean of dual scattering over that of paths in {name}"),
            mean,
        );
    }
    add("share of light scattered once in red", pair.once[0]);
    add("difference of dual scattering by block", pair.by_block);
    let [dual, paths] = pair.times;
    add("time of dual scattering over that of paths", dual / paths);
}
