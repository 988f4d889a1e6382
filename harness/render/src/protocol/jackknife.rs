//! Standard errors of statistics of runs.

use hairis_instruments::stats::Estimate;

/// Returns the mean of values, except the value at one place.
#[must_use]
pub fn average(values: impl Iterator<Item = (usize, f64)>, left_out: Option<usize>) -> f64 {
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
