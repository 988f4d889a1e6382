//! Perfect sampling of the hair: directions of a density proportional to the mean of RGB of `S cos theta_i`, regardless of
//! the light.
//!
//! With `f` that mean, `F` its integral over the sphere and `g` the mean of RGB of `L S cos theta_i`, such a direction
//! contributes `F g / f`, of second moment `F` times the integral of `g^2 / f`. Such directions are never drawn: the integrals are
//! estimated from the directions of [`SOURCE`] and of the light, which exist anyway. In these, with `w = f / p` and
//! `r = g / f`, the integrands are `w r` and `w r^2`. `r` is at most the light's radiance, and `w` at most its proven
//! bound, so that no direction counts for much.
//!
//! `F` is the mean of the same weights `w`, not the albedo of a quadrature: errors of the set of directions are then common
//! to all three integrals, and cancel. Under constant light they cancel entirely, and V is 0 to rounding. The error of `F`
//! is a hundredth of a percent, and enters those of V and of the divergence with its covariances.
//!
//! It is a limit, not a bound: samplers that follow the hair ever more closely approach these figures; one that happens to
//! favour bright parts of the light can be better, as tails wider than the hair's are under a small sun.

use super::cell::Measured;
use super::tally::Figures;
use crate::sampler::Sampler;
use crate::stats::Estimate;
use wide::f64x8;

/// Source of the directions: the sampler whose weights vary least.
pub(super) const SOURCE: Sampler = Sampler::Matched25;

/// Numbers whose means are estimated together.
const N: usize = 4;

/// Sums over the directions of one stratum, the sampler's or the light's, one per lane.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PerfectTally {
    /// Of the weight that counts for F, and of `m w r`, `m w r^2` and `m w r ln r`.
    sums: [f64x8; N],
    /// Of the products of each two of them, the first no earlier than the second.
    products: [[f64x8; N]; N],
    count: u64,
    /// Largest `r`.
    largest: f64x8,
}

impl PerfectTally {
    /// Adds eight directions drawn from the sampler, of weight `w` and contribution `y = w r`, each counted `m`.
    pub(super) fn push_drawn(&mut self, w: f64x8, y: f64x8, m: f64x8) {
        self.push(w, w, y, m);
    }

    /// Adds eight directions drawn from the light.
    pub(super) fn push_lit(&mut self, w: f64x8, y: f64x8, m: f64x8) {
        self.push(f64x8::ZERO, w, y, m);
    }

    fn push(&mut self, z: f64x8, w: f64x8, y: f64x8, m: f64x8) {
        self.count += 8;
        let r = w.simd_gt(f64x8::ZERO).select(y / w, f64x8::ZERO);
        self.largest = self.largest.max(r);
        let a = m * y;
        // The clamp keeps 0 ln 0 from being anything but 0.
        let terms = [z, a, a * r, a * r.max(f64x8::splat(f64::MIN_POSITIVE)).ln()];
        for (i, x) in terms.into_iter().enumerate() {
            self.sums[i] += x;
            for (product, other) in self.products[i].iter_mut().zip(&terms[..=i]) {
                *product += x * *other;
            }
        }
    }

    /// Means of the four numbers, and the covariances of those means.
    fn means(&self) -> ([f64; N], [[f64; N]; N]) {
        if self.count < 2 {
            return ([0.0; N], [[0.0; N]; N]);
        }
        let n = self.count as f64;
        let mean = |sum: f64x8| sum.to_array().iter().sum::<f64>() / n;
        let means = self.sums.map(mean);
        let covariance = |i: usize, j: usize| {
            let [i, j] = [i.max(j), i.min(j)];
            (mean(self.products[i][j]) - means[i] * means[j]) / (n - 1.0)
        };
        (means, core::array::from_fn(|i| core::array::from_fn(|j| covariance(i, j))))
    }
}

/// The estimates of both strata together: the sampler's directions and the light's. No numbers where no direction
/// contributed.
///
/// Standard errors are those of the delta method.
pub(super) fn measured(strata: &[PerfectTally; 2]) -> Measured {
    let (mut means, mut covariances) = ([0.0; N], [[0.0; N]; N]);
    for (of, s) in strata.iter().map(PerfectTally::means) {
        for i in 0..N {
            means[i] += of[i];
            covariances[i].iter_mut().zip(s[i]).for_each(|(sum, x)| *sum += x);
        }
    }
    let [z, a, b, c] = means;
    let estimate = |value, gradient: [f64; N]| {
        let row = |i: usize| (0..N).map(|j| gradient[i] * gradient[j] * covariances[i][j]).sum::<f64>();
        Estimate { value, standard_error: (0..N).map(row).sum::<f64>().max(0.0).sqrt() }
    };
    let square = a * a;
    let figures = Figures {
        mean: estimate(a, [0.0, 1.0, 0.0, 0.0]),
        v: estimate(z * b / square - 1.0, [b / square, -2.0 * z * b / (square * a), z / square, 0.0]),
        kl: estimate(c / a + z.ln() - a.ln(), [1.0 / z, -(c / a + 1.0) / a, 0.0, 1.0 / a]),
    };
    let brightest = strata.iter().flat_map(|tally| tally.largest.to_array()).fold(0.0, f64::max);
    Measured { figures, max_weight: z, max_contribution: z * brightest / a, rays: None }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::GaussLegendre;
    use crate::sequence::Independent;
    use crate::study::tally::tests::assert_honest;

    /// Hair and light on [0, 1): `f`, its integral, and the light's radiance and density on [0, 0.1).
    fn f(x: f64) -> f64 {
        1.0 + x * x
    }
    const F: f64 = 4.0 / 3.0;
    const LIT: f64 = 0.1;

    fn radiance(x: f64) -> f64 {
        if x < LIT { 1.0 + 20.0 * x } else { 0.0 }
    }

    /// From directions of density `1/2 + x`, and `ratio` of the light's to one of them.
    fn estimated(run: u64, ratio: u64) -> Measured {
        let mut from = Independent::new(4, run);
        let mut strata = [PerfectTally::default(); 2];
        let c = ratio as f64;
        let of = |x: [f64; 8], share: f64| {
            let p = |x: f64| 0.5 + x;
            let q = |x: f64| if x < LIT { 1.0 / LIT } else { 0.0 };
            let w = x.map(|x| f(x) / p(x));
            let y = x.map(|x| radiance(x) * f(x) / p(x));
            let m = x.map(|x| share * p(x) / (p(x) + c * q(x)));
            [w, y, m].map(f64x8::new)
        };
        for _ in 0..500 {
            // The root of x/2 + x^2/2 = xi.
            let [w, y, m] = of(core::array::from_fn(|_| (0.25 + 2.0 * from.next_f64()).sqrt() - 0.5), 1.0);
            strata[0].push_drawn(w, y, m);
        }
        for _ in 0..500 * ratio {
            let [w, y, m] = of(core::array::from_fn(|_| LIT * from.next_f64()), c);
            strata[1].push_lit(w, y, m);
        }
        measured(&strata)
    }

    #[test]
    fn estimates_are_unbiased_and_their_errors_honest() {
        let rule = GaussLegendre::new(16);
        let over = |of: &dyn Fn(f64) -> f64| rule.on(0.0, LIT).map(|[x, w]| w * of(x)).sum::<f64>();
        let mean = over(&|x| f(x) * radiance(x));
        let v = F * over(&|x| f(x) * radiance(x).powi(2)) / (mean * mean) - 1.0;
        let kl = over(&|x| f(x) * radiance(x) / mean * (F * radiance(x) / mean).ln());
        for ratio in [0, 1, 3] {
            assert_honest(ratio, [mean, v, kl], |run| {
                let Measured { figures, max_weight, max_contribution, .. } = estimated(run, ratio);
                assert!((max_weight / F - 1.0).abs() < 0.05, "every weight is F: {max_weight}");
                let most = max_contribution * figures.mean.value / max_weight;
                assert!(most > 2.5 && most <= 3.0, "the brightest of 1 to 3: {most}");
                figures
            });
        }
    }

    #[test]
    fn nothing_seen_is_no_number_and_light_from_everywhere_leaves_nothing() {
        let mut tally = PerfectTally::default();
        let one = f64x8::splat(1.0);
        tally.push_drawn(one, f64x8::ZERO, one);
        let dark = measured(&[tally, PerfectTally::default()]).figures;
        assert!(dark.mean.value == 0.0 && dark.v.value.is_nan() && dark.kl.value.is_nan(), "{dark:?}");
        let mut tally = PerfectTally::default();
        for k in 1..9 {
            let w = f64x8::new(core::array::from_fn(|lane| 1.0 / (lane + k) as f64));
            tally.push_drawn(w, w + w, one);
        }
        let even = measured(&[tally, PerfectTally::default()]).figures;
        assert!(even.v.value.abs() < 1e-14 && even.v.standard_error < 1e-7, "{even:?}");
        assert!(even.kl.value.abs() < 1e-14 && even.kl.standard_error < 1e-7, "{even:?}");
        assert!(even.mean.standard_error > 0.01, "weights that vary: {even:?}");
    }
}
