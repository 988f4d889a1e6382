//! Local part of dual scattering: light that the hair behind a hit sends back through it.

use super::{Averages, LEAST_VARIANCE};
use crate::simd::Lanes;

/// Light that hair without end sends back, beyond what its fibres scatter once: linear RGB.
///
/// Light meets fibres by chance, and each sends the shares f and b of it on and back. Then the hair reflects `R = b / (1 - f + q)` with
/// `q = sqrt((1 - f)^2 - b^2)`, Kubelka and Munk's formula. A viewer who sees fibres at the depths that he sees them gets `(b + A) / (2 - f)`
/// of it, with the local part `A`, so that `A = R (1 - q)`. Means of shift and variance count the scatterings of each kind on the way, which
/// are the logarithmic derivatives of `A` by f and b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Local<L = f32> {
    /// Share of the light that comes back.
    pub albedo: [L; 3],
    /// Mean of `theta_i + theta_o`, rad.
    pub shift: [L; 3],
    /// Variance of `theta_i + theta_o`, rad^2.
    pub variance: [L; 3],
}

/// Largest mean number of scatterings, which is infinite for fibres without absorption.
const MOST_SCATTERINGS: f32 = 200.0;

impl<L: Lanes> Averages<L> {
    /// Computes the light that comes back from hair of these fibres. Albedos above 1 in all count as 1.
    #[inline(always)]
    #[must_use]
    pub fn local(&self) -> Local<L> {
        let none = [L::splat(0.0); 3];
        let mut local = Local {
            albedo: none,
            shift: none,
            variance: none,
        };
        let (forward, backward) = (&self.forward, &self.backward);
        let mut c = 0;
        while c < 3 {
            let [albedo, goes_on, turns] = returned(forward.albedo[c], backward.albedo[c]);
            local.albedo[c] = albedo;
            local.shift[c] = goes_on.mul_add(forward.shift[c], turns * backward.shift[c]);
            local.variance[c] = goes_on
                .mul_add(forward.variance[c], turns * backward.variance[c])
                .max(L::splat(LEAST_VARIANCE));
            c += 1;
        }
        local
    }
}

/// Computes the light that comes back after more than one scattering, and the mean numbers of scatterings forward and backward on its way.
#[inline(always)]
fn returned<L: Lanes>(forward: L, backward: L) -> [L; 3] {
    let c = L::splat;
    let (zero, one, least) = (c(0.0), c(1.0), c(1e-6));
    // In all at most 1, and the backward share not 0, where nothing comes back.
    let b = backward.max(least).min(one);
    let f = forward.max(zero).min(one - b);
    let rest = one - f;
    let root = ((rest - b) * (rest + b)).max(zero).sqrt();
    let (sum, less) = (rest + root, (one - root).max(least));
    let reflectance = L::quotient(b, sum);
    let root = root.max(c(1e-4));
    let goes_on = L::quotient(f * (one + rest - root), root * less);
    let twice = (one + rest) * reflectance.mul_add(reflectance, one);
    let turns = L::quotient((twice - (root + root)) * sum, (root + root) * less);
    let most = c(MOST_SCATTERINGS);
    [
        reflectance * less,
        goes_on.min(most),
        turns.max(one).min(most),
    ]
}
