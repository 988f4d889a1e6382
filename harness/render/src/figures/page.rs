//! Page of the report, with its charts, tables and pictures.

use super::done::Done;
use super::map::{Map, scale};
use super::measure::{BySampler, Measured, Plan, SAMPLERS};
use super::panel::{Column, crops, panel};
use super::verdict::{self, BELOW, Gain, MEASURES, best, gain, headline, sentence, visible};
use super::{dual, models, rates};
use crate::args::Figures;
use crate::film::Crop;
use crate::lights::RectangleSampling;
use crate::numbers::Sequence;
use crate::picture::exposure;
use crate::protocol::{Measure, Runs};
use crate::transport::Integrator;
use hairis_instruments::error::Error;
use hairis_instruments::files::whole;
use hairis_instruments::machine;
use hairis_instruments::plot::{Axis, Bar, Series, bars, lines};
use hairis_instruments::report::{Drawing, Report, Section, literal};
use hairis_instruments::table::{Table, number};
use std::io::Write as _;
use std::path::Path;

/// Writes `report.html` with everything that is measured so far, and returns the page with its table of all scenes.
///
/// # Errors
///
/// Returns an error if the file cannot be written.
pub fn write(
    done: &Done,
    plan: &Plan,
    flags: &Figures,
    out: &Path,
) -> Result<(Report, Table), Error> {
    let path = out.join("report.html");
    let page = page(done, plan, flags).map_err(|source| Error::Output {
        path: path.clone(),
        source,
    })?;
    whole(&path, |out| out.write_all(page.html().as_bytes()))?;
    Ok((page, summary(&done.scenes)))
}

fn page(done: &Done, plan: &Plan, flags: &Figures) -> std::io::Result<Report> {
    let all = &*done.scenes;
    let machine = machine!();
    let mut sections = vec![Section::new("Summary").tables([summary(all)])];
    for measured in all {
        sections.push(section(measured)?);
    }
    if !done.presets.is_empty() {
        sections.push(models::section(&done.presets)?);
    }
    if !done.dual.is_empty() {
        sections.push(dual::section(&done.dual)?);
    }
    let Plan {
        side,
        strands,
        runs,
        sequence,
        rectangle_sampling,
        ..
    } = plan;
    let mut verdicts = vec![
        ["Machine".to_owned(), machine.in_words() + "."],
        [
            "Where the sampler does not matter".to_owned(),
            verdict::scenes(all),
        ],
    ];
    verdicts.extend(
        all.iter()
            .map(|measured| [literal(&measured.title()), headline(measured)]),
    );
    if !done.dual.is_empty() {
        verdicts.push(["Dual scattering".to_owned(), dual::sentence(&done.dual)]);
    }
    let method = Section::new("Method and machine")
        .paragraph(format!(
            "Pictures of {side} by {side} pixels, procedural hair of {strands} strands, sampled by \
             {}; light and BSDF samples are combined by the power heuristic, and rectangular lights are sampled {}. Each error \
             is the mean over {runs} pictures of different seeds, with a standard error by the jackknife.",
            numbers(*sequence),
            sampled(*rectangle_sampling)
        ))
        .paragraph(
            "Scenes of direct light have one fixed shading point per pixel, and as many light as BSDF samples there; all pictures, \
             and the reference, share the camera rays. In scenes of paths, each sample has a camera ray of its own.",
        )
        .paragraph(format!(
            "Visible: the share of rays towards lights that reach them, with light and BSDF samples of {}.",
            best(all)
        ))
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
        verdicts,
        summary: Some(overview(all)),
        sections,
        ..Report::default()
    })
}

/// Draws a bar chart of error times time by sampler and scene, relative to the best sampler.
fn overview(all: &[Measured]) -> Drawing {
    let measure = Measure::TrimmedRelMse;
    let axis = Axis::linear(format!(
        "{} × time, relative to {} (×)",
        measure.name(),
        best(all)
    ));
    let scenes: Vec<String> = all.iter().map(Measured::title).collect();
    let (mut series, mut left_out) = (Vec::new(), Vec::new());
    for name in others(all) {
        let mut gains: Vec<Bar> = Vec::new();
        for measured in all {
            let Some(sampler) = other(measured, name) else {
                gains.push(f64::NAN.into());
                continue;
            };
            let Gain { ratio, is_below } = gain(measured, sampler, measure);
            if is_below {
                left_out.push(format!("{name} in {}", literal(&measured.title())));
            }
            gains.push(if is_below {
                f64::NAN.into()
            } else {
                ratio.into()
            });
        }
        series.push((name.to_owned(), gains));
    }
    let caption = "Bars above 1: the best sampler of the model is ahead. Trimmed: without the worst 0.1 % of the pixels, where uniform sampling has \
                   most of its squared error.";
    let chart = bars("Samplers in each scene", axis, &scenes, &series, 1.0);
    Drawing::new("", chart, format!("{caption}{}", left_out_text(&left_out)))
}

/// Returns the samplers that are compared with the best of their scene, in any of the scenes.
fn others(all: &[Measured]) -> Vec<&'static str> {
    let is_other = |name: &&str| all.iter().any(|measured| other(measured, name).is_some());
    SAMPLERS.into_iter().filter(is_other).collect()
}

/// Finds a sampler of a scene by name, unless it is the best.
fn other<'a>(measured: &'a Measured, name: &str) -> Option<&'a BySampler> {
    let [others @ .., _] = measured.samplers.as_slice() else {
        return None;
    };
    others.iter().find(|one| one.name == name)
}

/// Returns a sentence that names the points that a chart leaves out, or nothing if there are none.
fn left_out_text(names: &[String]) -> String {
    if names.is_empty() {
        String::new()
    } else {
        format!(" Left out, below the reference: {}.", names.join(", "))
    }
}

/// Returns the table of error times time by scene, relative to the best sampler.
fn summary(all: &[Measured]) -> Table {
    let mut table = Table::new(format!("Error × time, relative to {}", best(all)))
        .texts(["scene", "light"])
        .numbers(["visible", "samples"]);
    for name in others(all) {
        table = table.numbers(MEASURES.map(|measure| format!("{name}, {}", measure.name())));
    }
    for measured in all {
        let shown = measured.shown();
        let Some(best) = measured.samplers.last() else {
            continue;
        };
        let visible = format!("{:.0} %", 100.0 * measured.visible);
        let mut row = vec![
            measured.title(),
            kind(measured).to_owned(),
            visible,
            best.runs[shown].samples.to_string(),
        ];
        for name in others(all) {
            let text = |measure| {
                other(measured, name).map_or_else(String::new, |sampler| {
                    gain(measured, sampler, measure).text()
                })
            };
            row.extend(MEASURES.map(text));
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

fn sampled(sampling: RectangleSampling) -> &'static str {
    match sampling {
        RectangleSampling::SolidAngle => "by solid angle",
        RectangleSampling::Area => "by area",
    }
}

/// Returns the light that a scene estimates, in words.
#[must_use]
pub(super) fn kind(measured: &Measured) -> &'static str {
    match measured.integrator {
        Integrator::Gather => "direct, at shading points",
        Integrator::Direct => "direct",
        Integrator::Path => "paths",
        Integrator::Dual => "dual scattering",
    }
}

/// Appends a mark to a number if the error it comes from is below the reference.
fn marked(runs: &Runs, measure: Measure, text: String) -> String {
    if runs.is_below_reference(measure) {
        text + BELOW
    } else {
        text
    }
}

fn section(measured: &Measured) -> std::io::Result<Section> {
    let title = literal(&measured.title());
    let shown = measured.shown();
    let at_samples: Vec<&Runs> = measured
        .samplers
        .iter()
        .map(|sampler| &sampler.runs[shown])
        .collect();
    let at_time: Vec<&Runs> = measured
        .samplers
        .iter()
        .map(|sampler| &sampler.equal_time)
        .collect();
    let maps = Maps::new(measured, &[at_samples.as_slice(), &at_time].concat());
    let samples = measured.samplers[0].runs[shown].samples;
    let caption = format!(
        "Squares: the parts that are shown below. Bias and noise are over {} pictures, relative to the reference, and on one scale \
         for all samplers and both figures of this scene.",
        at_samples[0].errors.len()
    );
    let (equal_samples, equal_time) = (
        maps.panel(measured, &at_samples)?,
        maps.panel(measured, &at_time)?,
    );
    let (chart, left_out) = convergence(measured);
    let convergence = format!(
        "relMSE against samples; bars are one standard error.{}",
        left_out_text(&left_out)
    );
    Ok(Section::new(title)
        .paragraph(format!(
            "Light: {}; hair: `{}`. {}",
            kind(measured),
            literal(&measured.hair),
            visible(measured)
        ))
        .paragraph(sentence(measured))
        .figures([
            Drawing::new(
                "",
                equal_samples,
                format!("Equal samples: {samples} per pixel. {caption}"),
            ),
            Drawing::new("", equal_time, format!("Equal time. {caption}")),
            Drawing::new("", chart, convergence),
        ])
        .tables([rates::table(measured), table(measured)]))
}

/// Crops and error maps that all panels of a scene share.
struct Maps {
    crops: [Crop; 2],
    maps: [Map; 2],
}

impl Maps {
    /// Chooses crops, and creates maps whose scales cover the errors of all runs.
    fn new(measured: &Measured, all: &[&Runs]) -> Self {
        let reference = &measured.reference;
        let bias: Vec<f64> = all
            .iter()
            .flat_map(|runs| reference.relative(&runs.bias))
            .collect();
        let squares: Vec<f64> = all
            .iter()
            .flat_map(|runs| reference.relative_squares(&runs.squares))
            .collect();
        let mut sums = vec![0.0; reference.picture.pixels.len()];
        for runs in all {
            sums.iter_mut()
                .zip(&runs.squares)
                .for_each(|(sum, square)| *sum += square);
        }
        let signed = Map::signed(
            "bias: the mean of all pictures, minus the reference",
            scale(bias.iter()),
            &[
                "blue: too dark, red: too bright;",
                "what noise leaves has both signs",
            ],
        );
        let squared = Map::squared(
            "noise: mean squared error of all pictures",
            scale(squares.iter()),
            &["by its logarithm"],
        );
        Self {
            crops: crops(&reference.picture, &sums),
            maps: [signed, squared],
        }
    }

    fn panel(&self, measured: &Measured, of: &[&Runs]) -> std::io::Result<String> {
        let reference = &measured.reference;
        let (title, remark) = ("reference".to_owned(), String::new());
        let mut columns = vec![Column {
            title,
            remark,
            picture: &reference.picture,
            errors: Vec::new(),
        }];
        for (sampler, runs) in measured.samplers.iter().zip(of) {
            let error = number::plain(runs.mean(Measure::RelMse).value, 3);
            columns.push(Column {
                title: sampler.name.to_owned(),
                remark: marked(
                    runs,
                    Measure::RelMse,
                    format!("{} samples, relMSE {error}", runs.samples),
                ),
                picture: &runs.picture,
                errors: vec![
                    reference.relative(&runs.bias),
                    reference.relative_squares(&runs.squares),
                ],
            });
        }
        panel(
            &columns,
            &self.crops,
            &self.maps,
            exposure(&reference.picture),
        )
    }
}

/// Draws error against samples, and returns the chart with the names of the points below the reference.
fn convergence(measured: &Measured) -> (String, Vec<String>) {
    let measure = Measure::RelMse;
    let point = |runs: &Runs| (f64::from(runs.samples), runs.mean(measure));
    let (mut series, mut left_out) = (Vec::new(), Vec::new());
    for sampler in &measured.samplers {
        let (below, clear): (Vec<&Runs>, Vec<&Runs>) = sampler
            .runs
            .iter()
            .partition(|runs| runs.is_below_reference(measure));
        left_out.extend(
            below
                .iter()
                .map(|runs| format!("{} at {} samples", sampler.name, runs.samples)),
        );
        series.push(Series::new(sampler.name, clear.into_iter().map(point)));
    }
    if let Some([first, .., last]) = measured.samplers.last().map(|sampler| &sampler.runs[..]) {
        let [(n, error), (end, _)] = [first, last].map(point);
        series.push(Series::guide(
            "slope −1",
            [(n, error.value), (end, error.value * n / end)],
        ));
    }
    (
        lines(
            "Convergence",
            Axis::log("samples per pixel"),
            Axis::log(measure.name()),
            &series,
        ),
        left_out,
    )
}

fn table(measured: &Measured) -> Table {
    let mut table = Table::new("Errors").texts(["sampler"]).numbers([
        "samples",
        "time (s)",
        "RMSE",
        "trimmed RMSE",
        "relMSE",
        "trimmed relMSE",
        "variance per sample",
    ]);
    let errors = [
        "MSE",
        "MSE × time",
        "relMSE × time",
        "trimmed relMSE × time",
    ];
    table = table.numbers(errors.map(|error| format!("{error}, relative to {}", measured.best())));
    for sampler in &measured.samplers {
        for (place, runs) in sampler.runs.iter().enumerate() {
            let best = measured
                .samplers
                .last()
                .map_or(runs, |best| &best.runs[place]);
            let root = |measure| {
                let root = runs.mean(measure).value.max(0.0).sqrt();
                marked(runs, measure, number::plain(root, 3))
            };
            let error = |measure| marked(runs, measure, number::estimate(&runs.mean(measure)));
            let numbers = [
                sampler.name.to_owned(),
                runs.samples.to_string(),
                number::plain(runs.seconds, 3),
                root(Measure::Mse),
                root(Measure::TrimmedMse),
                error(Measure::RelMse),
                error(Measure::TrimmedRelMse),
                number::estimate(&runs.variance),
                Gain::new(runs, best, Measure::Mse, false).text(),
            ];
            let with_time = MEASURES.map(|measure| Gain::new(runs, best, measure, true).text());
            table.push(numbers.into_iter().chain(with_time));
        }
    }
    table.note(
        "Variance per sample: of a pixel's luminance over the pictures, mean over the pixels, times the samples. Below the reference: \
         less than twice what noise of the reference adds.",
    )
}
