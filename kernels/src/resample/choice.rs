//! Choice of a few candidates by their weights.

/// Candidate that was chosen, for which the host traces one ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// Index of the candidate.
    pub index: usize,
    /// Number of the `k` choices that selected this candidate, at least 1.
    pub count: u32,
    /// Contribution of the ray to the estimate if it is unoccluded, linear RGB.
    pub contribution: [f32; 3],
}

/// Iterator over the choices of [`choose`], in the order of the candidates.
#[derive(Clone, Debug)]
pub struct Choices<'a> {
    contribution: [&'a [f32]; 3],
    weight: &'a [f32],
    /// Next candidate, and the sum of the weights before it.
    at: usize,
    before: f64,
    /// Sum of all weights, the weight of one choice, and the position of each choice in its interval.
    sum: f64,
    step: f64,
    u: f64,
    chosen: u32,
    k: u32,
    /// Last candidate with a positive weight.
    last: usize,
}

/// Chooses `k` of the candidates with probability proportional to their weights, by one uniform number `u` in `[0, 1)`: choice j,
/// from 0 to `k - 1`, selects the candidate whose interval of the running sum holds `(u + j) / k` of the total.
///
/// The sum of `V * contribution` over the choices, V being visibility, is the estimate. Columns are those of
/// [`weigh_columns`](crate::Bsdf::weigh_columns); if they differ in length, the shortest counts. A candidate without weight is never
/// chosen, and none is chosen if all weights are 0. NaN as `u` counts as 0.
///
/// Sums are in double precision, so that a faint candidate keeps its share beside one that is a million times as bright.
#[inline]
#[must_use]
pub fn choose<'a>(contribution: [&'a [f32]; 3], weight: &'a [f32], k: u32, u: f32) -> Choices<'a> {
    let len = contribution
        .iter()
        .fold(weight.len(), |len, column| len.min(column.len()));
    let weight = weight.get(..len).unwrap_or_default();
    let (mut sum, mut last) = (0.0, 0);
    for (index, &weight) in weight.iter().enumerate() {
        sum += f64::from(weight);
        if weight > 0.0 {
            last = index;
        }
    }
    let u = f64::from(if u > 0.0 {
        u.min(1.0 - f32::EPSILON / 2.0)
    } else {
        0.0
    });
    let k = if sum > 0.0 { k } else { 0 };
    Choices {
        contribution,
        weight,
        at: 0,
        before: 0.0,
        sum,
        step: sum / f64::from(k.max(1)),
        u,
        chosen: 0,
        k,
        last,
    }
}

impl Choices<'_> {
    /// Returns the sum of all weights, which is the estimate of the mean over the channels if everything were visible.
    #[inline]
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounding to a float is the purpose"
    )]
    pub fn total(&self) -> f32 {
        self.sum.min(f64::from(f32::MAX)) as f32
    }
}

impl Iterator for Choices<'_> {
    type Item = Choice;

    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounding to a float is the purpose"
    )]
    fn next(&mut self) -> Option<Choice> {
        while self.chosen < self.k {
            let index = self.at;
            let weight = *self.weight.get(index)?;
            self.at += 1;
            self.before += f64::from(weight);
            // The last candidate with a weight takes what rounding has left over.
            let from = self.chosen;
            if index == self.last {
                self.chosen = self.k;
            }
            while self.chosen < self.k
                && (self.u + f64::from(self.chosen)) * self.step < self.before
            {
                self.chosen += 1;
            }
            let count = self.chosen - from;
            if count > 0 {
                let f = self
                    .contribution
                    .map(|column| column.get(index).copied().map_or(0.0, f64::from));
                // In double precision, because the scale of a faint candidate is more than a float holds.
                let scale = f64::from(count) * self.step * 3.0
                    / (f[0] + f[1] + f[2]).max(f64::MIN_POSITIVE);
                let contribution = f.map(|f| (f * scale).min(f64::from(f32::MAX)) as f32);
                return Some(Choice {
                    index,
                    count,
                    contribution,
                });
            }
        }
        None
    }
}
