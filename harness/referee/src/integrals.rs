//! Integrals over the sphere from answers whose directions were drawn with known densities.

use crate::answers::{Answer, Answers};

/// Mean of independent numbers with its standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Mean.
    pub mean: f64,
    /// Standard error, infinite for a single number.
    pub error: f64,
}

impl Estimate {
    fn of(numbers: &[f64]) -> Self {
        let n = numbers.len() as f64;
        let mean = numbers.iter().sum::<f64>() / n;
        let squares: f64 = numbers.iter().map(|x| (x - mean).powi(2)).sum();
        Self {
            mean,
            error: (squares / (n - 1.0) / n).sqrt(),
        }
    }

    /// Returns the distance from a number in standard errors, 0 at that number.
    #[must_use]
    pub fn away(&self, from: f64) -> f64 {
        let apart = self.mean - from;
        if apart == 0.0 {
            0.0
        } else {
            apart / self.error.max(f64::MIN_POSITIVE)
        }
    }
}

/// Estimates the integral of a number for each shading point. Returns none if a case lacks `drawn_with` or the number.
pub fn by_scene(answers: &Answers, of: impl Fn(&Answer) -> Option<f64>) -> Vec<Estimate> {
    let integrals = answers.scenes().map(|scene| {
        let parts = scene
            .iter()
            .map(|answer| Some(of(answer)? / answer.drawn_with?));
        Some(Estimate::of(&parts.collect::<Option<Vec<_>>>()?))
    });
    integrals.collect::<Option<_>>().unwrap_or_default()
}
