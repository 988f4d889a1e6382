//! Comparison of results with expected results.

/// Returns the error of `got` relative to `want`, or relative to `floor` if `want` is smaller.
#[must_use]
pub fn relative(got: impl Into<f64>, want: f64, floor: f64) -> f64 {
    (got.into() - want).abs() / want.abs().max(floor)
}

/// Returns the error of a number over the one that is allowed. A number below `floor` may have the relative error at the floor, one that
/// is 0 or too small for a float may be as large as the floor, and a denormal may have any.
#[must_use]
pub fn over(got: f32, want: f64, allowed: f64, floor: f64) -> f64 {
    let least = f64::from(f32::MIN_POSITIVE);
    let error = (f64::from(got) - want).abs() - least;
    // NaN is the largest error of all.
    if error <= 0.0 {
        0.0
    } else if want.abs() < least {
        error / floor
    } else {
        error * want.abs() / (allowed * want.abs().max(floor))
    }
}

/// Largest error of one quantity so far, and its place. NaN counts as the largest of all.
#[derive(Clone, Debug, Default)]
pub struct LargestError {
    /// Largest error so far.
    pub error: f64,
    /// Place at which the largest error occurred.
    pub at: String,
}

impl LargestError {
    /// Takes an error into account, and calls `at` for its place if it is the largest so far.
    pub fn see(&mut self, error: f64, at: impl FnOnce() -> String) {
        if error > self.error || (error.is_nan() && !self.error.is_nan()) {
            *self = Self { error, at: at() };
        }
    }

    /// Prints the largest error beside its bound, for the record (`cargo test -- --nocapture`).
    ///
    /// # Panics
    ///
    /// Panics if the largest error is above the bound, or NaN.
    #[track_caller]
    pub fn check(&self, row: &str, bound: f64) {
        let Self { error, at } = self;
        println!("{row}: measured {error:.8e}, bound {bound:.1e}, at {at}");
        assert!(
            *error <= bound,
            "{row}: {error:.3e} is above {bound:.1e} at {at}"
        );
    }
}
