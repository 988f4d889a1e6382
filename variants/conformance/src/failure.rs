//! Failures of properties.

use core::fmt;

/// Failure of a property: the query, its place, the result and the expectation.
#[derive(Clone, PartialEq, Eq)]
pub struct Failure {
    /// Name of the property.
    pub property: &'static str,
    /// Material, directions, numbers, lane and level, and the results got and wanted.
    pub message: String,
}

impl Failure {
    pub(crate) fn new(property: &'static str, message: impl Into<String>) -> Self {
        Self {
            property,
            message: message.into(),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.property, self.message)
    }
}

impl fmt::Debug for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl core::error::Error for Failure {}

/// Whether a property holds.
pub type Outcome = Result<(), Failure>;

/// The largest error seen of one quantity, compared with its tolerance at once.
pub(crate) struct Worst {
    property: &'static str,
    what: &'static str,
    tolerance: f64,
    error: f64,
}

impl Worst {
    pub(crate) fn new(property: &'static str, what: &'static str, tolerance: f64) -> Self {
        Self {
            property,
            what,
            tolerance,
            error: 0.0,
        }
    }

    /// Fails if `error` is above the tolerance or not a number.
    pub(crate) fn see(&mut self, error: f64, at: impl FnOnce() -> String) -> Outcome {
        if error > self.error {
            self.error = error;
        }
        if error <= self.tolerance {
            return Ok(());
        }
        Err(self.failure(error, &at()))
    }

    fn failure(&self, error: f64, at: &str) -> Failure {
        let Self {
            property,
            what,
            tolerance,
            ..
        } = self;
        Failure::new(
            property,
            format!("{what} is off by {error:.3e}, allowed {tolerance:.1e}: {at}"),
        )
    }

    /// Prints the worst case, for the record of a tolerance.
    pub(crate) fn report(self) -> Outcome {
        let Self {
            property,
            what,
            tolerance,
            error,
        } = self;
        println!("{property}: {what} measured {error:.2e}, allowed {tolerance:.1e}");
        Ok(())
    }
}
