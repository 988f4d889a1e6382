//! The page.

use super::measure::{BySampler, Measured, Plan};
use super::models::{self, Preset};
use super::panel::{Column, panel};
use super::verdict::{ERRORS, gain, headline, sentence, visible};
use crate::args::Figures;
use crate::numbers::Sequence;
use crate::picture::exposure;
use crate::protocol::{Runs, slope};
use crate::transport::Integrator;
use hairis_harness::error::Error;
use hairis_harness::files::whole;
use hairis_harness::machine::Machine;
use hairis_harness::plot::{Axis, Series, bars, lines};
use hairis_harness::report::{Drawing, Report, Section};
use hairis_harness::stats::Estimate;
use hairis_harness::table::{Table, number};
use std::io::Write as _;
use std::path::Path;

/// Writes `report.html`.
pub(super) fn write(
    all: &[Measured],
    presets: &[Preset],
    plan: &Plan,
    flags: &Figures,
    out: &Path,
) -> Result<(), Error> {
    let path = out.join("report.html");
    let page = page(all, presets, plan, flags).map_err(|source| Error::Output { path: path.clone(), source })?;
    whole(&path, |out| out.write_all(page.html().as_bytes()))
}

fn page(all: &[Measured], presets: &[Preset], plan: &Plan, flags: &Figures) -> std::io::Result<Report> {
    let machine = Machine::current();
    let mut sections = vec![Section::new("Summary").tables([summary(all)])];
    for measured in all {
        sections.push(section(measured)?);
    }
    if !presets.is_empty() {
        sections.push(models::section(presets)?);
    }
    let Plan { side, strands, runs, sequence, .. } = plan;
    let method = Section::new("Method and machine")
        .paragraph(format!(
            "Pictures of {side} by {side} pixels, procedural hair of {strands} strands, published model, sampled by \
             {}; light and BSDF samples are combined by the power heuristic. Each error is the mean over {runs} pictures of \
             different seeds, with a standard error by the jackknife.",
            numbers(*sequence)
        ))
        .paragraph(
            "Scenes of direct light have one fixed shading point per pixel, and as many light as BSDF samples there; all pictures, \
             and the reference, share the camera rays. In scenes of paths, each sample has a camera ray of its own.",
        )
        .paragraph("Visible: the share of rays towards lights that reach them, with light and BSDF samples of `matched`.")
        .paragraph(
            "relMSE is the mean of (a − b)² / (b² + (0.1 mean)²) in luminance; the noise of the reference, known from two \
             halves of it, is subtracted. Uniform sampling has few pixels of very large error, so that its relMSE is uncertain: \
             the trimmed one leaves out the worst 0.1 % of the pixels. Time is that of the threads, the least of all pictures.",
        )
        .facts(&[["Machine", &machine.summary()], ["Seed", &flags.seed.to_string()]]);
    sections.push(method);
    Ok(Report {
        title: "What samplers are worth on pictures of hair".to_owned(),
        subtitle: machine.summary(),
        verdicts: all.iter().map(|measured| [measured.title(), headline(measured)]).collect(),
        summary: Some(overview(all)),
        sections,
        ..Report::default()
    })
}

/// The error of each sampler in each scene.
fn overview(all: &[Measured]) -> Drawing {
    let (name, error) = ERRORS[2];
    let axis = Axis::linear(format!("{name} × time, relative to matched (×)"));
    let scenes: Vec<String> = all.iter().map(Measured::title).collect();
    // All scenes have the same samplers; the last is the one that the others are relative to.
    let samplers = all.first().map_or(&[][..], |first| first.samplers.as_slice());
    let others = samplers.len().saturating_sub(1);
    let of_sampler = |(place, sampler): (usize, &BySampler)| {
        let gains = all.iter().map(|measured| gain(measured, &measured.samplers[place], error).into());
        (sampler.name.to_owned(), gains.collect())
    };
    let series: Vec<_> = samplers.iter().take(others).enumerate().map(of_sampler).collect();
    Drawing::new(
        "",
        bars("Samplers in each scene", axis, &scenes, &series, 1.0),
        "Bars above 1: `matched` is ahead. Trimmed: without the worst 0.1 % of the pixels, where uniform \
                               sampling has most of its squared error.",
    )
}

/// How many times as large errors times time are, scene by scene.
fn summary(all: &[Measured]) -> Table {
    let mut table =
        Table::new("Error × time, relative to matched").texts(["scene", "light"]).numbers(["visible", "samples"]);
    let Some(first) = all.first() else { return table };
    for sampler in first.samplers.iter().rev().skip(1).rev() {
        table = table.numbers(ERRORS.map(|(error, _)| format!("{}, {error}", sampler.name)));
    }
    for measured in all {
        let shown = measured.shown();
        let Some(best) = measured.samplers.last() else { continue };
        let visible = format!("{:.0} %", 100.0 * measured.visible);
        let mut row = vec![measured.title(), kind(measured).to_owned(), visible, best.runs[shown].samples.to_string()];
        for sampler in measured.samplers.iter().rev().skip(1).rev() {
            row.extend(ERRORS.map(|(_, error)| ratio(gain(measured, sampler, error))));
        }
        table.push(row);
    }
    table
}

fn numbers(sequence: Sequence) -> &'static str {
    match sequence {
        Sequence::Independent => "independent numbers",
        Sequence::Halton => "scrambled Halton points",
        Sequence::Sobol => "Owen-scrambled Sobol' points",
        Sequence::Stratified => "stratified points",
    }
}

fn kind(measured: &Measured) -> &'static str {
    match measured.integrator {
        Integrator::Gather => "direct, at shading points",
        Integrator::Direct => "direct",
        Integrator::Path => "paths",
    }
}

fn ratio(estimate: Estimate) -> String {
    number::ratio_with_error(estimate.value, estimate.standard_error)
}

fn estimate(estimate: Estimate) -> String {
    number::with_error(estimate.value, estimate.standard_error)
}

fn section(measured: &Measured) -> std::io::Result<Section> {
    let title = measured.title();
    let shown = measured.shown();
    let equal_samples = panel_of(measured, |sampler| &sampler.runs[shown])?;
    let equal_time = panel_of(measured, |sampler| &sampler.equal_time)?;
    let samples = measured.samplers[0].runs[shown].samples;
    let caption = "Below: the brightest part, 4 times as large; and the relative error of each pixel, blue too dark, red too \
                   bright, on one scale on this page (full colour at 100 %).";
    Ok(Section::new(title.clone())
        .paragraph(format!("Light: {}; hair: `{}`. {}", kind(measured), measured.preset, visible(measured)))
        .paragraph(sentence(measured))
        .figures([
            Drawing::new("", equal_samples, format!("Equal samples: {samples} per pixel. {caption}")),
            Drawing::new("", equal_time, format!("Equal time. {caption}")),
            Drawing::new("", convergence(measured), "relMSE against samples; bars are one standard error."),
        ])
        .tables([table(measured)]))
}

fn panel_of<'a>(measured: &'a Measured, pick: impl Fn(&'a BySampler) -> &'a Runs) -> std::io::Result<String> {
    let reference = &measured.reference;
    let mut columns = vec![Column {
        title: "reference".to_owned(),
        remark: String::new(),
        picture: &reference.picture,
        errors: None,
    }];
    for sampler in &measured.samplers {
        let runs = pick(sampler);
        let error = runs.mean(|errors| errors.relative).value;
        columns.push(Column {
            title: sampler.name.to_owned(),
            remark: format!("{} samples, relMSE {}", runs.samples, number::plain(error, 3)),
            picture: &runs.picture,
            errors: Some(reference.signed(&runs.picture)),
        });
    }
    panel(&columns, exposure(&reference.picture))
}

fn convergence(measured: &Measured) -> String {
    let point = |runs: &Runs| (f64::from(runs.samples), runs.mean(|errors| errors.relative));
    let of_sampler = |sampler: &BySampler| Series::new(sampler.name, sampler.runs.iter().map(point));
    let mut series: Vec<Series> = measured.samplers.iter().map(of_sampler).collect();
    if let Some([first, .., last]) = measured.samplers.last().map(|sampler| &sampler.runs[..]) {
        let [(n, error), (end, _)] = [first, last].map(point);
        series.push(Series::guide("slope −1", [(n, error.value), (end, error.value * n / end)]));
    }
    lines("Convergence", Axis::log("samples per pixel"), Axis::log("relMSE"), &series)
}

fn table(measured: &Measured) -> Table {
    let mut table = Table::new("Errors").texts(["sampler"]).numbers([
        "samples",
        "relMSE",
        "trimmed",
        "RMSE",
        "time (s)",
        "MSE, relative to matched",
        "MSE × time, relative to matched",
        "relMSE × time, relative to matched",
        "trimmed × time, relative to matched",
        "slope",
    ]);
    for sampler in &measured.samplers {
        for (place, runs) in sampler.runs.iter().enumerate() {
            let best = measured.samplers.last().map_or(runs, |best| &best.runs[place]);
            let below = if runs.is_below_reference() { " (below the reference)" } else { "" };
            let points: Vec<(f64, f64)> = sampler.runs[..=place]
                .iter()
                .map(|runs| (f64::from(runs.samples), runs.mean(|errors| errors.relative).value))
                .collect();
            let with_time = ERRORS.map(|(_, error)| ratio(runs.ratio(best, error, true)));
            let numbers = [
                sampler.name.to_owned(),
                runs.samples.to_string(),
                estimate(runs.mean(|errors| errors.relative)) + below,
                estimate(runs.mean(|errors| errors.trimmed)),
                number::plain(runs.mean(|errors| errors.square).value.max(0.0).sqrt(), 3),
                number::plain(runs.seconds, 3),
                ratio(runs.ratio(best, |errors| errors.square, false)),
            ];
            let slope = if place == 0 { String::new() } else { number::plain(slope(&points), 3) };
            table.push(numbers.into_iter().chain(with_time).chain([slope]));
        }
    }
    table
        .note("Slope: of log relMSE against log samples, from the first count to this one; −1 for independent samples.")
}
