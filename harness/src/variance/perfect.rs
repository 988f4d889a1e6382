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
pub(super) type PerfectTally = Sums<4>;

impl PerfectTally {
    /// Adds eight directions of weight `w` and contribution `y = w r`, each counted `m`. `z` is the weight again if the directions were
    /// drawn from the sampler, and 0 if they were drawn from the light.
    pub(super) fn push(&mut self, z: f64x8, w: f64x8, y: f64x8, m: f64x8) {
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
pub(super) fn measured(strata: &[PerfectTally; 2]) -> Measured {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::variance::tally::tests::assert_honest;
    use hairis_instruments::quadrature::GaussLegendre;
    use hairis_instruments::sequence::Independent;

    /// Hair and light on [0, 1): `f`, its integral, and the light's radiance and density on [0, 0.1).
    fn f(x: f64) -> f64 {
        1.0 + x * x
    }
    const F: f64 = 4.0 / 3.0;
    const LIT: f64 = 0.1;

    fn radiance(x: f64) -> f64 {
        if x < LIT { 1.0 + 20.0 * x } else { 0.0 }
    }

    /// Returns estimates from directions of density `1/2 + x`, with `ratio` of the light's to one of them.
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
            let [w, y, m] = of(
                core::array::from_fn(|_| (0.25 + 2.0 * from.next_f64()).sqrt() - 0.5),
                1.0,
            );
            strata[0].push(w, w, y, m);
        }
        for _ in 0..500 * ratio {
            let [w, y, m] = of(core::array::from_fn(|_| LIT * from.next_f64()), c);
            strata[1].push(f64x8::ZERO, w, y, m);
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
                let Measured {
                    figures,
                    max_weight,
                    max_contribution,
                    ..
                } = estimated(run, ratio);
                assert!(
                    (max_weight / F - 1.0).abs() < 0.05,
                    "every weight is F: {max_weight}"
                );
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
        tally.push(one, one, f64x8::ZERO, one);
        let dark = measured(&[tally, PerfectTally::default()]).figures;
        assert!(
            dark.mean.value == 0.0 && dark.v.value.is_nan() && dark.kl.value.is_nan(),
            "{dark:?}"
        );
        let mut tally = PerfectTally::default();
        for k in 1..9 {
            let w = f64x8::new(core::array::from_fn(|lane| 1.0 / (lane + k) as f64));
            tally.push(w, w, w + w, one);
        }
        let even = measured(&[tally, PerfectTally::default()]).figures;
        assert!(
            even.v.value.abs() < 1e-14 && even.v.standard_error < 1e-7,
            "{even:?}"
        );
        assert!(
            even.kl.value.abs() < 1e-14 && even.kl.standard_error < 1e-7,
            "{even:?}"
        );
        assert!(
            even.mean.standard_error > 0.01,
            "weights that vary: {even:?}"
        );
    }
}
