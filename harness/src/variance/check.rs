//! Checks that every row of figures must pass, whatever its model.

use super::Measured;
use crate::efficiency::{FALSE_ALARM, z_bound};
use hairis_instruments::stats::sidak;

/// Relative amount by which single precision may round a weight above its bound.
const ROUNDING: f64 = 1e-4;

/// Row of figures to check.
#[derive(Clone, Debug)]
pub struct Checked<'a> {
    /// Place of the row, in words.
    pub place: String,
    /// Name of the row's group. Rows of one group follow each other, and have one mean under the constant light.
    pub group: String,
    /// Whether the row is of a sampler under the constant light.
    pub is_constant: bool,
    /// Figures of the row.
    pub measured: &'a Measured,
}

/// Returns a line for each figure that cannot be right.
///
/// - No weight is above its proven bound.
/// - Under the constant light, which every direction sees, the samplers of a group agree on the mean with the first of them. All of their
///   scores together stay below a bound that chance alone exceeds with probability [`FALSE_ALARM`].
/// - The same holds for the means of rays from the largest pools against those of samples, under every light.
#[must_use]
pub fn failures(rows: &[Checked<'_>]) -> Vec<String> {
    let mut failures = Vec::new();
    for row in rows {
        let weight = row.measured.max_weight;
        let bound = row.measured.weight_bound;
        if let Some(bound) = bound.filter(|bound| weight > bound * (1.0 + ROUNDING)) {
            failures.push(format!(
                "{}: a weight of {weight} is above its bound {bound}",
                row.place
            ));
        }
    }
    let mut beyond = |scores: &[(f64, &Checked<'_>)], of: &str, other: &str| {
        let bound = z_bound(sidak(FALSE_ALARM, scores.len()));
        for (z, row) in scores.iter().filter(|(z, _)| *z > bound) {
            failures.push(format!(
                "{}: {of} is {z:.2} standard errors from that of {other}, allowed {bound:.2}",
                row.place
            ));
        }
    };
    let constant: Vec<&Checked<'_>> = rows.iter().filter(|row| row.is_constant).collect();
    let scores = constant
        .chunk_by(|a, b| a.group == b.group)
        .flat_map(|group| {
            group[1..].iter().map(|row| {
                let [first, mean] = [group[0], row].map(|row| row.measured.figures.mean);
                let z =
                    (mean.value - first.value) / mean.standard_error.hypot(first.standard_error);
                (if z.is_nan() { f64::INFINITY } else { z.abs() }, *row)
            })
        });
    beyond(&scores.collect::<Vec<_>>(), "its mean", "uniform");
    let biases = rows
        .iter()
        .filter_map(|row| Some((row.measured.bias?.abs(), row)));
    beyond(
        &biases.collect::<Vec<_>>(),
        "the mean of rays from candidates",
        "samples",
    );
    failures
}
