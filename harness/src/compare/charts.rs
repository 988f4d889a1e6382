//! The plots of a comparison.

use super::Comparison;
use super::page::v_ratio;
use crate::efficiency::SAMPLERS;
use crate::figures;
use crate::plot::{Axis, Bar, BarChart, Dash, LineChart, Point, ReferenceLine, Series};
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
    let published = (ModelKind::Gaussian, Sampler::Published);
    let bars = |other| {
        let bar = move |light: &String| Bar::new(v_ratio(of, light, published, other).unwrap_or(f64::NAN));
        lights.iter().map(bar)
    };
    let chart =
        BarChart::new("Fewer samples than the published sampler on the Gaussian model", Axis::log("V / V (×)"), labels)
            .narrow()
            .series("Cauchy, published", bars((ModelKind::Cauchy, Sampler::Published)))
            .series("Gaussian, matched", bars((ModelKind::Gaussian, Sampler::Matched)))
            .series("Cauchy, matched", bars((ModelKind::Cauchy, Sampler::Matched)));
    let caption = format!(
        "By what factor the number of samples falls (above 1) or grows (below), by light; default hair seen from {}°.",
        super::page::THETA_O_DEG
    );
    Drawing::new(chart.level(1.0).svg(), caption).named("summary")
}

/// Where samples go: the paper's figure 5.
pub(super) fn distributions(of: &Comparison) -> Drawing {
    let mut numbers = SequenceKind::Halton.source(of.settings.seed, 0, 3, POINTS);
    let xi: Vec<[f32; 3]> = (0..POINTS).map(|_| numbers.next_xi_f32()).collect();
    figures::sample_distributions(&HairParams::default(), 20_f64.to_radians(), xi.into_iter())
}

/// Speed against the textbook, a chart per model.
pub(super) fn speeds(of: &Comparison) -> Vec<Drawing> {
    let ops = [Op::Prepare, Op::EvalPdf, Op::Sample, Op::PointsMixed];
    let mut contenders: Vec<(&str, &str)> = Vec::new();
    for row in of.speed.rows.iter().filter(|row| row.contender != "textbook") {
        // The rest is in the table.
        let shown = ["one lane", "eight lanes", "slices"].contains(&row.contender);
        if shown && !contenders.contains(&(row.contender, row.level)) {
            contenders.push((row.contender, row.level));
        }
    }
    let figure = |model: ModelId| {
        let title = format!("Speed against the faster textbook in f32, {} model", model.name());
        let mut chart = BarChart::new(title, Axis::log("times as fast (×)"), ops.map(Op::label));
        for (contender, level) in &contenders {
            let bar = |op| {
                let row = of.speed.row(op, model.name(), contender, level);
                row.map_or(Bar::new(f64::NAN), |row| Bar::new(row.ratio).with_interval(row.ratio_q1, row.ratio_q3))
            };
            chart = chart.series(format!("{contender}, {level}"), ops.map(bar));
        }
        let caption = "How many times as fast as the model's formulas in scalar f32 on the faster of two libraries, by operation: medians over the rounds, \
                       whiskers from the first to the third quartile.";
        Drawing::new(chart.level(1.0).svg(), caption).named(format!("speed-{}", model.name()))
    };
    ModelId::defaults_of_names().map(figure).collect()
}

/// V against the width of the primary highlight.
pub(super) fn widths(of: &Comparison) -> Vec<Drawing> {
    of.efficiency
        .settings
        .theta_o_deg
        .iter()
        .take(3)
        .map(|theta_o| {
            let title = format!("Variance against width, θₒ = {theta_o}°");
            let mut chart = LineChart::new(
                title,
                Axis::linear("β_R (°)").from_zero(),
                Axis::log("relative variance of one sample V"),
            );
            for (dash, model) in ModelKind::ALL.into_iter().enumerate() {
                for sampler in SAMPLERS {
                    let rows = of
                        .efficiency
                        .beta_sweep
                        .iter()
                        .filter(|row| (row.model, row.sampler) == (model, sampler) && row.theta_o_deg == *theta_o);
                    let points = rows
                        .map(|row| Point::new(f64::from(row.beta_r_deg), row.v.value).with_error(row.v.standard_error));
                    let series = Series::new(format!("{}, {}", model.name(), sampler.name()), points);
                    chart = chart.series(series.styled(sampler.color(), Dash::of(dash)));
                }
            }
            Drawing::new(
                chart.svg(),
                format!(
                    "Relative variance of one sample under constant light, seen from {theta_o}°, with β_TT = β_R/2 and \
                 β_TRT = 2 β_R; error bars are one standard error."
                ),
            )
            .named(format!("variance-by-width-{theta_o}"))
        })
        .collect()
}

/// The error of the mean against the number of samples.
pub(super) fn convergence(of: &Comparison) -> Vec<Drawing> {
    let mut lights: Vec<&str> = Vec::new();
    for point in &of.efficiency.convergence {
        if !lights.contains(&point.light.as_str()) {
            lights.push(&point.light);
        }
    }
    let mut figures = Vec::new();
    for light in lights {
        for model in ModelKind::ALL {
            let title = format!("Convergence, {} model, {light}", model.name());
            let mut chart = LineChart::new(title, Axis::log("samples N"), Axis::log("root mean square relative error"));
            let mut first = None;
            for sampler in SAMPLERS {
                for (dash, sequence) in SequenceKind::ALL.into_iter().enumerate() {
                    let points: Vec<Point> = of
                        .efficiency
                        .convergence
                        .iter()
                        .filter(|p| (p.model, p.sampler, p.sequence) == (model, sampler, sequence) && p.light == light)
                        .map(|p| {
                            #[expect(clippy::cast_precision_loss, reason = "at most 4096 samples")]
                            let n = p.n as f64;
                            first.get_or_insert((n, p.rms.value));
                            Point::new(n, p.rms.value).with_error(p.rms.standard_error)
                        })
                        .collect();
                    let series = Series::new(format!("{}, {}", sampler.name(), sequence.name()), points);
                    chart = chart.series(series.styled(sampler.color(), Dash::of(dash)));
                }
            }
            if let Some(through) = first {
                chart =
                    chart.reference(ReferenceLine::Power { label: "slope −1/2".to_owned(), slope: -0.5, through });
            }
            figures.push(
                Drawing::new(
                    chart.svg(),
                    format!(
                        "Error of the mean of N samples, {} model, light: {light}, θₒ = {}°, over independent \
                     randomisations; error bars are one standard error.",
                        model.name(),
                        of.efficiency.settings.convergence_theta_o_deg
                    ),
                )
                .named(format!("convergence-{}-{}", model.name(), slug(light))),
            );
        }
    }
    figures
}

/// Words as part of a file's name.
fn slug(words: &str) -> String {
    words.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect::<Vec<_>>().join("-")
}
