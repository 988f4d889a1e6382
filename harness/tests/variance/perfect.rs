//! Perfect sampling, as estimated from directions of others.

use super::tally::assert_honest;
use hairis_harness::variance::Measured;
use hairis_harness::variance::perfect::*;
use hairis_instruments::quadrature::GaussLegendre;
use hairis_instruments::sequence::Independent;
use wide::f64x8;

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
