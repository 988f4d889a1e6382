//! Integrals in `f64`, by composite Gauss-Legendre quadrature with panels that shrink towards the peaks.

use core::f64::consts::PI;
use std::sync::LazyLock;

/// Number of points per panel. With panels that double in width away from a peak, a Gaussian or a Cauchy bell is integrated to about
/// 1e-10 of its mass.
pub const POINTS: usize = 12;

/// Returns the Gauss-Legendre rule of `count` points: nodes and weights on [-1, 1], by Newton's method on the polynomial.
pub fn gauss(count: usize) -> Vec<(f64, f64)> {
    let n = count as f64;
    let point = |k: usize| {
        let mut x = (PI * (k as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..20 {
            let (mut before, mut here) = (1.0, x);
            for degree in 2..=count {
                let d = degree as f64;
                (before, here) = (here, ((2.0 * d - 1.0) * x * here - (d - 1.0) * before) / d);
            }
            slope = n * (x * here - before) / (x * x - 1.0);
            x -= here / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(point).collect()
}

/// Rule of one panel.
static RULE: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| gauss(POINTS));

/// Returns the ends of panels on `[lo, hi]` for bells given as (peak, width): at each peak, and at 1, 2, 4 ... widths from it.
pub fn panels(lo: f64, hi: f64, bells: &[(f64, f64)]) -> Vec<f64> {
    let mut ends = vec![lo, hi];
    for &(peak, width) in bells {
        ends.push(peak);
        let mut reach = width;
        while reach < 2.0 * PI {
            ends.extend([peak - reach, peak + reach]);
            reach *= 2.0;
        }
    }
    ends.retain(|end| (lo..=hi).contains(end));
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    ends
}

/// Returns the points and weights of the panels between successive `ends`.
pub fn rule(ends: &[f64]) -> Vec<(f64, f64)> {
    let panel = |ends: &[f64]| {
        let (middle, half) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
        RULE.iter().map(move |(x, w)| (middle + half * x, w * half))
    };
    ends.windows(2).flat_map(panel).collect()
}

/// Integrates `f` over the panels between successive `ends`.
pub fn integrate(ends: &[f64], f: impl Fn(f64) -> f64) -> f64 {
    rule(ends).into_iter().map(|(x, w)| w * f(x)).sum()
}

#[test]
fn quadrature_knows_its_integrals() {
    let ends = panels(-3.0, 3.0, &[(0.4, 0.01)]);
    let cauchy = integrate(&ends, |x| 0.01 / (PI * ((x - 0.4).powi(2) + 1e-4)));
    let exact = ((2.6_f64 / 0.01).atan() + (3.4_f64 / 0.01).atan()) / PI;
    assert!(
        (cauchy - exact).abs() < 1e-10,
        "truncated Cauchy {cauchy} against {exact}"
    );
    let gaussian =
        integrate(&ends, |x| (-(x - 0.4).powi(2) / 2e-4).exp()) / (0.01 * (2.0 * PI).sqrt());
    assert!((gaussian - 1.0).abs() < 1e-9, "Gaussian {gaussian}");
}
