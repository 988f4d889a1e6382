//! Whether the answers are right: a wrong kernel has no speed.

use crate::Name;
use crate::task::{Answer, Task};
use glam::Vec3;
use hairis::HairParams;
use hairis::textbook::{Oracle, Parameters, Shape};

/// Largest error of an answer that counts as right, relative for value and density, rad for a direction: what the
/// textbook in `f32`, which takes part, needs. The kernels' own bounds are tighter, and their tests hold them.
const TOLERANCE: f64 = 1e-3;
/// Values below this count as 0: the kernels' Gaussians end at `2^-115`, those of the `f32` textbook at denormals.
const NEGLIGIBLE: f64 = 1e-25;
/// One answer in a hundred may be wrong: samples next to the boundary of two lobes may choose either, and the `f32`
/// textbook loses digits near the axis. A wrong lane is one in eight.
const MOST_WRONG: usize = 100;

/// What was asked for one direction.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    /// The hair.
    pub hair: HairParams,
    /// Towards the viewer.
    pub wo: Vec3,
    /// What for.
    pub given: Given,
}

/// A question about a gather point.
#[derive(Clone, Copy, Debug)]
pub enum Given {
    /// Value and density of this direction.
    Wi(Vec3),
    /// A direction for these numbers, its value and density.
    Xi([f32; 3]),
}

/// Compares a pass with the textbook in `f64` of this shape, and with the matched sampler if there are bands.
///
/// # Panics
///
/// If more than one answer in a hundred is wrong, or a call has none.
pub fn check(name: &Name, task: &mut impl Task, oracle: (Shape, Option<usize>), asked: impl Fn(usize) -> Asked) {
    let answers = task.answers();
    assert!(answers.len() >= task.calls(), "{name}: {} answers to {} calls", answers.len(), task.calls());
    let wrong: Vec<usize> = (0..answers.len()).filter(|i| !right(&asked(*i), oracle, &answers[*i])).collect();
    assert!(
        wrong.len() * MOST_WRONG <= answers.len(),
        "{name}: {} of {} answers are wrong, the first for {:?}: {:?}",
        wrong.len(),
        answers.len(),
        wrong.first().map(|i| asked(*i)),
        wrong.first().map(|i| answers[*i]),
    );
}

fn right(asked: &Asked, (shape, bands): (Shape, Option<usize>), answer: &Answer) -> bool {
    let to_f64 = |v: Vec3| v.to_array().map(f64::from);
    let point = Oracle::<f64>::prepare(&Parameters::from(&asked.hair), shape, to_f64(asked.wo), bands);
    let truth = match asked.given {
        Given::Wi(wi) => to_f64(wi),
        Given::Xi(xi) => {
            let drawn = point.sample(xi.map(f64::from));
            if drawn.lobe.is_none() {
                return answer.pdf == Some(0.0);
            }
            drawn.wi
        }
    };
    let wi = answer.wi.map_or(truth, to_f64);
    let (value, pdf) = (point.eval(wi), point.pdf(wi));
    let close = |got: f32, want: f64| (f64::from(got) - want).abs() <= TOLERANCE * want + NEGLIGIBLE;
    let apart = wi.iter().zip(truth).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    apart <= TOLERANCE
        && answer.pdf.is_none_or(|got| close(got, pdf))
        && answer.value.is_none_or(|got| got.into_iter().zip(value).all(|(got, want)| close(got, want)))
}
