//! Sums of weighted contributions against closed forms.

use core::array::from_fn;
use hairis_harness::variance::tally::*;
use hairis_instruments::sequence::Independent;
use hairis_instruments::stats::Moments;
use wide::f64x8;

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
    assert!((got.mean.standard_error / moments.mean_estimate().standard_error - 1.0).abs() < 1e-9);
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
pub(super) fn assert_honest(ratio: u64, truth: [f64; 3], mut figures: impl FnMut(u64) -> Figures) {
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
