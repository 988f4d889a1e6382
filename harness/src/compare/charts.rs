//! Plots of a comparison, by section of the report.

use super::query::{THETA_O_DEG, v_gain};
use super::{Comparison, distinct};
use crate::efficiency::SAMPLERS;
use crate::figures;
use crate::sampler::Sampler;
use crate::speed::TimedOp;
use crate::subject::ModelKind;
use hairis::HairParams;
use hairis_instruments::plot::{Axis, Bar, Series, bars, lines};
use hairis_instruments::report::Drawing;
use hairis_instruments::sequence::{SequenceKind, XiSource};
use hairis_instruments::stats::Estimate;
use hairis_variants::{Cauchy, ModelId};

/// Number of points in each panel of the sample distributions.
const POINTS: usize = 2000;

/// Draws the Gaussian and the Cauchy bells, the models made of them, and the distribution of samples as in the paper's figure 5.
pub(super) fn models(of: &Comparison) -> Vec<Drawing> {
    let (params, theta_o) = (HairParams::bright(), 20_f64.to_radians());
    let mut numbers = SequenceKind::Halton.source(of.settings.seed, 0, 3, POINTS);
    let xi: Vec<[f32; 3]> = (0..POINTS).map(|_| numbers.next_xi_f32()).collect();
    let mut all = figures::bells().to_vec();
    all.push(figures::polar(
        &params,
        theta_o,
        &[("Cauchy (same widths)", Cauchy::PAPER)],
    ));
    all.push(figures::sample_distributions(&params, theta_o, &xi));
    all
}

/// Draws the verdicts in one plot: ratios of variances by light.
pub(super) fn summary(of: &Comparison) -> Drawing {
    let lights = &of.efficiency.settings.lights;
    let labels: Vec<String> = lights
        .iter()
        .map(|light| light.replace(['-', '_'], " "))
        .collect();
    let series = [
        ("Cauchy, published", (ModelKind::Cauchy, Sampler::Published)),
        ("Gaussian, matched", (ModelKind::Gaussian, Sampler::Matched)),
        ("Cauchy, matched", (ModelKind::Cauchy, Sampler::Matched)),
    ]
    .map(|(name, other)| {
        let gains = lights
            .iter()
            .map(|light| v_gain(of, light, other).unwrap_or(Estimate::UNKNOWN).into());
        (name.to_owned(), gains.collect())
    });
    let title = "Fewer samples than the published sampler on the Gaussian model";
    let chart = bars(title, Axis::log("V / V (×)"), &labels, &series, 1.0);
    let caption = format!(
        "By what factor the number of samples falls (above 1) or grows (below), by light; default hair seen from \
         {THETA_O_DEG}°."
    );
    Drawing::new("summary", chart, caption)
}

/// Draws the speed against the reference, one chart per model.
pub(super) fn speeds(of: &Comparison) -> Vec<Drawing> {
    let ops = [
        TimedOp::Prepare,
        TimedOp::EvalPdf,
        TimedOp::Sample,
        TimedOp::PointsMixed,
    ];
    let groups = ops.map(|op| op.label().to_owned());
    // The table has the other contenders.
    let shown = |contender| ["one lane", "eight lanes", "slices"].contains(&contender);
    let contenders = of
        .speed
        .rows
        .iter()
        .filter(|row| shown(row.contender))
        .map(|row| (row.contender, row.level));
    let contenders = distinct(contenders);
    let figure = |model: ModelId| {
        let title = format!(
            "Speed against the faster reference in f32, {} model",
            model.name()
        );
        let series: Vec<(String, Vec<Bar>)> = contenders
            .iter()
            .map(|(contender, level)| {
                let bar = |op| {
                    let row = of.speed.row(op, model.name(), contender, level);
                    row.map_or(f64::NAN.into(), |row| Bar {
                        value: row.ratio,
                        low: row.ratio_q1,
                        high: row.ratio_q3,
                    })
                };
                (format!("{contender}, {level}"), ops.map(bar).to_vec())
            })
            .collect();
        let chart = bars(
            &title,
            Axis::log("times as fast (×)"),
            &groups,
            &series,
            1.0,
        );
        let caption = "How many times as fast as the model's formulas in scalar f32 on the faster of two libraries, by operation: medians over the rounds, \
                       whiskers from the first to the third quartile.";
        Drawing::new(format!("speed-{}", model.name()), chart, caption)
    };
    ModelId::defaults_of_names().map(figure).collect()
}

/// Draws V against the width of the primary highlight.
pub(super) fn widths(of: &Comparison) -> Vec<Drawing> {
    let figure = |theta_o: &f64| {
        let mut series = Vec::new();
        for (dash, model) in ModelKind::ALL.into_iter().enumerate() {
            for sampler in SAMPLERS {
                let key = (*theta_o, model, sampler);
                let rows = of.efficiency.beta_sweep.iter();
                let rows = rows.filter(|row| (row.theta_o_deg, row.model, row.sampler) == key);
                let points = rows.map(|row| (f64::from(row.beta_r_deg), row.v));
                let name = format!("{}, {}", model.name(), sampler.name());
                series.push(Series::new(name, points).styled(sampler.color(), dash));
            }
        }
        let title = format!("Variance against width, θₒ = {theta_o}°");
        let (x, y) = (
            Axis::linear("β_R (°)"),
            Axis::log("relative variance of one sample V"),
        );
        let caption = format!(
            "Relative variance of one sample under constant light, seen from {theta_o}°, with β_TT = β_R/2 and \
             β_TRT = 2 β_R; error bars are one standard error."
        );
        Drawing::new(
            format!("variance-by-width-{theta_o}"),
            lines(&title, x, y, &series),
            caption,
        )
    };
    of.efficiency
        .settings
        .theta_o_deg
        .iter()
        .take(3)
        .map(figure)
        .collect()
}

/// Draws the error of the mean against the number of samples.
pub(super) fn convergence(of: &Comparison) -> Vec<Drawing> {
    let all = &of.efficiency.convergence;
    let figure = |light: &str, model: ModelKind| {
        let shown = || {
            all.iter()
                .filter(|point| (&*point.light, point.model) == (light, model))
        };
        let mut series = Vec::new();
        for sampler in SAMPLERS {
            for (dash, sequence) in SequenceKind::ALL.into_iter().enumerate() {
                let rows =
                    shown().filter(|point| (point.sampler, point.sequence) == (sampler, sequence));
                let name = format!("{}, {}", sampler.name(), sequence.name());
                series.push(
                    Series::new(name, rows.map(|p| (p.n as f64, p.rms)))
                        .styled(sampler.color(), dash),
                );
            }
        }
        if let Some(first) = shown().next() {
            let (n, rms) = (first.n as f64, first.rms.value);
            let last = shown().map(|point| point.n as f64).fold(n, f64::max);
            series.push(Series::guide(
                "slope −1/2",
                [(n, rms), (last, rms * (n / last).sqrt())],
            ));
        }
        let title = format!("Convergence, {} model, {light}", model.name());
        let chart = lines(
            &title,
            Axis::log("samples N"),
            Axis::log("root mean square relative error"),
            &series,
        );
        let caption = format!(
            "Error of the mean of N samples, {} model, light: {light}, θₒ = {}°, over independent randomisations; error \
             bars are one standard error.",
            model.name(),
            of.efficiency.settings.convergence_theta_o_deg
        );
        Drawing::new(
            format!("convergence-{}-{}", model.name(), slug(light)),
            chart,
            caption,
        )
    };
    let lights = distinct(all.iter().map(|point| point.light.as_str()));
    lights
        .into_iter()
        .flat_map(|light| ModelKind::ALL.map(|model| figure(light, model)))
        .collect()
}

/// Converts words to a part of a file name.
fn slug(words: &str) -> String {
    words
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .collect::<Vec<_>>()
        .join("-")
}
