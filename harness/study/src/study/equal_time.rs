//! Variances in equal time: the gain of a sampler whose samples take longer, alone or with the work that follows them.

use hairis_instruments::stats::Estimate;

/// Comparison of two figures, beyond their errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// Above, by more than two standard errors.
    Above,
    /// Equal within two standard errors.
    Unsure,
    /// Below, by more than two standard errors.
    Below,
}

impl Sign {
    /// Compares a ratio with 1.
    #[must_use]
    pub fn of(ratio: Estimate) -> Self {
        match ratio.value - 1.0 {
            d if d > 2.0 * ratio.standard_error => Self::Above,
            d if d < -2.0 * ratio.standard_error => Self::Below,
            _ => Self::Unsure,
        }
    }
}

/// Time of the work after a sample, if none is counted.
pub const NOTHING: Estimate = Estimate::exact(0.0);

/// Returns the time of `base` over that of `other` if each is followed by the same `more`.
#[must_use]
pub fn time_ratio([base, other]: [Estimate; 2], more: Estimate) -> Estimate {
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
pub fn count_cells(gains: impl Iterator<Item = Option<Estimate>>, time: Estimate) -> [usize; 3] {
    let mut cells = [0; 3];
    for gain in gains {
        cells[gain.map_or(Sign::Unsure, |gain| Sign::of(gain.times(&time))) as usize] += 1;
    }
    cells
}
