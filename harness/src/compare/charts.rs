//! The plots of a comparison.

use super::page::v_gain;
use super::{Comparison, distinct};
use crate::efficiency::SAMPLERS;
use crate::figures;
use crate::plot::{Axis, Bar, BarChart, Dash, LineChart, Series};
use crate::report::Drawing;
use crate::sampler::Sampler;
use crate::sequence::{SequenceKind, XiSource};
use crate::speed::Op;
use crate::subject::ModelKind;
use hairis::HairParams;
use hairis_variants::{Cauchy, ModelId};

/// Points of each panel of the sample distributions.
const POINTS: usize = 2000;

/// The Gaussian and the Cauchy bells, and the models made of them.
pub(super) fn models() -> Vec<Drawing> {
    let params = HairParams::default();
    vec![
        figures::normalised_bells(),
        figures::unit_bells(),
        figures::polar(&params, 20_f64.to_radians(), &[("Cauchy (same widths)", Cauchy::PAPER)]),
    ]
}

/// The verdicts in one plot: ratios of variances by light.
pub(super) fn summary(of: &Comparison) -> Drawing {
    let lights = &of.efficiency.settings.lights;
    let labels = lights.iter().map(|light| light.replace(['-', '_'], " "));
    let title = "Fewer samples than the published sampler on the Gaussian model";
    let mut chart = BarChart::new(title, Axis::log("V / V (×)"), labels).level(1.0);
    for (name, other) in [
        ("Cauchy, published", (ModelKind::Cauchy, Sampler::Published)),
        ("Gaussian, matched", (ModelKind::Gaussian, Sampler::Matched)),
        ("Cauchy, matched", (ModelKind::Cauchy, Sampler::Matched)),
    ] {
        chart = chart.series(name, lights.iter().map(|light| Bar::new(v_gain(of, light, other).unwrap_or(f64::NAN))));
    }
    let caption = format!(
        "By what factor the number of samples falls (above 1) or grows (below), by light; default hair seen from {}°.",
        super::page::THETA_O_DEG
    );
    Drawing::new(chart.svg(), caption).named("summary")
}

/// Where samples go: the paper's figure 5.
pub(super) fn distributions(of: &Comparison) -> Drawing {
    let mut numbers = SequenceKind::Halton.source(of.settings.seed, 0, 3, POINTS);
    let xi: Vec<[f32; 3]> = (0..POINTS).map(|_| numbers.next_xi_f32()).collect();
    figures::sample_distributions(&HairParams::default(), 20_f64.to_radians(), &xi)
}

/// Speed against the textbook, a chart per model.
pub(super) fn speeds(of: &Comparison) -> Vec<Drawing> {
    let ops = [Op::Prepare, Op::EvalPdf, Op::Sample, Op::PointsMixed];
    // The rest is in the table.
    let shown = |contender| ["one lane", "eight lanes", "slices"].contains(&contender);
    let contenders =
        of.speed.rows.iter().map(|row| (row.contender, row.level)).filter(|(contender, _)| shown(*contender));
    let contenders = distinct(contenders);
    let figure = |model: ModelId| {
        let title = format!("Speed against the faster textbook in f32, {} model", model.name());
        let mut chart = BarChart::new(title, Axis::log("times as fast (×)"), ops.map(Op::label)).level(1.0);
        for (contender, level) in &contenders {
            let bar = |op| {
                let row = of.speed.row(op, model.name(), contender, level);
                row.map_or(Bar::new(f64::NAN), |row| Bar::new(row.ratio).with_interval(row.ratio_q1, row.ratio_q3))
            };
            chart = chart.series(format!("{contender}, {level}"), ops.map(bar));
        }
        let caption = "How many times as fast as the model's formulas in scalar f32 on the faster of two libraries, by operation: medians over the rounds, \
                       whiskers from the first to the third quartile.";
        Drawing::new(chart.svg(), caption).named(format!("speed-{}", model.name()))
    };
    ModelId::defaults_of_names().map(figure).collect()
}

/// V against the width of the primary highlight.
pub(super) fn widths(of: &Comparison) -> Vec<Drawing> {
    let figure = |theta_o: &f64| {
        let title = format!("Variance against width, θₒ = {theta_o}°");
        let y = Axis::log("relative variance of one sample V");
        let mut chart = LineChart::new(title, Axis::linear("β_R (°)").from_zero(), y);
        for (dash, model) in ModelKind::ALL.into_iter().enumerate() {
            for sampler in SAMPLERS {
                let rows = of.efficiency.beta_sweep.iter().filter(|row| row.theta_o_deg == *theta_o);
                let points = rows
                    .filter(|row| (row.model, row.sampler) == (model, sampler))
                    .map(|row| (f64::from(row.beta_r_deg), row.v));
                let series = Series::new(format!("{}, {}", model.name(), sampler.name()), points);
                chart = chart.series(series.styled(sampler.color(), Dash::of(dash)));
            }
        }
        let caption = format!(
            "Relative variance of one sample under constant light, seen from {theta_o}°, with β_TT = β_R/2 and \
             β_TRT = 2 β_R; error bars are one standard error."
        );
        Drawing::new(chart.svg(), caption).named(format!("variance-by-width-{theta_o}"))
    };
    of.efficiency.settings.theta_o_deg.iter().take(3).map(figure).collect()
}

/// The error of the mean against the number of samples.
pub(super) fn convergence(of: &Comparison) -> Vec<Drawing> {
    let all = &of.efficiency.convergence;
    let figure = |light: &str, model: ModelKind| {
        let points = |sampler, sequence| {
            let of_line = (model, sampler, sequence);
            let rows = all.iter().filter(move |p| (p.model, p.sampler, p.sequence) == of_line && p.light == light);
            rows.map(|p| (p.n as f64, p.rms))
        };
        let title = format!("Convergence, {} model, {light}", model.name());
        let mut chart = LineChart::new(title, Axis::log("samples N"), Axis::log("root mean square relative error"));
        for sampler in SAMPLERS {
            for (dash, sequence) in SequenceKind::ALL.into_iter().enumerate() {
                let name = format!("{}, {}", sampler.name(), sequence.name());
                let series = Series::new(name, points(sampler, sequence));
                chart = chart.series(series.styled(sampler.color(), Dash::of(dash)));
            }
        }
        if let Some(first) = all.iter().find(|p| (p.model, p.light.as_str()) == (model, light)) {
            chart = chart.reference("slope −1/2", -0.5, (first.n as f64, first.rms.value));
        }
        let caption = format!(
            "Error of the mean of N samples, {} model, light: {light}, θₒ = {}°, over independent randomisations; error \
             bars are one standard error.",
            model.name(),
            of.efficiency.settings.convergence_theta_o_deg
        );
        Drawing::new(chart.svg(), caption).named(format!("convergence-{}-{}", model.name(), slug(light)))
    };
    let lights = distinct(all.iter().map(|point| point.light.as_str()));
    lights.into_iter().flat_map(|light| ModelKind::ALL.map(|model| figure(light, model))).collect()
}

/// Words as part of a file's name.
fn slug(words: &str) -> String {
    words.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect::<Vec<_>>().join("-")
}
