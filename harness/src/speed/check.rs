//! Check of a contender's answers: a wrong kernel must not win.

use super::task::ContenderAnswer;
use crate::subject::to_f64;
use glam::{DVec3, Vec3};
use hairis::reference::Reference;
use hairis_variants::AnyReference;

/// Largest error of an answer that counts as correct: relative for value and density, rad for a direction.
///
/// The `f32` reference, which is timed as well, needs it; `agreement` checks the kernels to tighter bounds.
pub(super) const TOLERANCE: f64 = 1e-3;

/// Values below this count as 0: the kernels' Gaussians end at `2^-115`, those of the `f32` reference at denormals.
const NEGLIGIBLE: f64 = 1e-25;

/// Correct answers for the directions of a pass, by the reference in `f64`.
pub(super) struct Truth {
    points: Vec<AnyReference<f64>>,
    /// The direction given, or the one that a sample must come to; `None` if it must be discarded.
    wi: Vec<Option<[f64; 3]>>,
}

impl Truth {
    /// For directions that are given.
    pub(super) fn of_directions(points: Vec<AnyReference<f64>>, wi: &[Vec3]) -> Self {
        Self { points, wi: wi.iter().map(|wi| Some(to_f64(*wi))).collect() }
    }

    /// For samples.
    pub(super) fn of_samples(points: Vec<AnyReference<f64>>, xi: &[[f32; 3]]) -> Self {
        let wi = points
            .iter()
            .zip(xi)
            .map(|(point, xi)| {
                let drawn = point.sample(xi.map(f64::from));
                drawn.lobe.map(|_| drawn.wi)
            })
            .collect();
        Self { points, wi }
    }

    /// Share of the answers that are wrong; 1 if there are not as many as there should be.
    pub(super) fn wrong_share(&self, answers: &[ContenderAnswer]) -> f64 {
        if answers.len() != self.wi.len() {
            return 1.0;
        }
        let wrong =
            self.points.iter().zip(&self.wi).zip(answers).filter(|((point, wi), answer)| !right(point, wi, answer));
        wrong.count() as f64 / answers.len() as f64
    }
}

fn right(point: &AnyReference<f64>, truth: &Option<[f64; 3]>, answer: &ContenderAnswer) -> bool {
    let Some(truth) = *truth else {
        return answer.pdf == 0.0;
    };
    let wi = answer.wi.map_or(truth, to_f64);
    let angle = DVec3::from(wi).angle_between(DVec3::from(truth));
    let close = |got: f32, want: f64| (f64::from(got) - want).abs() <= TOLERANCE * want + NEGLIGIBLE;
    let value = point.eval(wi);
    angle <= TOLERANCE
        && close(answer.pdf, point.pdf(wi))
        && answer.value.iter().zip(value).all(|(got, want)| close(*got, want))
}
