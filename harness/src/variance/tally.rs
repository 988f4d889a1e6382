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
pub(super) struct Sums<const N: usize> {
    sums: [f64x8; N],
    /// Sums of products, by the index of the first term, which is no earlier than the second.
    products: [[f64x8; N]; N],
    count: u64,
    largest: f64x8,
}

/// Sums of `m y`, `m y^2` and `m y ln y`, for one stratum.
pub(super) type Tally = Sums<3>;

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
pub(super) fn joined<const N: usize>(strata: &[Sums<N>]) -> ([f64; N], [[f64; N]; N]) {
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
pub(super) fn largest<const N: usize>(strata: &[Sums<N>]) -> f64 {
    strata
        .iter()
        .flat_map(|sums| sums.largest.to_array())
        .fold(0.0, f64::max)
}

impl Tally {
    /// Adds eight directions of contribution `y`, each counted `m`.
    #[inline]
    pub(super) fn push(&mut self, y: f64x8, m: f64x8) {
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
pub(super) fn figures(strata: &[Tally]) -> Figures {
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

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use hairis_instruments::sequence::Independent;
    use hairis_instruments::stats::Moments;

    fn draw(from: &mut Independent) -> f64x8 {
        f64x8::new(from_fn(|_| -(1.0 - from.next_f64()).ln()))
    }

    #[test]
    fn a_single_stratum_gives_the_moments() {
        let mut from = Independent::new(1, 0);
        let (mut tally, mut moments) = (Tally::default(), Moments::new());
        for _ in 0..2_000 {
            let y = draw(&mut from);
            tally.push(y, f64x8::splat(1.0));
            y.to_array().iter().for_each(|y| moments.push(*y));
        }
        let (got, want) = (figures(&[tally]), moments.relative_variance());
        assert!((got.mean.value / moments.mean() - 1.0).abs() < 1e-12);
        assert!(
            (got.mean.standard_error / moments.mean_estimate().standard_error - 1.0).abs() < 1e-9
        );
        assert!(
            (got.v.value / want.value - 1.0).abs() < 1e-3,
            "n or n - 1: {got:?} {want:?}"
        );
        assert!(
            (got.v.standard_error / want.standard_error - 1.0).abs() < 1e-3,
            "{got:?} {want:?}"
        );
        // E[w ln w] of the exponential distribution is 1 minus Euler's constant.
        assert!(got.kl.z_score(0.422_784_335_098_467).abs() < 4.0, "{got:?}");
    }

    /// Returns the estimates of a light of radiance 1 on [0, 0.1) of [0, 1), under the density `p = 1/2 + x`, with `ratio` directions of
    /// the light to one of the sampler.
    fn small_light(run: u64, ratio: u64) -> Figures {
        let mut from = Independent::new(3, run);
        let mut uniform = || f64x8::new(from_fn(|_| from.next_f64()));
        let [half, c, q] = [0.5, ratio as f64, 10.0].map(f64x8::splat);
        let mut strata = [Tally::default(); 2];
        for _ in 0..500 {
            let xi = uniform();
            let p = (f64x8::splat(0.25) + xi + xi).sqrt();
            let lit = f64x8::splat(0.6).simd_gt(p);
            let seen = lit.select(q, f64x8::ZERO);
            strata[0].push(
                lit.select(f64x8::splat(1.0) / p, f64x8::ZERO),
                p / (p + c * seen),
            );
        }
        for _ in 0..500 * ratio {
            let p = half + uniform() / q;
            strata[1].push(f64x8::splat(1.0) / p, c * p / (p + c * q));
        }
        figures(&strata)
    }

    /// Checks that mean, V and divergence of a thousand runs are off the truth by as much as their standard errors state.
    pub(in crate::variance) fn assert_honest(
        ratio: u64,
        truth: [f64; 3],
        mut figures: impl FnMut(u64) -> Figures,
    ) {
        let mut z = [Moments::new(); 3];
        for run in 0..1_000 {
            let Figures { mean, v, kl } = figures(run);
            for ((z, got), truth) in z.iter_mut().zip([mean, v, kl]).zip(truth) {
                z.push(got.z_score(truth));
            }
        }
        for (z, of) in z.iter().zip(["mean", "V", "divergence"]) {
            let (mean, variance) = (z.mean(), z.variance());
            assert!(
                mean.abs() < 0.2 && (variance - 1.0).abs() < 0.25,
                "{of} at {ratio}: {mean} {variance}"
            );
        }
    }

    #[test]
    fn both_strata_together_are_unbiased_and_their_errors_honest() {
        let entropy = |p: f64| p * p.ln() - p;
        let kl = 10.0_f64.ln() - 10.0 * (entropy(0.6) - entropy(0.5));
        for ratio in [0, 1, 3] {
            let truth = [0.1, 100.0 * 1.2_f64.ln() - 1.0, kl];
            assert_honest(ratio, truth, |run| small_light(run, ratio));
        }
    }

    #[test]
    fn nothing_seen_is_no_number() {
        let mut tally = Tally::default();
        tally.push(f64x8::ZERO, f64x8::splat(1.0));
        let got = figures(&[tally, Tally::default()]);
        assert!(
            got.mean.value == 0.0 && got.v.value.is_nan() && got.kl.value.is_nan(),
            "{got:?}"
        );
        let constant = {
            let mut tally = Tally::default();
            tally.push(f64x8::splat(3.0), f64x8::splat(1.0));
            figures(&[tally])
        };
        assert_eq!((constant.v.value, constant.v.standard_error), (0.0, 0.0));
        assert!(constant.kl.value.abs() < 1e-15, "{constant:?}");
    }
}
