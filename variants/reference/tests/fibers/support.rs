//! Directions, grids and quadrature that the tests share.

use core::f64::consts::PI;
use hairis::random;
use hairis_conformance::published::quadrature::{self, POINTS};
use hairis_conformance::{cases, statistics};
use hairis_reference::Reference;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

pub(crate) const DEG: f64 = PI / 180.0;

/// Points and weights on `[lo, hi]`: panels that end at the `kinks`, and at each (peak, width) and 1, 2, 4 ... widths from it.
pub(crate) fn rule(lo: f64, hi: f64, peaks: &[(f64, f64)], kinks: &[f64]) -> Vec<(f64, f64)> {
    let kinks = kinks.iter().map(|kink| (*kink, f64::INFINITY));
    let bells: Vec<_> = peaks.iter().copied().chain(kinks).collect();
    quadrature::rule(&quadrature::panels(lo, hi, &bells))
}

/// The integral by a rule.
pub(crate) fn sum(rule: &[(f64, f64)], f: impl Fn(f64) -> f64) -> f64 {
    rule.iter().map(|&(x, w)| w * f(x)).sum()
}

/// A unit vector; `theta` and `phi` in radians.
pub(crate) fn direction(theta: f64, phi: f64) -> [f64; 3] {
    [
        theta.sin(),
        theta.cos() * phi.cos(),
        theta.cos() * phi.sin(),
    ]
}

/// `count` points of a three-dimensional low-discrepancy sequence (Roberts' R3).
pub(crate) fn points(count: u32) -> impl Iterator<Item = [f64; 3]> {
    let steps = [
        0.819_172_513_396_164_5,
        0.671_043_606_703_789_3,
        0.549_700_477_901_97,
    ];
    (1..=count).map(move |n| steps.map(|step: f64| (0.5 + f64::from(n) * step).fract()))
}

/// The largest of what was found; NaN counts as infinite.
#[derive(Default)]
pub(crate) struct LargestError(pub(crate) f64);

impl LargestError {
    pub(crate) fn see(&mut self, found: f64) {
        self.0 = if found.is_nan() {
            f64::INFINITY
        } else {
            self.0.max(found.abs())
        };
    }

    /// Checks the bound, and prints what was found.
    pub(crate) fn assert_below(self, bound: f64, name: &str) {
        println!("{name}: {:.3e}, bound {bound:.1e}", self.0);
        assert!(
            self.0 <= bound,
            "{name}: {:.3e} is above {bound:.1e}",
            self.0
        );
    }
}

/// Midpoints of `side^2` cells of a square.
pub(crate) fn cells(side: u32) -> impl Iterator<Item = [f64; 2]> {
    let middle = move |n: u32| (f64::from(n) + 0.5) / f64::from(side);
    (0..side).flat_map(move |i| (0..side).map(move |j| [middle(i), middle(j)]))
}

/// Uniform numbers at the ends of their range.
pub(crate) fn corners() -> impl Iterator<Item = [f32; 3]> {
    let ends = [0.0, 0.5, 1.0 - 0.5 * f32::EPSILON];
    ends.into_iter()
        .flat_map(move |a| ends.into_iter().flat_map(move |b| ends.map(|c| [a, b, c])))
}

/// Upper end of each panel of a rule, and its points and weights.
fn by_panel(rule: &[(f64, f64)]) -> impl Iterator<Item = (f64, &[(f64, f64)])> {
    rule.chunks(POINTS).map(|panel| {
        let width: f64 = panel.iter().map(|point| point.1).sum();
        (0.5 * (panel[0].0 + panel[POINTS - 1].0 + width), panel)
    })
}

/// The largest difference of the cdf of points `drawn`, each with a weight, and the integral of `density`, at the ends of panels.
pub(crate) fn cdf_gap(
    mut drawn: Vec<(f64, f64)>,
    rule: &[(f64, f64)],
    density: impl Fn(f64) -> f64,
) -> f64 {
    drawn.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = drawn.iter().map(|point| point.1).sum();
    let (mut reached, mut integral, mut worst) = (0.0, 0.0, 0.0_f64);
    let mut points = drawn.into_iter().peekable();
    for (end, panel) in by_panel(rule) {
        integral += sum(panel, &density);
        while let Some((_, weight)) = points.next_if(|point| point.0 <= end) {
            reached += weight / total;
        }
        worst = worst.max((reached - integral).abs());
    }
    worst
}

/// Probability that random samples of a fibre differ from its density as much as they do: chi-square over cells of
/// `theta_i` (panels of `rule`, joined to at least 4 degrees) and of the azimuth (15 degrees), cells under 5 pooled.
pub(crate) fn chi_square(
    fiber: &impl Reference<f64>,
    rule: &[(f64, f64)],
    phi_peaks: &[(f64, f64)],
) -> f64 {
    const SECTORS: usize = 24;
    let count = cases(200_000);
    let sector = 2.0 * PI / SECTORS as f64;
    let mut ends: Vec<f64> = Vec::new();
    let mut expected: Vec<f64> = Vec::new();
    let sectors: Vec<_> = (0..SECTORS)
        .map(|n| n as f64 * sector - PI)
        .map(|lo| self::rule(lo, lo + sector, phi_peaks, &[]))
        .collect();
    let mut start = f64::NEG_INFINITY;
    for (end, panel) in by_panel(rule) {
        if end - start > 4.0 * DEG {
            start = end;
            ends.push(end);
            expected.extend([0.0; SECTORS]);
        } else if let Some(last) = ends.last_mut() {
            *last = end;
        }
        let row = expected.len() - SECTORS;
        for (cell, phi) in expected[row..].iter_mut().zip(&sectors) {
            let mass = sum(panel, |t| {
                t.cos() * sum(phi, |phi| fiber.pdf(direction(t, phi)))
            });
            *cell += mass * count as f64;
        }
    }
    let mut observed = vec![0; expected.len()];
    let mut rng = ChaCha8Rng::seed_from_u64(0x5eed);
    for _ in 0..count {
        let drawn = fiber.sample(random::xi(&mut rng).map(f64::from));
        if drawn.lobe.is_none() {
            continue;
        }
        let [u, v, w] = drawn.wi;
        let theta = u.atan2(v.hypot(w));
        let row = ends.partition_point(|end| *end < theta).min(ends.len() - 1);
        let azimuth = w.atan2(v) + PI;
        let column = (1..SECTORS)
            .filter(|n| *n as f64 * sector <= azimuth)
            .count();
        observed[row * SECTORS + column] += 1;
    }
    statistics::chi_square(&observed, &expected, 5.0).p_value
}
