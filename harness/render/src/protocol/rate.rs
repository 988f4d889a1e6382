//! Rates at which errors fall with samples: slopes, and samples and time to an error.

use super::Measure;
use super::jackknife::jackknife;
use super::runs::Runs;
use hairis_instruments::stats::Estimate;

/// Returns the slope of `log y` against `log x`, by least squares over all points.
#[must_use]
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let n = logs.len() as f64;
    let (x, y) = logs
        .iter()
        .fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let (xy, xx) = logs.iter().fold((0.0, 0.0), |(a, b), l| {
        (a + (l.0 - x) * (l.1 - y), b + (l.0 - x).powi(2))
    });
    xy / xx
}

/// Returns the abscissa at which a curve through points first falls to a level. The curve is straight between points in logarithms of both
/// coordinates. Returns `None` if the curve begins below the level, or does not reach it.
#[must_use]
pub fn crossing(points: &[(f64, f64)], level: f64) -> Option<f64> {
    let (_, above) = points.first()?;
    if *above < level {
        return None;
    }
    let [(x0, y0), (x1, y1)] = points
        .windows(2)
        .find_map(|pair| (pair[1].1 <= level).then_some([pair[0], pair[1]]))?;
    let share = if y1 < y0 {
        (y0 / level).ln() / (y0 / y1).ln()
    } else {
        0.0
    };
    Some(x0 * (x1 / x0).powf(share))
}

/// Samples and time at which an error falls to a level, or a bound on the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach {
    /// The error is already lower with this count of samples, the smallest.
    Below(u32),
    /// Samples per pixel, and seconds of a thread.
    At([Estimate; 2]),
    /// The error is still higher with this count of samples, the largest that can be told from noise of the reference.
    Above(u32),
}

/// Selects runs whose error is not below the reference.
fn clear(runs: &[Runs], measure: Measure) -> Vec<&Runs> {
    runs.iter()
        .filter(|runs| !runs.is_below_reference(measure))
        .collect()
}

/// Returns the points of an error over another number of each run, without the error of one picture.
fn points(
    runs: &[&Runs],
    measure: Measure,
    kept: Option<usize>,
    of: impl Fn(&Runs) -> f64,
) -> Vec<(f64, f64)> {
    runs.iter()
        .map(|runs| (of(runs), runs.mean_without(measure, kept)))
        .collect()
}

/// Returns the samples and the time at which an error falls to a level, interpolated in logarithms. `runs` must be in ascending order of
/// samples. Returns `None` if every error is below the reference.
#[must_use]
pub fn reach(runs: &[Runs], measure: Measure, level: f64) -> Option<Reach> {
    let clear = clear(runs, measure);
    let (first, last) = (clear.first()?, clear.last()?);
    let to = |of: fn(&Runs) -> f64| {
        jackknife(first.errors.len(), |kept| {
            crossing(&points(&clear, measure, kept, of), level).unwrap_or(f64::NAN)
        })
    };
    let samples = to(|runs| f64::from(runs.samples));
    Some(if first.mean(measure).value < level {
        Reach::Below(first.samples)
    } else if samples.value.is_finite() {
        Reach::At([samples, to(|runs| runs.seconds)])
    } else {
        Reach::Above(last.samples)
    })
}

/// Returns the slope of the logarithm of an error against that of samples. Returns `None` if fewer than two counts of samples have an
/// error that is not below the reference.
#[must_use]
pub fn slope_of(runs: &[Runs], measure: Measure) -> Option<Estimate> {
    let clear = clear(runs, measure);
    let count = clear.first()?.errors.len();
    let of = |kept| {
        slope(&points(&clear, measure, kept, |runs| {
            f64::from(runs.samples)
        }))
    };
    (clear.len() > 1).then(|| jackknife(count, of))
}
