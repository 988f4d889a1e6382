//! Check of a contender's answers: a wrong kernel must not win.

use crate::check::{drawn, is_right, to_f64};
use crate::task::Answer;
use glam::Vec3;
use hairis_variants::AnyReference;

/// Correct answers for the directions of a pass, by the reference in `f64`.
#[derive(Debug)]
pub struct Truth {
    points: Vec<AnyReference<f64>>,
    /// The direction given, or the one that a sample must come to; `None` if it must be discarded.
    wi: Vec<Option<[f64; 3]>>,
}

impl Truth {
    /// For directions that are given.
    #[must_use]
    pub fn of_directions(points: Vec<AnyReference<f64>>, wi: &[Vec3]) -> Self {
        Self {
            points,
            wi: wi.iter().map(|wi| Some(to_f64(*wi))).collect(),
        }
    }

    /// For samples.
    #[must_use]
    pub fn of_samples(points: Vec<AnyReference<f64>>, xi: &[[f32; 3]]) -> Self {
        let wi = points
            .iter()
            .zip(xi)
            .map(|(point, xi)| drawn(point, *xi))
            .collect();
        Self { points, wi }
    }

    /// Share of the answers that are wrong; 1 if there are not as many as there should be.
    #[must_use]
    pub fn wrong_share(&self, answers: &[Answer]) -> f64 {
        if answers.len() != self.wi.len() {
            return 1.0;
        }
        let wrong = self
            .points
            .iter()
            .zip(&self.wi)
            .zip(answers)
            .filter(|((point, wi), answer)| !is_right(*point, **wi, answer));
        wrong.count() as f64 / answers.len() as f64
    }
}
