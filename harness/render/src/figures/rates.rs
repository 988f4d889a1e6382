//! Rates at which errors fall with samples, sampler by sampler.

use super::measure::Measured;
use crate::protocol::{Measure, Reach, Runs, reach, slope_of};
use hairis_instruments::stats::Estimate;
use hairis_instruments::table::{Table, number};

/// Measure of the error for which the table states samples and time.
const MEASURE: Measure = Measure::RelMse;

/// Returns the level of relMSE that most samplers reach within their counts of samples, as 1, 2 or 5 times a power of ten. Among
/// several such levels, the nearest to the error of the last sampler, at the count that pictures show, is returned.
pub(super) fn level(measured: &Measured) -> f64 {
    let all: Vec<&[Runs]> = measured
        .samplers
        .iter()
        .map(|sampler| sampler.runs.as_slice())
        .collect();
    let near = all.last().map_or(1.0, |best| {
        best[measured.shown()].mean(MEASURE).value.max(1e-9)
    });
    let levels =
        (-9..=3).flat_map(|power| [1.0, 2.0, 5.0].map(|factor| factor * 10.0_f64.powi(power)));
    let reached = |level: f64| {
        all.iter()
            .filter(|runs| matches!(reach(runs, MEASURE, level), Some(Reach::At(_))))
            .count()
    };
    let rank = |level: f64| (reached(level), -(level / near).ln().abs());
    levels
        .map(|level| (rank(level), level))
        .max_by(|(a, _), (b, _)| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal))
        .map_or(near, |(_, level)| level)
}

/// Returns the table of samples and time to a level of relMSE, and of slopes.
pub(super) fn table(measured: &Measured) -> Table {
    let level = level(measured);
    let level_text = number::plain(level, 1);
    let mut table = Table::new(format!(
        "Samples and time to a relMSE of {level_text}, and slopes"
    ))
    .texts(["sampler"])
    .numbers([
        format!("samples to a relMSE of {level_text}"),
        format!("time to a relMSE of {level_text} (s)"),
        "slope of log MSE".to_owned(),
        "slope of log relMSE".to_owned(),
    ]);
    let slope = |of: Option<Estimate>| {
        of.map_or_else(|| "n/a".to_owned(), |slope| number::estimate(&slope))
    };
    for sampler in &measured.samplers {
        let [samples, seconds] = match reach(&sampler.runs, MEASURE, level) {
            None => ["n/a".to_owned(), "n/a".to_owned()],
            Some(Reach::At(both)) => both.map(|estimate| number::estimate(&estimate)),
            Some(Reach::Below(samples)) => [format!("below {samples}"), String::new()],
            Some(Reach::Above(samples)) => [format!("above {samples}"), String::new()],
        };
        let slopes =
            [Measure::Mse, Measure::RelMse].map(|measure| slope(slope_of(&sampler.runs, measure)));
        table.push(
            [sampler.name.to_owned(), samples, seconds]
                .into_iter()
                .chain(slopes),
        );
    }
    table.note(
        "Samples and time: interpolated in logarithms of both. Slopes: against log samples, over all counts whose error is not below \
         the reference; −1 expected for independent samples. Flatter: heavy tails; steeper: points that are evenly spread.",
    )
}
