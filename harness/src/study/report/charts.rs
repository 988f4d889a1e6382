//! The plots of a study: variance, efficiency, gains and weights.

use super::super::Cell;
use super::super::rows::Strategy;
use super::super::summary::Gain;
use super::super::times::PER_POINT;
use super::view::{Counted, Estimator, MANY, TOLD, View, ess};
use crate::plot::{Axis, Bar, BarChart, Dash, LineChart, Series};
use crate::report::Drawing;
use crate::sampler::Sampler;
use crate::stats::Estimate;
use crate::subject::ModelKind;

/// The light that everything sees.
const CONSTANT: usize = 0;

/// An axis of the grid that variances are shown over.
struct Over {
    slug: &'static str,
    label: &'static str,
    values: &'static [f32],
    of: fn(&Cell) -> f32,
}

/// V of every sampler over the width of R, and over the inclination.
pub(super) fn variances(of: &View<'_>) -> Vec<Drawing> {
    let axes = [
        Over { slug: "width", label: "width of R, β_R (°)", values: of.grid.beta_r_deg, of: |cell| cell.beta_r_deg },
        Over {
            slug: "inclination",
            label: "inclination of the viewer, θₒ (°)",
            values: of.grid.theta_o_deg,
            of: |cell| cell.theta_o_deg,
        },
    ];
    let mut figures = Vec::new();
    for over in &axes {
        for model in ModelKind::ALL {
            let title = format!("Variance over the {}, {} model", over.slug, model.title());
            let y = Axis::log("relative variance of a sample, V");
            let mut chart = LineChart::new(title, Axis::linear(over.label).from_zero(), y);
            for sampler in Sampler::ALL {
                let point = |value: &f32| {
                    let v = of.mean_v((model, sampler), CONSTANT, |cell| (over.of)(cell) == *value)?;
                    Some((f64::from(*value), v))
                };
                chart = chart.series(Series::new(sampler.name(), over.values.iter().filter_map(point)));
            }
            let caption = format!(
                "Relative variance of a sample under {} light by sampler: geometric means over the other axes of the \
                 grid. Bars are one standard error, mostly smaller than the marks. An error of 1% takes 10⁴ V samples.",
                of.lights[CONSTANT]
            );
            figures.push(Drawing::new(chart.svg(), caption).named(format!("v-by-{}-{}", over.slug, model.name())));
        }
    }
    figures
}

fn bar(of: Option<Estimate>) -> Bar {
    of.map_or(Bar::new(f64::NAN), |of| Bar::new(of.value).with_error(of.standard_error))
}

/// Efficiency by samples per shading point.
pub(super) fn efficiencies(of: &View<'_>) -> Vec<Drawing> {
    let figure = |model: ModelKind| {
        let title = format!("Efficiency under {} light, {} model", of.lights[CONSTANT], model.title());
        let groups = PER_POINT.map(|n| format!("{n} per shading point"));
        let mut chart = BarChart::new(title, Axis::log("1 / (V · µs)"), groups);
        for sampler in Sampler::ALL {
            let bars = PER_POINT.map(|n| bar(of.efficiency((model, sampler), CONSTANT, n)));
            chart = chart.series(sampler.name(), bars);
        }
        let caption = "Geometric mean over the grid of 1 / (V · time of a sample), the set-up of a shading point spread \
                       over 1, 4 or 16 samples; eight lanes, one thread, this machine. Whiskers are one standard error, \
                       that of the times included. Twice the efficiency is half the time to the same error squared.";
        Drawing::new(chart.svg(), caption).named(format!("efficiency-{}", model.name()))
    };
    ModelKind::ALL.map(figure).into()
}

/// A bar of a median, with the quartiles of its cells.
fn median_bar(of: Option<Gain>, time: Option<Estimate>) -> Bar {
    match (of, time) {
        (Some(gain), Some(time)) => {
            let [low, high] = gain.quartiles.map(|ratio| ratio * time.value);
            Bar::new(gain.median.value * time.value).with_interval(low, high)
        }
        _ => Bar::new(f64::NAN),
    }
}

/// Bars of V of one estimator over V of another, by light.
fn by_light(of: &View<'_>, base: Estimator, other: (ModelKind, Strategy), time: Timing) -> Vec<Bar> {
    let bar = |light| {
        let ratio = match (time, other.1.sampler()) {
            (None, _) => Some(Estimate::exact(1.0)),
            (Some(counted), Some(sampler)) => of.time_ratio(base, (other.0, sampler), light, counted),
            (Some(_), None) => None,
        };
        median_bar(of.gain(base, other, light), ratio)
    };
    (0..of.lights.len()).map(bar).collect()
}

/// Time that a gain counts; `None` for samples alone.
type Timing = Option<Counted>;

/// The verdicts in one plot: the Cauchy model against the Gaussian one, by light.
pub(super) fn summary(of: &View<'_>) -> Drawing {
    let title = "Samples: Gaussian model over Cauchy model";
    let mut chart = BarChart::new(title, Axis::log("V Gaussian / V Cauchy"), of.light_labels());
    for sampler in TOLD {
        let gain = |light| of.gain((ModelKind::Gaussian, sampler), (ModelKind::Cauchy, sampler), light);
        let bar = |light| Bar::new(gain(light).map_or(f64::NAN, |gain| gain.median.value));
        chart = chart.series(sampler.name(), (0..of.lights.len()).map(bar));
    }
    let caption = "By what factor the Cauchy model needs fewer samples (above 1) or more (below), by light: medians over the \
                   grid. The spread over its cells is shown below.";
    Drawing::new(chart.level(1.0).svg(), caption).named("summary")
}

/// Gains over `published` by light, a chart for each model: in samples, up to that of perfect sampling, or in equal time.
fn over_published(of: &View<'_>, time: Timing, strategies: &[Strategy], words: [&str; 4]) -> Vec<Drawing> {
    let [title, axis, slug, caption] = words;
    let figure = |model: ModelKind| {
        let mut chart = BarChart::new(format!("{title}, {} model", model.title()), Axis::log(axis), of.light_labels());
        for strategy in strategies.iter().filter(|strategy| strategy.sampler() != Some(Sampler::Published)) {
            chart = chart.series(strategy.name(), by_light(of, (model, Sampler::Published), (model, *strategy), time));
        }
        let caption = format!("{caption} Medians over the grid; whiskers go from the first to the third quartile.");
        Drawing::new(chart.level(1.0).svg(), caption).named(format!("{slug}-{}", model.name()))
    };
    ModelKind::ALL.map(figure).into()
}

/// Gains in V by light, over `published`, up to that of perfect sampling.
pub(super) fn limits(of: &View<'_>) -> Vec<Drawing> {
    let caption = "By what factor fewer samples than the published sampler needs, by light. That is also how many times its \
                   time a sample may take before it loses in equal time. `perfect` draws in proportion to S cos θᵢ, blind to \
                   the light. Under constant light nothing is left of its variance: no bar.";
    let words = ["Fewer samples than the published sampler", "V published / V (×)", "fewer-samples-by-light", caption];
    over_published(of, None, &Strategy::ALL, words)
}

/// Gains in equal time, by light: over `published`, without and with the look-up, then of the Cauchy model.
pub(super) fn gains(of: &View<'_>) -> Vec<Drawing> {
    let samplers = Sampler::ALL.map(Strategy::By);
    let axis = "gain over the published sampler in equal time (×)";
    let caption = format!(
        "By what factor less variance than the published sampler has in the same time, by light, at {MANY} samples per \
         shading point."
    );
    let with = format!("{caption} The time of a look-up of the light is added; one that was not timed has no bars.");
    let title = "Less variance than the published sampler in equal time";
    let mut figures = over_published(of, Some(Counted::Sample), &samplers, [title, axis, "gain-by-light", &caption]);
    let title = "Less variance than the published sampler in equal time, look-up included";
    figures.extend(over_published(of, Some(Counted::LookUp), &samplers, [title, axis, "gain-by-light-look-up", &with]));
    let mut chart = BarChart::new(
        "Less variance on the Cauchy model in equal time",
        Axis::log("Gaussian / Cauchy in equal time (×)"),
        of.light_labels(),
    );
    for sampler in Sampler::ALL {
        let pair = [(ModelKind::Gaussian, sampler), (ModelKind::Cauchy, sampler)];
        let bars = by_light(of, pair[0], (pair[1].0, sampler.into()), Some(Counted::Sample));
        chart = chart.series(sampler.name(), bars);
    }
    let caption = format!(
        "Variance on the Gaussian model over that on the Cauchy model with the same sampler in the same time, by light, at \
         {MANY} samples per shading point. Medians over the grid; whiskers go from the first to the third quartile."
    );
    figures.push(Drawing::new(chart.level(1.0).svg(), caption).named("cauchy-gain-by-light"));
    figures
}

/// A line in the colour that the sampler has in every chart.
fn of_sampler(sampler: Sampler, series: Series) -> Series {
    series.styled(sampler.color(), Dash::of(sampler.color()))
}

/// The share of cells whose gain is at most x.
fn distribution(name: &str, mut gains: Vec<f64>) -> Series {
    gains.retain(|gain| gain.is_finite() && *gain > 0.0);
    gains.sort_by(f64::total_cmp);
    let n = gains.len() as f64;
    // A few hundred points say as much as thousands.
    let every = gains.len().div_ceil(300).max(1);
    let points = gains.iter().enumerate().filter(|(i, _)| i % every == 0 || i + 1 == gains.len());
    let points: Vec<(f64, f64)> = points.map(|(i, gain)| (*gain, 100.0 * (i as f64 + 0.5) / n)).collect();
    Series::curve(name, points)
}

/// How gains spread over the cells.
pub(super) fn distributions(of: &View<'_>) -> Vec<Drawing> {
    let ratios = |base: Estimator, other: Estimator, light: usize| -> Vec<f64> {
        let ratio = |cell: Cell| of.v(cell.index, base, light).value / of.v(cell.index, other, light).value;
        of.each_cell().map(ratio).collect()
    };
    let share = || Axis::linear("cells with at most as much (%)").range(0.0, 100.0).step(20.0);
    let even = || Series::curve("as good", [(1.0, 0.0), (1.0, 100.0)]).styled(5, Dash::Dotted);
    let mut figures = Vec::new();
    for sampler in TOLD {
        let title = format!("Variance, Gaussian over Cauchy, with {}", sampler.name());
        let mut chart = LineChart::new(title, Axis::log("V Gaussian / V Cauchy"), share());
        let pair = ModelKind::ALL.map(|model| (model, sampler));
        for (light, name) in of.lights.iter().enumerate() {
            chart = chart.series(distribution(name, ratios(pair[0], pair[1], light)));
        }
        let caption = format!(
            "How the gain of the Cauchy model spreads over the {} cells of the grid with `{}`, by light: a line left of 1 \
             (the upright) is a cell where the Cauchy model needs more samples. The time of a sample is not in it.",
            of.cells.len(),
            sampler.name()
        );
        let figure = Drawing::new(chart.series(even()).svg(), caption);
        figures.push(figure.named(format!("cauchy-gain-over-cells-{}", sampler.name())));
    }
    for model in ModelKind::ALL {
        let title = format!("Variance of the published sampler over that of another, {} model", model.title());
        let mut chart = LineChart::new(title, Axis::log("V published / V sampler"), share());
        for sampler in Sampler::ALL.into_iter().filter(|sampler| *sampler != Sampler::Published) {
            let gains = ratios((model, Sampler::Published), (model, sampler), CONSTANT);
            chart = chart.series(of_sampler(sampler, distribution(sampler.name(), gains)));
        }
        let caption = format!(
            "How the gain over the published sampler spreads over the {} cells of the grid under {} light: left of 1 (the \
             upright) the sampler needs more samples than `published`. The time of a sample is not in it.",
            of.cells.len(),
            of.lights[CONSTANT]
        );
        let figure = Drawing::new(chart.series(even()).svg(), caption);
        figures.push(figure.named(format!("gain-over-cells-{}", model.name())));
    }
    figures
}

/// Effective samples and largest weights.
pub(super) fn weights(of: &View<'_>) -> Vec<Drawing> {
    let mut figures = Vec::new();
    for model in ModelKind::ALL {
        let title = format!("Effective samples in 1000, {} model", model.title());
        let y = Axis::linear("effective samples in 1000");
        let mut chart = BarChart::new(title, y, of.light_labels());
        for strategy in Strategy::ALL {
            let mean = |light| Some(of.mean_of((model, strategy), light, ess));
            chart = chart.series(strategy.name(), (0..of.lights.len()).map(|light| bar(mean(light))));
        }
        let caption = "1000 / (1 + V): how many samples without variance are worth as much as 1000 of the sampler. \
                       `perfect` would draw in proportion to S cos θᵢ, blind to the light. Means over the grid; whiskers \
                       are one standard error.";
        figures.push(Drawing::new(chart.svg(), caption).named(format!("effective-samples-{}", model.name())));
    }
    for model in ModelKind::ALL {
        let title = format!("Largest weight, {} model", model.title());
        let x = Axis::linear("inclination of the viewer, θₒ (°)").from_zero();
        let mut chart = LineChart::new(title, x, Axis::log("largest weight / albedo"));
        for sampler in Sampler::ALL {
            let worst = |theta_o: &f32| {
                let cells = of.each_cell().filter(|cell| cell.theta_o_deg == *theta_o);
                let most = cells.map(|cell| {
                    let found = of.measured(cell.index, (model, sampler), CONSTANT);
                    found.max_weight / found.figures.mean.value
                });
                (f64::from(*theta_o), most.fold(0.0, f64::max))
            };
            chart = chart.series(Series::new(sampler.name(), of.grid.theta_o_deg.iter().map(worst)));
        }
        let caption = "The largest weight S cos θᵢ / pdf of any sample in the worst cell of each inclination, in units of \
                       the albedo: what a firefly under constant light would be. It is the largest of those drawn, and \
                       so has no error bar; more samples can only raise it.";
        figures.push(Drawing::new(chart.svg(), caption).named(format!("largest-weight-{}", model.name())));
    }
    figures.extend(bounds(of));
    figures
}

/// Largest weights over their proven bounds, a chart for each model.
fn bounds(of: &View<'_>) -> Vec<Drawing> {
    let chart = |model: ModelKind| {
        let title = format!("Largest weight over its proven bound, {} model", model.title());
        let mut chart = LineChart::new(title, Axis::linear("θₒ (°)"), Axis::linear("largest weight / bound"));
        for sampler in Sampler::ALL {
            let share = |cell: &Cell| {
                let share = of.measured(cell.index, (model, sampler), CONSTANT).max_weight
                    / of.bounds.of(cell.index, model, sampler);
                share.is_finite().then_some(share)
            };
            let worst = |theta_o: &f32| {
                let cells = of.each_cell().filter(|cell| cell.theta_o_deg == *theta_o);
                let most = cells.filter_map(|cell| share(&cell)).reduce(f64::max)?;
                Some((f64::from(*theta_o), most))
            };
            let points: Vec<(f64, f64)> = of.grid.theta_o_deg.iter().filter_map(worst).collect();
            if !points.is_empty() {
                chart = chart.series(of_sampler(sampler, Series::new(sampler.name(), points)));
            }
        }
        let caption = "For samplers with a bound in closed form: the largest weight drawn over the bound, in the worst cell of \
                       each inclination. A point above 1 would fail the run.";
        Drawing::new(chart.reference("the bound", 0.0, (1.0, 1.0)).svg(), caption)
            .named(format!("weight-bound-{}", model.name()))
    };
    ModelKind::ALL.map(chart).into()
}
