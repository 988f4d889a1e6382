//! Check of the contenders' answers, so that a wrong kernel cannot come out as the fastest.

use crate::check::{drawn, is_right, to_f64};
use crate::task::Answer;
use glam::Vec3;
use hairis_reference::Reference;

/// Correct answers for the directions of a pass, as the reference computes them in `f64`.
#[derive(Debug)]
pub struct Truth {
    /// Shading points, each of which answers for the same number of directions.
    points: Vec<Box<dyn Reference<f64>>>,
    /// Given direction, or direction that a sample must have; `None` if the sample must be discarded.
    wi: Vec<Option<[f64; 3]>>,
}

impl Truth {
    /// Returns the answers for given directions, of which every point has the same number, one point after the other.
    #[must_use]
    pub fn of_directions(points: Vec<Box<dyn Reference<f64>>>, wi: &[Vec3]) -> Self {
        Self {
            points,
            wi: wi.iter().map(|wi| Some(to_f64(*wi))).collect(),
        }
    }

    /// Returns the answers for samples drawn with `xi`, of which every point has the same number, one point after the other.
    #[must_use]
    pub fn of_samples(points: Vec<Box<dyn Reference<f64>>>, xi: &[[f32; 3]]) -> Self {
        let per_point = xi.len() / points.len();
        let wi = xi
            .iter()
            .enumerate()
            .map(|(i, xi)| drawn(&*points[i / per_point], *xi))
            .collect();
        Self { points, wi }
    }

    /// Returns the share of wrong answers, or 1 if the number of answers is not the expected one. If `conserve`, each channel of an
    /// answer must have been divided by its albedo where the albedo is above 1.
    #[must_use]
    pub fn wrong_share(&self, answers: &[Answer], conserve: bool) -> f64 {
        if answers.len() != self.wi.len() {
            return 1.0;
        }
        let per_point = self.wi.len() / self.points.len();
        let factors: Vec<[f64; 3]> = self
            .points
            .iter()
            .map(|point| {
                if conserve {
                    factors(&**point)
                } else {
                    [1.0; 3]
                }
            })
            .collect();
        let wrong = answers.iter().enumerate().filter(|(i, answer)| {
            let point = i / per_point;
            !is_right(&*self.points[point], factors[point], self.wi[*i], answer)
        });
        wrong.count() as f64 / answers.len() as f64
    }
}

/// Returns the factors on the channels that keep every albedo at most 1.
fn factors(point: &dyn Reference<f64>) -> [f64; 3] {
    let lobes = point.albedo().0;
    [0, 1, 2].map(|c| {
        lobes
            .iter()
            .map(|lobe| lobe[c])
            .sum::<f64>()
            .max(1.0)
            .recip()
    })
}
