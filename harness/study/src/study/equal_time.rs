//! Variances in equal time: the gain of a sampler whose samples take longer, alone or with the work that follows them.

use hairis_instruments::stats::Estimate;

/// Comparison of two figures, beyond their errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sign {
    Above,
    /// Equal within two standard errors.
    Unsure,
    Below,
}

impl Sign {
    /// Compares a ratio with 1.
    pub(super) fn of(ratio: Estimate) -> Self {
        match ratio.value - 1.0 {
            d if d > 2.0 * ratio.standard_error => Self::Above,
            d if d < -2.0 * ratio.standard_error => Self::Below,
            _ => Self::Unsure,
        }
    }
}

/// Time of the work after a sample, if none is counted.
pub(super) const NOTHING: Estimate = Estimate::exact(0.0);

/// Returns the time of `base` over that of `other` if each is followed by the same `more`.
pub(super) fn time_ratio([base, other]: [Estimate; 2], more: Estimate) -> Estimate {
    let [a, b] = [base, other].map(|of| of.value + more.value);
    let value = a / b;
    // An error of the time that follows changes both times, and the ratio by the difference.
    let relative = (base.standard_error / a).hypot(other.standard_error / b);
    let relative = relative.hypot(more.standard_error * (1.0 / a - 1.0 / b));
    Estimate {
        value,
        standard_error: value * relative,
    }
}

/// Counts cells that are won, undecided and lost, given the gains in V and the ratio of the times. A gain of `None` is undecided.
pub(super) fn count_cells(
    gains: impl Iterator<Item = Option<Estimate>>,
    time: Estimate,
) -> [usize; 3] {
    let mut cells = [0; 3];
    for gain in gains {
        cells[gain.map_or(Sign::Unsure, |gain| Sign::of(gain.times(&time))) as usize] += 1;
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(value: f64, standard_error: f64) -> Estimate {
        Estimate {
            value,
            standard_error,
        }
    }

    #[test]
    fn words_need_two_standard_errors() {
        let sign = |value, error| Sign::of(of(value, error));
        assert_eq!(
            [sign(1.1, 0.04), sign(1.1, 0.06), sign(0.9, 0.04)],
            [Sign::Above, Sign::Unsure, Sign::Below]
        );
        assert_eq!(sign(f64::NAN, 0.1), Sign::Unsure, "no number tells nothing");
        assert_eq!(
            sign(2.0, f64::NAN),
            Sign::Unsure,
            "nor does one without an error"
        );
    }

    #[test]
    fn what_follows_brings_times_together_and_its_error_nearly_cancels() {
        let (base, other) = (of(10.0, 0.1), of(20.0, 0.1));
        let alone = time_ratio([base, other], NOTHING);
        assert_eq!(alone, base.ratio(&other));
        let with = time_ratio([base, other], of(20.0, 0.0));
        assert!((with.value - 0.75).abs() < 1e-15, "{with:?}");
        assert!(
            (with.standard_error / 0.75 - (0.1_f64 / 30.0).hypot(0.1 / 40.0)).abs() < 1e-15,
            "{with:?}"
        );
        // The change of the ratio if the time that follows is one error longer.
        let moved = time_ratio([base, other], of(20.001, 0.0)).value - with.value;
        let error = time_ratio([of(10.0, 0.0), of(20.0, 0.0)], of(20.0, 0.001)).standard_error;
        assert!((error / moved.abs() - 1.0).abs() < 1e-4, "{error} {moved}");
    }

    #[test]
    fn cells_are_won_and_lost_beyond_the_errors_of_variance_and_time() {
        let gains = [
            Some(of(2.1, 0.01)),
            Some(of(1.9, 0.01)),
            Some(of(2.01, 0.01)),
            Some(of(2.1, 0.1)),
            None,
        ];
        assert_eq!(count_cells(gains.into_iter(), of(0.5, 0.0)), [1, 3, 1]);
        assert_eq!(
            count_cells(gains.into_iter(), of(0.5, 0.05)),
            [0, 5, 0],
            "times with errors of a tenth"
        );
    }
}
