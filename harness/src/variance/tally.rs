//! Estimates of one sampler under one light: mean, relative variance and divergence from weighted contributions.
//!
//! The contribution of a direction is `y = L S cos theta_i / p`, with `p` the sampler's density. Its moments `E_p[y]`, `E_p[y^2]` and
//! `E_p[y ln y]` are integrals over the sphere, and directions of any density estimate them. Directions of the sampler alone would have to
//! be millions to hit a small sun often enough. Therefore directions drawn from the light (density `q`) join them by the balance heuristic:
//! with `n` of the one and `c n` of the other, a direction counts `p / (p + c q)` among the sampler's and `c p / (p + c q)` among the
//! light's.

use core::array::from_fn;
use hairis_instruments::stats::Estimate;
use serde::Serialize;
use wide::f64x8;

/// Sums over the directions of one stratum, the sampler's or the light's, one per lane: of `N` terms, and of the product of each two of
/// them.
#[derive(Clone, Copy, Debug)]
pub struct Sums<const N: usize> {
    sums: [f64x8; N],
    /// Sums of products, by the index of the first term, which is no earlier than the second.
    products: [[f64x8; N]; N],
    count: u64,
    largest: f64x8,
}

/// Sums of `m y`, `m y^2` and `m y ln y`, for one stratum.
pub type Tally = Sums<3>;

/// Figures of a sampler under a light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Mean `E_p[y]`, which is the integral of `L S cos theta_i`.
    pub mean: Estimate,
    /// Relative variance of one sample, `E_p[y^2] / E_p[y]^2 - 1`.
    pub v: Estimate,
    /// Kullback-Leibler divergence of the sampler's density from the normalised integrand, in nats:
    /// `E_p[w ln w]` with `w = y / E_p[y]`.
    pub kl: Estimate,
}

impl<const N: usize> Default for Sums<N> {
    fn default() -> Self {
        let zero = [f64x8::ZERO; N];
        Self {
            sums: zero,
            products: [zero; N],
            count: 0,
            largest: f64x8::ZERO,
        }
    }
}

impl<const N: usize> Sums<N> {
    /// Counts eight directions, and updates the largest number with `x`.
    #[inline]
    pub(super) fn see(&mut self, x: f64x8) {
        self.count += 8;
        self.largest = self.largest.max(x);
    }

    /// Adds the terms of eight directions.
    #[inline]
    pub(super) fn add(&mut self, terms: [f64x8; N]) {
        for (i, x) in terms.into_iter().enumerate() {
            self.sums[i] += x;
            for (product, other) in self.products[i].iter_mut().zip(&terms[..=i]) {
                *product += x * *other;
            }
        }
    }

    /// Returns the means of the terms, and the covariances of those means.
    fn means(&self) -> ([f64; N], [[f64; N]; N]) {
        if self.count < 2 {
            return ([0.0; N], [[0.0; N]; N]);
        }
        let n = self.count as f64;
        let mean = |sum: f64x8| sum.to_array().iter().sum::<f64>() / n;
        let means = self.sums.map(mean);
        let covariance = |i: usize, j: usize| {
            (mean(self.products[i.max(j)][i.min(j)]) - means[i] * means[j]) / (n - 1.0)
        };
        (means, from_fn(|i| from_fn(|j| covariance(i, j))))
    }
}

/// Returns the means and covariances of all strata together.
pub fn joined<const N: usize>(strata: &[Sums<N>]) -> ([f64; N], [[f64; N]; N]) {
    let (mut means, mut covariances) = ([0.0; N], [[0.0; N]; N]);
    for (m, s) in strata.iter().map(Sums::means) {
        for i in 0..N {
            means[i] += m[i];
            covariances[i]
                .iter_mut()
                .zip(s[i])
                .for_each(|(sum, x)| *sum += x);
        }
    }
    (means, covariances)
}

/// Returns the largest number that was counted.
pub fn largest<const N: usize>(strata: &[Sums<N>]) -> f64 {
    strata
        .iter()
        .flat_map(|sums| sums.largest.to_array())
        .fold(0.0, f64::max)
}

impl Tally {
    /// Adds eight directions of contribution `y`, each counted `m`.
    #[inline]
    pub fn push(&mut self, y: f64x8, m: f64x8) {
        self.see(y);
        // Most directions miss a small light. They count, and add nothing.
        if !y.simd_gt(f64x8::ZERO).any() {
            return;
        }
        let a = m * y;
        // The clamp ensures that 0 ln 0 is 0.
        self.add([a, a * y, a * y.max(f64x8::splat(f64::MIN_POSITIVE)).ln()]);
    }
}

/// Returns the estimates of the directions of all strata together, or NaN if no direction contributed.
///
/// Standard errors are those of the delta method.
#[must_use]
pub fn figures(strata: &[Tally]) -> Figures {
    let ([a, b, c], [[aa, ab, ac], [_, bb, _], [_, _, cc]]) = joined(strata);
    let of = |value, variance: f64| Estimate {
        value,
        standard_error: variance.max(0.0).sqrt(),
    };
    // Gradients of b/a^2 - 1 and of c/a - ln a, by the means they depend on.
    let (v_a, v_b) = (-2.0 * b / (a * a * a), 1.0 / (a * a));
    let (kl_a, kl_c) = (-(c / a + 1.0) / a, 1.0 / a);
    Figures {
        mean: of(a, aa),
        v: of(
            b / (a * a) - 1.0,
            v_a * v_a * aa + 2.0 * v_a * v_b * ab + v_b * v_b * bb,
        ),
        kl: of(
            c / a - a.ln(),
            kl_a * kl_a * aa + 2.0 * kl_a * kl_c * ac + kl_c * kl_c * cc,
        ),
    }
}
