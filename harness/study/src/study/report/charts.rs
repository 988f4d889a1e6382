//! Plots of a study: variance, efficiency, gains and weights.

use super::super::estimator::{Estimator, TOLD, name, published, samplers, strategies};
use super::super::finished::Study;
use super::super::grid::GridAxis;
use super::super::rows::Row;
use super::super::summary::on_gaussian;
use super::super::view::{Counted, Gain, MANY, mean_v};
use hairis_harness::sampler::Sampler;
use hairis_harness::subject::ModelKind;
use hairis_harness::times::PER_POINT;
use hairis_instruments::light::Constant;
use hairis_instruments::plot::{Axis, Bar, Series, bars, lines};
use hairis_instruments::report::Drawing;
use hairis_instruments::stats::Estimate;

/// Last sentence in captions of charts that use [`median_bar`].
pub(super) const MEDIANS: &str =
    "Medians over the grid; whiskers go from the first to the third quartile.";

/// Draws one chart per model. The model's name ends that of the file.
pub(super) fn each_model(
    slug: &str,
    caption: &str,
    svg: &dyn Fn(ModelKind) -> String,
) -> Vec<Drawing> {
    ModelKind::ALL
        .map(|model| Drawing::new(format!("{slug}-{}", model.name()), svg(model), caption))
        .into()
}

/// Returns the runnable samplers on a model.
pub(super) fn samplers_on(model: ModelKind) -> impl Iterator<Item = Estimator> + Clone {
    samplers().map(move |strategy| (model, strategy))
}

/// Returns a bar for a median, with the quartiles of its cells, times a factor.
pub(super) fn median_bar(of: Option<Gain>, factor: f64) -> Bar {
    of.map_or(
        f64::NAN.into(),
        |Gain {
             median,
             quartiles: [low, high],
             ..
         }| Bar {
            value: median.value * factor,
            low: low * factor,
            high: high * factor,
        },
    )
}

/// Draws V of every sampler over the width of R, and over the inclination.
pub(super) fn variances(of: &Study) -> Vec<Drawing> {
    let axes = [
        ("width", "width of R, β_R (°)", of.grid().widths()),
        (
            "inclination",
            "inclination of the viewer, θₒ (°)",
            of.grid().inclinations(),
        ),
    ];
    let caption = format!(
        "Relative variance of a sample under {} light by sampler: geometric means over the other axes of the grid. Bars are \
         one standard error, mostly smaller than the marks. An error of 1% takes 10⁴ V samples.",
        Constant::NAME
    );
    let charts = |(slug, label, (values, axis)): (&str, &str, GridAxis)| {
        each_model(&format!("v-by-{slug}"), &caption, &|model| {
            let series = samplers_on(model).map(|estimator| {
                let point = |value: &f32| {
                    let rows = of
                        .rows_of(estimator, of.constant())
                        .filter(|row| axis(&row.cell) == *value);
                    mean_v(rows).map(|v| (f64::from(*value), v))
                };
                Series::new(name(estimator.1), values.iter().filter_map(point))
            });
            let series: Vec<Series> = series.collect();
            let title = format!("Variance over the {slug}, {} model", model.title());
            lines(
                &title,
                Axis::linear(label),
                Axis::log("relative variance of a sample, V"),
                &series,
            )
        })
    };
    axes.into_iter().flat_map(charts).collect()
}

/// Draws the efficiency by samples per shading point.
pub(super) fn efficiencies(of: &Study) -> Vec<Drawing> {
    let caption = "Geometric mean over the grid of 1 / (V · time of a sample), the set-up of a shading point spread over 1, 4 or \
                   16 samples; eight lanes, one thread, this machine. Whiskers are one standard error, that of the times \
                   included. Twice the efficiency is half the time to the same error squared.";
    each_model("efficiency", caption, &|model| {
        let title = format!(
            "Efficiency under {} light, {} model",
            Constant::NAME,
            model.title()
        );
        let groups = PER_POINT.map(|n| format!("{n} per shading point"));
        let bar = |found: Option<Estimate>| Bar::from(found.unwrap_or(Estimate::UNKNOWN));
        let series: Vec<_> = samplers_on(model)
            .map(|one| {
                (
                    name(one.1).to_owned(),
                    PER_POINT
                        .map(|n| bar(of.efficiency(one, of.constant(), n)))
                        .to_vec(),
                )
            })
            .collect();
        bars(&title, Axis::log("1 / (V · µs)"), &groups, &series, 0.0)
    })
}

/// Draws the verdicts in one plot: the Cauchy model against the Gaussian one, by light.
pub(super) fn summary(of: &Study) -> Drawing {
    let mut told = TOLD
        .into_iter()
        .map(|sampler| (ModelKind::Cauchy, Some(sampler)));
    let axis = Axis::log("V Gaussian / V Cauchy");
    let chart = of.by_light(
        "Samples: Gaussian model over Cauchy model",
        axis,
        1.0,
        &mut told,
        &|cauchy, light| {
            of.gain([on_gaussian(cauchy), cauchy], light)
                .map_or(f64::NAN, |gain| gain.median.value)
                .into()
        },
    );
    let caption = "By what factor the Cauchy model needs fewer samples (above 1) or more (below), by light: medians over the \
                   grid. The spread over its cells is shown below.";
    Drawing::new("summary", chart, caption)
}

/// Draws the gains in V over `published` by light, up to that of perfect sampling.
pub(super) fn limits(of: &Study) -> Vec<Drawing> {
    let caption = "By what factor fewer samples than the published sampler needs, by light. That is also how many times its \
                   time a sample may take before it loses in equal time. `perfect` draws in proportion to S cos θᵢ, blind to \
                   the light. Under constant light nothing is left of its variance: no bar.";
    let words = [
        "Fewer samples than the published sampler",
        "V published / V (×)",
        "fewer-samples-by-light",
        caption,
    ];
    over_published(of, None, words)
}

/// Draws the gains over `published` by light, a chart for each model: in samples, up to that of perfect sampling, or in equal time.
fn over_published(
    of: &Study,
    time: Option<Counted>,
    [title, axis, slug, caption]: [&str; 4],
) -> Vec<Drawing> {
    each_model(slug, &format!("{caption} {MEDIANS}"), &|model| {
        let others = strategies()
            .map(|strategy| (model, strategy))
            .filter(|other| *other != published(*other));
        let mut others = others.filter(|(_, strategy)| time.is_none() || strategy.is_some());
        let title = format!("{title}, {} model", model.title());
        of.by_light(
            &title,
            Axis::log(axis),
            1.0,
            &mut others,
            &|other, light| {
                let pair = [published(other), other];
                median_bar(
                    of.gain(pair, light),
                    time.map_or(1.0, |time| of.time_ratio(pair, light, MANY, time).value),
                )
            },
        )
    })
}

/// Draws the gains in equal time, by light: over `published`, without and with the look-up, then of the Cauchy model.
pub(super) fn gains(of: &Study) -> Vec<Drawing> {
    let axis = "gain over the published sampler in equal time (×)";
    let title = "Less variance than the published sampler in equal time";
    let caption = format!(
        "By what factor less variance than the published sampler has in the same time, by light, at {MANY} samples per \
         shading point."
    );
    let mut figures = over_published(
        of,
        Some(Counted::Sample),
        [title, axis, "gain-by-light", &caption],
    );
    let title = format!("{title}, look-up included");
    let caption = format!(
        "{caption} The time of a look-up of the light is added; one that was not timed has no bars."
    );
    figures.extend(over_published(
        of,
        Some(Counted::LookUp),
        [&title, axis, "gain-by-light-look-up", &caption],
    ));
    let (title, axis) = (
        "Less variance on the Cauchy model in equal time",
        "Gaussian / Cauchy in equal time (×)",
    );
    let mut on_cauchy = samplers_on(ModelKind::Cauchy);
    let chart = of.by_light(
        title,
        Axis::log(axis),
        1.0,
        &mut on_cauchy,
        &|cauchy, light| {
            let pair = [on_gaussian(cauchy), cauchy];
            median_bar(
                of.gain(pair, light),
                of.time_ratio(pair, light, MANY, Counted::Sample).value,
            )
        },
    );
    let caption = format!(
        "Variance on the Gaussian model over that on the Cauchy model with the same sampler in the same time, by light, at \
         {MANY} samples per shading point. {MEDIANS}"
    );
    figures.push(Drawing::new("cauchy-gain-by-light", chart, caption));
    figures
}

/// Returns the line in the colour that the sampler has in every chart.
fn of_sampler(sampler: Sampler, series: Series) -> Series {
    series.styled(sampler.color(), sampler.color())
}

/// Returns the share of cells in which V of `base` over V of `other` is at most x, as a line.
fn distribution(of: &Study, label: &str, pair: [Estimator; 2], light: usize) -> Series {
    let mut gains: Vec<f64> = of
        .pairs(pair, light)
        .map(|[base, other]| base.value / other.value)
        .collect();
    gains.retain(|gain| gain.is_finite() && *gain > 0.0);
    gains.sort_by(f64::total_cmp);
    let n = gains.len() as f64;
    // A few hundred points show as much as thousands.
    let every = gains.len().div_ceil(300).max(1);
    let points = gains
        .iter()
        .enumerate()
        .filter(|(i, _)| i % every == 0 || i + 1 == gains.len());
    Series::curve(
        label,
        points.map(|(i, gain)| (*gain, 100.0 * (i as f64 + 0.5) / n)),
    )
}

/// Draws the distribution of the gains over the cells.
pub(super) fn distributions(of: &Study) -> Vec<Drawing> {
    let chart = |title: String, axis: &str, mut series: Vec<Series>| {
        series.push(Series::guide("as good", [(1.0, 0.0), (1.0, 100.0)]));
        let share = Axis::linear("cells with at most as much (%)")
            .range(0.0, 100.0)
            .step(20.0);
        lines(&title, Axis::log(axis), share, &series)
    };
    let cells = of.cells.len();
    let of_cauchy = TOLD.map(|sampler| {
        let (name, cauchy) = (sampler.name(), (ModelKind::Cauchy, Some(sampler)));
        let of_light = |(light, name): (usize, &String)| distribution(of, name, [on_gaussian(cauchy), cauchy], light);
        let series = of.lights().iter().enumerate().map(of_light).collect();
        let svg = chart(format!("Variance, Gaussian over Cauchy, with {name}"), "V Gaussian / V Cauchy", series);
        let caption = format!(
            "How the gain of the Cauchy model spreads over the {cells} cells of the grid with `{name}`, by light: a line left \
             of 1 (the upright) is a cell where the Cauchy model needs more samples. The time of a sample is not in it."
        );
        Drawing::new(format!("cauchy-gain-over-cells-{name}"), svg, caption)
    });
    let caption = format!(
        "How the gain over the published sampler spreads over the {cells} cells of the grid under {} light: left of 1 (the \
         upright) the sampler needs more samples than `published`. The time of a sample is not in it.",
        Constant::NAME
    );
    let of_samplers = each_model("gain-over-cells", &caption, &|model| {
        let others = Sampler::ALL
            .into_iter()
            .filter(|sampler| *sampler != Sampler::Published);
        let series = others.map(|sampler| {
            let other = (model, Some(sampler));
            of_sampler(
                sampler,
                distribution(of, sampler.name(), [published(other), other], of.constant()),
            )
        });
        let title = format!(
            "Variance of the published sampler over that of another, {} model",
            model.title()
        );
        chart(title, "V published / V sampler", series.collect())
    });
    of_cauchy.into_iter().chain(of_samplers).collect()
}

/// Draws the largest weights, relative to the albedo and to their bounds.
pub(super) fn weights(of: &Study) -> Vec<Drawing> {
    let caption = "The largest weight S cos θᵢ / pdf of any sample in the worst cell of each inclination, in units of the albedo: \
                   what a firefly under constant light would be. It is the largest of those drawn, and so has no error bar; \
                   more samples can only raise it.";
    let largest = each_model("largest-weight", caption, &|model| {
        let series = Sampler::ALL.map(|sampler| {
            let relative =
                |row: &Row<'_>| Some(row.measured.max_weight / row.measured.figures.mean.value);
            Series::new(sampler.name(), worst(of, (model, Some(sampler)), &relative))
        });
        let x = Axis::linear("inclination of the viewer, θₒ (°)");
        let title = format!("Largest weight, {} model", model.title());
        lines(&title, x, Axis::log("largest weight / albedo"), &series)
    });
    let caption = "For samplers with a bound in closed form: the largest weight drawn over the bound, in the worst cell of each \
                   inclination. A point above 1 would fail the run.";
    let bounds = each_model("weight-bound", caption, &|model| {
        let series = Sampler::ALL.into_iter().filter_map(|sampler| {
            let share = |row: &Row<'_>| Some(row.measured.max_weight / row.measured.weight_bound?);
            let points = worst(of, (model, Some(sampler)), &share);
            (!points.is_empty()).then(|| of_sampler(sampler, Series::new(sampler.name(), points)))
        });
        let title = format!(
            "Largest weight over its proven bound, {} model",
            model.title()
        );
        let ends = of
            .grid()
            .theta_o_deg
            .iter()
            .map(|theta_o| (f64::from(*theta_o), 1.0));
        let series: Vec<Series> = series.chain([Series::guide("the bound", ends)]).collect();
        lines(
            &title,
            Axis::linear("θₒ (°)"),
            Axis::linear("largest weight / bound"),
            &series,
        )
    });
    [largest, bounds].concat()
}

/// Returns the largest figure of the cells of each inclination, under constant light. Inclinations without a figure are left out.
fn worst(
    of: &Study,
    estimator: Estimator,
    figure: &dyn Fn(&Row<'_>) -> Option<f64>,
) -> Vec<(f64, f64)> {
    let of_inclination = |theta_o: &f32| {
        let rows = of
            .rows_of(estimator, of.constant())
            .filter(|row| row.cell.theta_o_deg == *theta_o);
        let most = rows.filter_map(|row| figure(&row)).reduce(f64::max)?;
        Some((f64::from(*theta_o), most))
    };
    of.grid()
        .theta_o_deg
        .iter()
        .filter_map(of_inclination)
        .collect()
}
