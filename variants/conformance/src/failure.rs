//! Failures and outcomes of properties.

use crate::comparison::LargestError;
use core::fmt;

/// Failure of a property, with the query, its place, the result and the expectation.
#[derive(Clone, PartialEq)]
pub struct Failure {
    /// Name of the property that failed.
    pub property: &'static str,
    /// Material, directions, numbers, lane and level, and the results that were returned and expected.
    pub message: String,
    /// Smallest case that fails, as a block of code whose value is the outcome of the property; `subject` is the subject under test.
    /// `None` if the property draws no cases.
    pub case: Option<String>,
    /// Error divided by its tolerance, or infinite if there is no tolerance.
    pub(crate) excess: f64,
}

impl Failure {
    pub(crate) fn new(property: &'static str, message: impl Into<String>) -> Self {
        Self {
            property,
            message: message.into(),
            case: None,
            excess: f64::INFINITY,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.property, self.message)?;
        match &self.case {
            Some(case) => write!(
                f,
                "\nsmallest case that fails, where `subject` is yours:\n{case}"
            ),
            None => Ok(()),
        }
    }
}

impl fmt::Debug for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl core::error::Error for Failure {}

/// Outcome of a property: an error if it does not hold.
pub type Outcome = Result<(), Failure>;

/// Returns the outcome of a property that belongs to a claim that the subject does not make.
pub(crate) fn not_claimed(property: &str, claim: &str) -> Outcome {
    println!("{property}: not claimed (`{claim}`)");
    Ok(())
}

/// Largest error of one quantity, with its tolerance.
#[derive(Clone)]
pub(crate) struct Worst {
    property: &'static str,
    what: &'static str,
    tolerance: f64,
    largest: LargestError,
}

impl Worst {
    /// Makes a quantity without errors; `what` names the quantity, and the claim that states its tolerance.
    pub(crate) fn new(property: &'static str, what: &'static str, tolerance: f64) -> Self {
        Self {
            property,
            what,
            tolerance,
            largest: LargestError::default(),
        }
    }

    /// Takes an error into account, and its place if the error is above the tolerance.
    pub(crate) fn see(&mut self, error: f64, at: impl FnOnce() -> String) {
        let is_allowed = error <= self.tolerance;
        let place = || if is_allowed { String::new() } else { at() };
        self.largest.see(error, place);
    }

    /// Takes the largest error of another `Worst` into account.
    pub(crate) fn merge(&mut self, other: Self) {
        self.see(other.largest.error, || other.largest.at);
    }

    /// Returns a failure if the largest error is above the tolerance or NaN.
    pub(crate) fn verdict(&self) -> Outcome {
        let Self {
            property,
            what,
            tolerance,
            largest: LargestError { error, at },
        } = self;
        if error <= tolerance {
            return Ok(());
        }
        let message = format!("{what} is off by {error:.3e}, allowed {tolerance:.1e}: {at}");
        let excess = if error.is_nan() {
            f64::INFINITY
        } else {
            error / tolerance
        };
        Err(Failure {
            excess,
            ..Failure::new(property, message)
        })
    }

    /// Prints the largest error, for the record of a tolerance, and returns a failure if it is above the tolerance.
    pub(crate) fn report(self) -> Outcome {
        let Self {
            property,
            what,
            tolerance,
            largest,
        } = &self;
        let error = largest.error;
        println!("{property}: {what} measured {error:.2e}, allowed {tolerance:.1e}");
        self.verdict()
    }
}
