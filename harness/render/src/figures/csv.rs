//! The figures of the page as a table for programs.

use super::measure::{Measured, Plan};
use super::models::Preset;
use super::page::kind;
use super::rates::level;
use super::verdict::Gain;
use crate::args::Figures;
use crate::lights::RectangleSampling;
use crate::numbers::Sequence;
use crate::protocol::{Measure, Reach, Runs, reach, slope_of};
use clap::ValueEnum;
use hairis_instruments::error::Error;
use hairis_instruments::files::whole;
use hairis_instruments::machine;
use hairis_instruments::stats::Estimate;
use std::io::Write as _;
use std::path::Path;

/// Names of the columns.
const HEADER: &str =
    "scene,light,hair,sampler,protocol,samples,figure,value,standard_error,below_reference";

/// Writes `figures.csv`.
pub(super) fn write(
    all: &[Measured],
    presets: &[Preset],
    plan: &Plan,
    flags: &Figures,
    out: &Path,
) -> Result<(), Error> {
    let mut lines = head(plan, flags);
    for measured in all {
        scene(measured, &mut lines);
    }
    for preset in presets {
        for (model, brightness, look) in preset.differences() {
            let start = format!(
                "models,paths,{},{model},,{}",
                preset.name(),
                preset.samples()
            );
            lines.push(row(
                &start,
                "brightness relative to the published model",
                Estimate::exact(brightness),
                false,
            ));
            lines.push(row(
                &start,
                "relative difference of the look",
                Estimate::exact(look),
                false,
            ));
        }
    }
    whole(&out.join("figures.csv"), |file| {
        file.write_all((lines.join("\n") + "\n").as_bytes())
    })
}

/// Machine, compiler, command and settings, and the names of the columns.
fn head(plan: &Plan, flags: &Figures) -> Vec<String> {
    let Plan {
        side,
        strands,
        runs,
        ..
    } = plan;
    vec![
        format!("# {}", machine!().summary()),
        format!("# {}", command(flags)),
        format!(
            "# {side} by {side} pixels, {strands} strands, {runs} pictures per error; time: seconds of a thread, per picture"
        ),
        HEADER.to_owned(),
    ]
}

/// The command line, with the names of maps alone, and without folders.
fn command(flags: &Figures) -> String {
    let mut words = vec!["hairis-render figures".to_owned()];
    words.extend(flags.quick.then(|| "--quick".to_owned()));
    for map in &flags.env {
        words.push(format!(
            "--env {}",
            map.file_name().unwrap_or_default().display()
        ));
    }
    words.extend(
        flags
            .scene
            .iter()
            .map(|scene| format!("--scene {}", scene.word())),
    );
    words.extend(flags.integrator.and_then(|one| flag("integrator", one)));
    if flags.xi != Sequence::Sobol {
        words.extend(flag("xi", flags.xi));
    }
    if flags.rectangles != RectangleSampling::default() {
        words.extend(flag("rectangles", flags.rectangles));
    }
    words.extend(flags.models.then(|| "--models".to_owned()));
    words.push(format!("--seed {}", flags.seed));
    words.join(" ")
}

/// A flag and its value.
fn flag(name: &str, value: impl ValueEnum) -> Option<String> {
    value
        .to_possible_value()
        .map(|value| format!("--{name} {}", value.get_name()))
}

/// Adds the rows of a scene.
fn scene(measured: &Measured, lines: &mut Vec<String>) {
    let title = measured.title().replace([',', '"', '\n'], " ");
    let start = format!(
        "{title},{},{}",
        kind(measured).replace(',', ""),
        measured.preset
    );
    let visible = Estimate::exact(measured.visible);
    lines.push(row(
        &format!("{start},matched,,"),
        "share of the rays towards lights that reach them",
        visible,
        false,
    ));
    let Some(best) = measured.samplers.last() else {
        return;
    };
    let level = level(measured);
    for sampler in &measured.samplers {
        for (runs, best) in sampler.runs.iter().zip(&best.runs) {
            figures(
                &format!("{start},{},equal samples,{}", sampler.name, runs.samples),
                runs,
                best,
                lines,
            );
        }
        let runs = &sampler.equal_time;
        figures(
            &format!("{start},{},equal time,{}", sampler.name, runs.samples),
            runs,
            &best.equal_time,
            lines,
        );
        let start = format!("{start},{},,", sampler.name);
        for measure in Measure::ALL {
            if let Some(slope) = slope_of(&sampler.runs, measure) {
                lines.push(row(
                    &start,
                    &format!("slope of log {}", measure.name()),
                    slope,
                    false,
                ));
            }
        }
        if let Some(Reach::At([samples, seconds])) = reach(&sampler.runs, Measure::RelMse, level) {
            lines.push(row(
                &start,
                &format!("samples to relMSE {}", digits(level)),
                samples,
                false,
            ));
            lines.push(row(
                &start,
                &format!("time to relMSE {}", digits(level)),
                seconds,
                false,
            ));
        }
    }
}

/// Adds the rows of a sampler at a count of samples.
fn figures(start: &str, runs: &Runs, best: &Runs, lines: &mut Vec<String>) {
    lines.push(row(start, "time", Estimate::exact(runs.seconds), false));
    lines.push(row(start, "variance per sample", runs.variance, false));
    for measure in Measure::ALL {
        let name = measure.name();
        lines.push(row(
            start,
            name,
            runs.mean(measure),
            runs.is_below_reference(measure),
        ));
        for (what, with_time) in [("", false), (" × time", true)] {
            let Gain { ratio, is_below } = Gain::new(runs, best, measure, with_time);
            lines.push(row(
                start,
                &format!("{name}{what} relative to matched"),
                ratio,
                is_below,
            ));
        }
    }
}

fn row(start: &str, figure: &str, estimate: Estimate, is_below: bool) -> String {
    let Estimate {
        value,
        standard_error,
    } = estimate;
    let below = if is_below { "yes" } else { "" };
    format!(
        "{start},{figure},{},{},{below}",
        digits(value),
        digits(standard_error)
    )
}

/// A number to five digits; nothing for one that is not known.
fn digits(value: f64) -> String {
    let rounded = format!("{value:.4e}").parse::<f64>().unwrap_or(value);
    if rounded.is_finite() {
        rounded.to_string()
    } else {
        String::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_have_a_field_per_column() {
        let line = row(
            "area,direct,glossy,uniform,equal samples,16",
            "MSE",
            Estimate {
                value: 0.123_456_7,
                standard_error: f64::NAN,
            },
            true,
        );
        assert_eq!(
            line,
            "area,direct,glossy,uniform,equal samples,16,MSE,0.12346,,yes"
        );
        assert_eq!(line.split(',').count(), HEADER.split(',').count());
        assert_eq!(
            [digits(1234.567), digits(2e-7), digits(0.0)],
            ["1234.6", "0.0000002", "0"]
        );
    }
}
