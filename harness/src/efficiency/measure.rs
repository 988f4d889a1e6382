//! Measurement, from contributions to figures: blocks of samples, moments, z-scores. Light samples join those of the BSDF by the power
//! heuristic (section 4 of the paper).

use super::case::Case;
use super::{MIN_EFFECTIVE, Technique, intensity};
use crate::sampler::Sampler;
use core::array;
use hairis_instruments::light::{Light, LightSample, product};
use hairis_instruments::sequence::{SequenceKind, XiSource};
use hairis_instruments::stats::{Estimate, Moments};

/// Moments of one cell, with the largest weight and contribution among its samples.
#[derive(Clone, Copy, Debug, Default)]
pub struct CellMoments {
    /// Moments of single contributions, of pairs, or of the means of randomisations.
    pub moments: Moments,
    pub(super) max_weight: f64,
    pub(super) max_contribution: f64,
}

impl CellMoments {
    fn see(&mut self, weight: f64, contribution: f64) {
        self.max_weight = self.max_weight.max(weight);
        self.max_contribution = self.max_contribution.max(contribution);
    }

    /// Returns the largest contribution in means, or 0 if there was none.
    pub(super) fn max_in_means(&self) -> f64 {
        if self.max_contribution > 0.0 {
            self.max_contribution / self.moments.mean()
        } else {
            0.0
        }
    }
}

/// Returns the power heuristic's weight for the technique of density `mine`, or 0 if that density is 0.
fn power_heuristic(mine: f64, other: f64) -> f64 {
    if mine == 0.0 {
        return 0.0;
    }
    // The ratio is squared rather than the densities, because densities of narrow lights are large.
    let ratio = other / mine;
    1.0 / (1.0 + ratio * ratio)
}

/// Passes the next `n` contributions of `technique` to `each`, with the weights of the samples of the BSDF.
fn contributions(
    case: &Case,
    technique: Technique,
    light: &dyn Light,
    source: &mut impl XiSource,
    n: usize,
    mut each: impl FnMut(f64, f64),
) {
    let (sampler, both) = match technique {
        Technique::Light => (None, false),
        Technique::Bsdf(sampler) => (Some(sampler), false),
        Technique::Mis(sampler) => (Some(sampler), true),
    };
    for begin in (0..n).step_by(8) {
        let lanes = (n - begin).min(8);
        let (mut weights, mut y) = ([0.0; 8], [0.0; 8]);
        if let Some(sampler) = sampler {
            let draws = case.draw(sampler, source, lanes);
            for lane in 0..lanes {
                let (dir, pdf, weight) = (draws.dir[lane], draws.pdf[lane], draws.weight[lane]);
                weights[lane] = intensity(weight);
                // A discarded sample counts, and contributes 0; its direction may be undefined. A NaN passes, so that the check finds it.
                if pdf != 0.0 {
                    let share = if both {
                        power_heuristic(pdf, light.pdf(dir))
                    } else {
                        1.0
                    };
                    y[lane] = share * intensity(product(light.radiance(dir), weight));
                }
            }
        }
        if both || sampler.is_none() {
            let samples: [LightSample; 8] = array::from_fn(|_| light.sample(source.next_xi()));
            let (value, pdf) =
                case.eval(sampler.unwrap_or(Sampler::Uniform), &samples.map(|s| s.dir));
            for (lane, s) in samples.iter().enumerate().filter(|(_, s)| s.pdf != 0.0) {
                let share = if both {
                    power_heuristic(s.pdf, pdf[lane])
                } else {
                    1.0
                };
                y[lane] += share * intensity(product(s.radiance, value[lane])) / s.pdf;
            }
        }
        weights
            .into_iter()
            .zip(y)
            .take(lanes)
            .for_each(|(weight, y)| each(weight, y));
    }
}

/// Returns the moments of the means of `n` contributions over `randomisations`, or of single independent contributions for an `n` of 1.
pub fn moments(
    case: &Case,
    technique: Technique,
    light: &dyn Light,
    [seed, stream]: [u64; 2],
    kind: SequenceKind,
    [n, randomisations]: [usize; 2],
) -> CellMoments {
    let mut tally = CellMoments::default();
    let dims = if let Technique::Bsdf(sampler) = technique {
        sampler.dims()
    } else {
        3
    };
    // Every pass of the other kinds is a randomisation of its own.
    let [runs, passes] = if kind == SequenceKind::Halton {
        [randomisations, 1]
    } else {
        [1, randomisations]
    };
    for run in 0..runs {
        let stream = if run == 0 {
            stream
        } else {
            super::stream(&[stream, run as u64])
        };
        let (mut sum, mut summed) = (0.0, 0);
        contributions(
            case,
            technique,
            light,
            &mut kind.source(seed, stream, dims, n),
            n * passes,
            |weight, y| {
                tally.see(weight, y);
                sum += y;
                summed += 1;
                if summed == n {
                    tally.moments.push(sum / n as f64);
                    (sum, summed) = (0.0, 0);
                }
            },
        );
    }
    tally
}

/// Returns the bias of the mean in standard errors, with the skewness of the samples removed to first order.
///
/// With `s = (mean - truth) / deviation` and skewness `k` of the samples, `sqrt(n) (s + k s^2/3 + k^2 s^3/27 + k/(6 n))`. The score is
/// monotone in `s`, and nearly normal even if `sqrt(n) s` is not yet.
///
/// - Source: Hall 1992, On the removal of skewness by transformation, equation (3).
/// - Domain: 0 if the mean is exactly the reference; infinite if it differs without any spread; NaN if a contribution was NaN.
#[must_use]
pub fn bias_z(moments: &Moments, reference: Estimate) -> f64 {
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
    let cubic =
        s + skewness * s * s / 3.0 + skewness * skewness * s * s * s / 27.0 + skewness / (6.0 * n);
    // The reference's own error widens the spread and leaves the shape.
    let widened = mean.standard_error / mean.standard_error.hypot(reference.standard_error);
    n.sqrt() * cubic * widened
}

/// Returns true if `samples` of variance `v` and of this skewness suffice for a test of their mean. If rare hits carry a part of the mean,
/// their number decides, which is `n / skewness^2` whatever the part; if they carry all of it, `n / (1 + V)` decides as well. NaN (black
/// light, black hair) does not prevent the test.
#[must_use]
pub fn is_tested(samples: usize, [v, skewness]: [f64; 2]) -> bool {
    let n = samples as f64;
    (v.is_nan() || n / (1.0 + v) >= MIN_EFFECTIVE)
        && (skewness.is_nan() || n >= MIN_EFFECTIVE * skewness * skewness)
}
