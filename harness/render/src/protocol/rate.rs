//! Rates at which errors fall with samples: slopes, and samples and time to an error.

use super::{Measure, Runs};
use hairis_instruments::stats::Estimate;

/// Returns the mean of values, except the value at one place.
pub(super) fn average(values: impl Iterator<Item = (usize, f64)>, left_out: Option<usize>) -> f64 {
    let (sum, count) = values
        .filter(|(place, _)| Some(*place) != left_out)
        .fold((0.0, 0.0), |(sum, count), (_, value)| {
            (sum + value, count + 1.0)
        });
    sum / count
}

/// Estimates a statistic of `count` runs with its standard error, from the statistic without each of the runs.
///
/// For a mean, the standard error is the usual one. For a ratio of means, it takes into account how the means vary together.
#[must_use]
pub fn jackknife(count: usize, statistic: impl Fn(Option<usize>) -> f64) -> Estimate {
    let value = statistic(None);
    let without: Vec<f64> = (0..count).map(|run| statistic(Some(run))).collect();
    let n = count as f64;
    let mean = without.iter().sum::<f64>() / n;
    let squares: f64 = without.iter().map(|one| (one - mean).powi(2)).sum();
    let standard_error = if count < 2 {
        f64::NAN
    } else {
        ((n - 1.0) / n * squares).sqrt()
    };
    Estimate {
        value,
        standard_error,
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::Picture;
    use crate::protocol::Errors;

    #[test]
    fn the_jackknife_of_a_mean_is_its_standard_error() {
        let values = [1.0, 2.0, 4.0, 7.0];
        let estimate = jackknife(4, |kept| average(values.into_iter().enumerate(), kept));
        assert_eq!(estimate.value, 3.5);
        let expected =
            (values.iter().map(|v| (v - 3.5_f64).powi(2)).sum::<f64>() / 3.0 / 4.0).sqrt();
        assert!((estimate.standard_error - expected).abs() < 1e-12);
        assert!((slope(&[(1.0, 8.0), (2.0, 2.0), (4.0, 0.5)]) + 2.0).abs() < 1e-12);
    }

    #[test]
    fn crossings_are_interpolated_in_logarithms() {
        let points = [(4.0, 0.4), (16.0, 0.1), (64.0, 0.025)];
        for (level, expected) in [
            (0.4, 4.0),
            (0.2, 8.0),
            (0.1, 16.0),
            (0.05, 32.0),
            (0.025, 64.0),
        ] {
            let at = crossing(&points, level).expect("within");
            assert!((at / expected - 1.0).abs() < 1e-12, "{level}: {at}");
        }
        assert_eq!(
            [
                crossing(&points, 0.5),
                crossing(&points, 0.02),
                crossing(&[], 1.0)
            ],
            [None; 3]
        );
    }

    /// Pictures with errors of 1 / S, more or less, and two seconds per sample.
    fn runs(samples: u32, own: f64) -> Runs {
        let error = |by: f64| Errors {
            values: [by / f64::from(samples); 4],
            own: [own; 4],
        };
        Runs {
            samples,
            seconds: 2.0 * f64::from(samples),
            errors: [0.9, 1.0, 1.1].map(error).to_vec(),
            variance: Estimate::exact(1.0),
            picture: Picture::black([1, 1]),
            bias: vec![0.0],
            squares: vec![0.0],
        }
    }

    #[test]
    fn samples_and_time_to_an_error_have_their_own_error() {
        let all = [4, 16, 64].map(|samples| runs(samples, 1e-6));
        let Some(Reach::At([samples, seconds])) = reach(&all, Measure::RelMse, 1.0 / 32.0) else {
            panic!("within")
        };
        assert!(
            (samples.value - 32.0).abs() < 1e-9 && (seconds.value - 64.0).abs() < 1e-9,
            "{samples:?} {seconds:?}"
        );
        // The error of the mean is 0.1 / sqrt(3), and samples go with it.
        assert!(
            (samples.standard_error / 32.0 - 0.0577).abs() < 5e-3,
            "{samples:?}"
        );
        assert_eq!(reach(&all, Measure::RelMse, 1.0), Some(Reach::Below(4)));
        assert_eq!(reach(&all, Measure::RelMse, 1e-3), Some(Reach::Above(64)));
        let slope = slope_of(&all, Measure::Mse).expect("three counts");
        assert!(
            (slope.value + 1.0).abs() < 1e-12 && slope.standard_error < 1e-12,
            "{slope:?}"
        );
    }

    #[test]
    fn errors_below_the_reference_do_not_count() {
        let all = [4, 16, 64].map(|samples| runs(samples, 0.02));
        assert!(
            all[2].is_below_reference(Measure::Mse) && !all[1].is_below_reference(Measure::Mse)
        );
        assert_eq!(
            reach(&all, Measure::Mse, 1.0 / 32.0),
            Some(Reach::Above(16))
        );
        assert!(
            slope_of(&all[..1], Measure::Mse).is_none()
                && slope_of(&all[2..], Measure::Mse).is_none()
        );
    }
}
