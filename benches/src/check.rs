//! Checks of the answers of entry points, because the speed of a wrong kernel means nothing.

use crate::entries::name::Name;
use crate::resample::{COUNTS, SKY_PDF};
use crate::task::{Answer, Task};
use glam::Vec3;
use hairis_reference::{Reference, reference};
use hairis_variants::{ModelId, Values};

/// Largest error of an answer that counts as correct: relative for values and densities, in rad for directions. The `f32` reference is
/// one of the contenders and needs a tolerance this large. The kernels' own bounds are tighter, and the kernels' tests check them.
const TOLERANCE: f64 = 1e-3;
/// Absolute error that is always accepted, so that smaller values count as 0: the kernels' Gaussians end at `2^-115`, those of the
/// `f32` reference at denormals.
const NEGLIGIBLE: f64 = 1e-25;
/// Number of answers of which one may be wrong, because samples next to the boundary of two lobes may choose either, and the `f32`
/// reference loses digits near the axis. A wrong lane would be one answer in eight.
const MOST_WRONG: usize = 100;

/// Query for one direction: the hair, the view and the arguments of the call.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    /// Parameters of the hair.
    pub values: Values,
    /// Direction `wo` towards the viewer.
    pub wo: Vec3,
    /// Arguments of the call.
    pub given: Given,
}

/// Arguments of a query about a shading point, which determine the expected answer.
#[derive(Clone, Copy, Debug)]
pub enum Given {
    /// Value and density of this direction.
    Wi(Vec3),
    /// Direction sampled with these numbers, with its value and density.
    Xi([f32; 3]),
    /// Contribution (as value) and weight (as density) of this direction, taken as a candidate under the sky of
    /// [`resample`](crate::resample).
    Candidate(Vec3),
    /// Contribution (as value) and weight (as density) of the direction that a sampler returns for these numbers.
    Proposal([f32; 3]),
    /// Contribution of the candidate that the answer names.
    Kept,
}

/// Compares the answers of a pass with the formulas of the model in `f64`.
///
/// # Panics
///
/// Panics if more than one answer in a hundred is wrong, or if there are fewer answers than calls.
pub fn check(name: &Name, task: &mut impl Task, model: ModelId, asked: impl Fn(usize) -> Asked) {
    let answers = task.answers();
    assert!(
        answers.len() >= task.calls(),
        "{name}: {} answers to {} calls",
        answers.len(),
        task.calls()
    );
    let wrong: Vec<usize> = (0..answers.len())
        .filter(|i| !right(&asked(*i), model, &answers[*i]))
        .collect();
    assert!(
        wrong.len() * MOST_WRONG <= answers.len(),
        "{name}: {} of {} answers are wrong, the first for {:?}: {:?}",
        wrong.len(),
        answers.len(),
        wrong.first().map(|i| asked(*i)),
        wrong.first().map(|i| answers[*i]),
    );
}

fn right(asked: &Asked, model: ModelId, answer: &Answer) -> bool {
    let point = reference(model, &asked.values, to_f64(asked.wo), 0.0).expect("checked parameters");
    let truth = match asked.given {
        Given::Wi(wi) | Given::Candidate(wi) => Some(to_f64(wi)),
        Given::Xi(xi) | Given::Proposal(xi) => drawn(&*point, xi),
        Given::Kept => answer.wi.map(to_f64),
    };
    match asked.given {
        Given::Wi(_) | Given::Xi(_) => is_right(&*point, [1.0; 3], truth, answer),
        Given::Candidate(_) | Given::Proposal(_) | Given::Kept => {
            agrees(truth, answer, |wi| weighed(&*point, wi))
        }
    }
}

/// Returns the contribution and the weight of a candidate.
fn weighed(point: &dyn Reference<f64>, wi: [f64; 3]) -> ([f64; 3], f64) {
    let cosine = wi[1].hypot(wi[2]);
    // The sky of `resample`, in double precision.
    let (value, radiance) = (point.eval(wi), wi.map(|x| 1.0 + 0.5 * x));
    let f = [0, 1, 2].map(|c: usize| radiance[c] * value[c] * cosine);
    let density =
        f64::from(COUNTS.bsdf) * point.pdf(wi) + f64::from(COUNTS.light) * f64::from(SKY_PDF);
    (f, f.iter().sum::<f64>() / (3.0 * density))
}

/// Returns the direction that the numbers `xi` yield at a shading point, or `None` if the sample is discarded.
#[must_use]
pub fn drawn(point: &dyn Reference<f64>, xi: [f32; 3]) -> Option<[f64; 3]> {
    let sample = point.sample(xi.map(f64::from));
    sample.lobe.map(|_| sample.wi)
}

/// Returns true if an answer is correct for the direction `truth`, which is given or which a sample must have. With `None` the sample
/// must be discarded. The expected value is multiplied by `factors`, channel by channel.
#[must_use]
pub fn is_right(
    point: &dyn Reference<f64>,
    factors: [f64; 3],
    truth: Option<[f64; 3]>,
    answer: &Answer,
) -> bool {
    agrees(truth, answer, |wi| {
        let value = point.eval(wi);
        (
            [0, 1, 2].map(|c: usize| factors[c] * value[c]),
            point.pdf(wi),
        )
    })
}

/// Returns true if an answer has the right direction, and the value and density that `expected` returns for that direction.
fn agrees(
    truth: Option<[f64; 3]>,
    answer: &Answer,
    expected: impl Fn([f64; 3]) -> ([f64; 3], f64),
) -> bool {
    let Some(truth) = truth else {
        return answer.pdf == Some(0.0);
    };
    let wi = answer.wi.map_or(truth, to_f64);
    let (value, pdf) = expected(wi);
    let close =
        |got: f32, want: f64| (f64::from(got) - want).abs() <= TOLERANCE * want + NEGLIGIBLE;
    let apart = wi
        .iter()
        .zip(truth)
        .map(|(a, b)| (a - b).powi(2))
        .sum::<f64>()
        .sqrt();
    apart <= TOLERANCE
        && answer.pdf.is_none_or(|got| close(got, pdf))
        && answer.value.is_none_or(|got| {
            got.into_iter()
                .zip(value)
                .all(|(got, want)| close(got, want))
        })
}

/// Returns the components of `v` in double precision.
pub(crate) fn to_f64(v: Vec3) -> [f64; 3] {
    v.to_array().map(f64::from)
}
