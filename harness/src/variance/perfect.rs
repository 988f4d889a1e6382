//! Perfect sampling of the hair: directions of a density proportional to the mean of RGB of `S cos theta_i`, regardless of the light.
//!
//! With `f` that mean, `F` its integral over the sphere and `g` the mean of RGB of `L S cos theta_i`, such a direction contributes
//! `F g / f`, of second moment `F` times the integral of `g^2 / f`. Such directions are never drawn, because the integrals are estimated
//! from the directions of [`SOURCE`] and of the light, which exist anyway. In these, with `w = f / p` and `r = g / f`, the integrands are
//! `w r` and `w r^2`. `r` is at most the light's radiance, and `w` at most its proven bound, so that no direction has much influence.
//!
//! `F` is the mean of the same weights `w`, not the albedo of a quadrature. Errors of the set of directions are then common to all three
//! integrals, and cancel. Under constant light they cancel entirely, and V is 0 to rounding. The error of `F` is a hundredth of a percent,
//! and enters those of V and of the divergence with its covariances.
//!
//! The figures are a limit, not a bound: samplers that follow the hair ever more closely approach them. A sampler that happens to favour
//! bright parts of the light can be better, as one with tails wider than the hair's is under a small sun.

use super::Measured;
use super::tally::{Figures, Sums, joined, largest};
use crate::sampler::Sampler;
use hairis_instruments::stats::Estimate;
use wide::f64x8;

/// Sampler that the directions come from: the one whose weights vary least, which is the last of the list.
pub const SOURCE: Sampler = Sampler::ALL[Sampler::ALL.len() - 1];

/// Sums of the weight that counts for F, and of `m w r`, `m w r^2` and `m w r ln r`; the largest number is an `r`.
pub type PerfectTally = Sums<4>;

impl PerfectTally {
    /// Adds eight directions of weight `w` and contribution `y = w r`, each counted `m`. `z` is the weight again if the directions were
    /// drawn from the sampler, and 0 if they were drawn from the light.
    pub fn push(&mut self, z: f64x8, w: f64x8, y: f64x8, m: f64x8) {
        let r = w.simd_gt(f64x8::ZERO).select(y / w, f64x8::ZERO);
        self.see(r);
        let a = m * y;
        // The clamp ensures that 0 ln 0 is 0.
        self.add([z, a, a * r, a * r.max(f64x8::splat(f64::MIN_POSITIVE)).ln()]);
    }
}

/// Returns the estimates of both strata together: the sampler's directions and the light's. They are NaN if no direction contributed.
///
/// Standard errors are those of the delta method.
#[must_use]
pub fn measured(strata: &[PerfectTally; 2]) -> Measured {
    let ([z, a, b, c], covariances) = joined(strata);
    let estimate = |value, gradient: [f64; 4]| {
        let row = |i: usize| {
            (0..4)
                .map(|j| gradient[i] * gradient[j] * covariances[i][j])
                .sum::<f64>()
        };
        Estimate {
            value,
            standard_error: (0..4).map(row).sum::<f64>().max(0.0).sqrt(),
        }
    };
    let square = a * a;
    let figures = Figures {
        mean: estimate(a, [0.0, 1.0, 0.0, 0.0]),
        v: estimate(
            z * b / square - 1.0,
            [b / square, -2.0 * z * b / (square * a), z / square, 0.0],
        ),
        kl: estimate(
            c / a + z.ln() - a.ln(),
            [1.0 / z, -(c / a + 1.0) / a, 0.0, 1.0 / a],
        ),
    };
    let max_contribution = z * largest(strata) / a;
    Measured {
        figures,
        max_weight: z,
        weight_bound: None,
        max_contribution,
        rays: None,
        bias: None,
    }
}
