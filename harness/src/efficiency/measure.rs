//! From contributions to figures: blocks of samples, moments, z-scores.

use super::case::Case;
use super::{MIN_EFFECTIVE, Reference, intensity};
use crate::light::Light;
use crate::sampler::Sampler;
use crate::sequence::{SequenceKind, XiSource};
use crate::stats::{Estimate, Moments};

/// Moments of one cell, and the largest numbers seen on the way.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CellMoments {
    /// Of single contributions, or of the means of randomisations.
    pub(super) moments: Moments,
    pub(super) max_weight: f64,
    pub(super) max_contribution: f64,
}

impl CellMoments {
    fn see(&mut self, weight: f64, contribution: f64) {
        self.max_weight = self.max_weight.max(weight);
        self.max_contribution = self.max_contribution.max(contribution);
    }
}

/// Intensity of a contribution `radiance * weight`.
pub(super) fn contribution(radiance: [f64; 3], weight: [f64; 3]) -> f64 {
    intensity(core::array::from_fn(|c| radiance[c] * weight[c]))
}

/// Hands the contributions of the next `n` points to `each`.
fn samples(
    case: &Case,
    sampler: Sampler,
    light: &dyn Light,
    source: &mut impl XiSource,
    n: usize,
    mut each: impl FnMut(f64, f64),
) {
    let mut left = n;
    while left > 0 {
        let lanes = left.min(8);
        let draws = case.draw(sampler, source, lanes);
        for lane in 0..lanes {
            let weight = draws.weight[lane];
            // A discarded sample counts, and contributes 0; it may have no direction to look at. A NaN is let through, for the check to find.
            let y = if draws.pdf[lane] == 0.0 { 0.0 } else { contribution(light.radiance(draws.dir[lane]), weight) };
            each(intensity(weight), y);
        }
        left -= lanes;
    }
}

/// Moments of `n` independent contributions.
pub(super) fn independent(
    case: &Case,
    sampler: Sampler,
    light: &dyn Light,
    [seed, stream]: [u64; 2],
    n: usize,
) -> CellMoments {
    let mut source = SequenceKind::Independent.source(seed, stream, sampler.dims(), n);
    let mut tally = CellMoments::default();
    samples(case, sampler, light, &mut source, n, |weight, y| {
        tally.moments.push(y);
        tally.see(weight, y);
    });
    tally
}

/// Moments of the means of `n` samples over `randomisations`.
pub(super) fn means(
    case: &Case,
    sampler: Sampler,
    kind: SequenceKind,
    light: &dyn Light,
    [seed, stream]: [u64; 2],
    [n, randomisations]: [usize; 2],
) -> CellMoments {
    let mut tally = CellMoments::default();
    let mut source = kind.source(seed, stream, sampler.dims(), n);
    for run in 0..randomisations {
        // Every pass of the other kinds is a randomisation of its own.
        if kind == SequenceKind::Halton && run > 0 {
            source = kind.source(seed, super::stream(&[stream, run as u64]), sampler.dims(), n);
        }
        let mut sum = 0.0;
        samples(case, sampler, light, &mut source, n, |weight, y| {
            sum += y;
            tally.see(weight, y);
        });
        tally.moments.push(sum / n as f64);
    }
    tally
}

/// Bias of the mean in standard errors, the skewness of the samples removed to first order.
///
/// With `s = (mean - truth) / deviation` and skewness `k` of the samples, `sqrt(n) (s + k s^2/3 + k^2 s^3/27 + k/(6 n))`: monotone in `s`, and nearly normal
/// where `sqrt(n) s` is not yet.
///
/// - Source: Hall 1992, On the removal of skewness by transformation, equation (3).
/// - Domain: 0 when the mean is exactly the reference; infinite when it differs without any spread; NaN when a contribution was NaN.
pub(crate) fn bias_z(moments: &Moments, reference: &Reference) -> f64 {
    let mean = moments.mean_estimate();
    let difference = mean.value - reference.value;
    if difference == 0.0 {
        return 0.0;
    }
    let n = moments.count() as f64;
    let deviation = moments.variance().sqrt();
    if deviation == 0.0 {
        return difference / reference.standard_error;
    }
    let skewness = moments.higher_moments()[0] / deviation.powi(3);
    let s = difference / deviation;
    let cubic = s + skewness * s * s / 3.0 + skewness * skewness * s * s * s / 27.0 + skewness / (6.0 * n);
    // The reference's own error widens the spread and leaves the shape.
    let widened = mean.standard_error / mean.standard_error.hypot(reference.standard_error);
    n.sqrt() * cubic * widened
}

/// Whether `samples` of variance `v` and of this skewness are worth enough for a test of their mean: if rare hits carry a part of it, by their number, which is
/// `n / skewness^2` whatever the part; if they carry all of it, by `n / (1 + V)` as well. What is no number (black light, black hair) is no reason not to.
pub(crate) fn is_tested(samples: usize, [v, skewness]: [f64; 2]) -> bool {
    let n = samples as f64;
    (v.is_nan() || n / (1.0 + v) >= MIN_EFFECTIVE) && (skewness.is_nan() || n >= MIN_EFFECTIVE * skewness * skewness)
}

/// `1000 / (1 + V)`.
pub(super) fn effective_per_1000(v: &Estimate) -> Estimate {
    let value = 1_000.0 / (1.0 + v.value);
    Estimate { value, standard_error: v.standard_error * value * value / 1_000.0 }
}

/// `1 / (V seconds)`.
pub(super) fn efficiency(v: &Estimate, ns: f64) -> Estimate {
    let value = 1e9 / (v.value * ns);
    Estimate { value, standard_error: value * v.standard_error / v.value }
}
