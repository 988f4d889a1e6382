//! Tests of goodness of fit: chi-square with pooling, and Kolmogorov-Smirnov.

use statrs::function::gamma::gamma_ur;

/// Returns the probability of a chi-square value of at least `x` with `freedom` degrees.
pub(crate) fn chi_square_tail(x: f64, freedom: usize) -> f64 {
    // The incomplete gamma function is not defined at 0, where every statistic is as large.
    if x == 0.0 {
        1.0
    } else {
        gamma_ur(0.5 * freedom as f64, 0.5 * x)
    }
}

/// Edges between cells of an angle. They find the cell of a direction without the arc tangent, which takes longer than drawing a sample.
#[derive(Clone, Debug)]
pub struct AngleEdges(Vec<f64>);

impl AngleEdges {
    /// Makes edges from their angles.
    ///
    /// - Units: radians.
    /// - Domain: ascending, from -pi to pi.
    #[must_use]
    pub fn new(angles: &[f64]) -> Self {
        Self(
            angles
                .iter()
                .map(|x| angle_order(x.sin_cos().into()))
                .collect(),
        )
    }

    /// Returns the number of edges at or below the angle of a sine and a cosine, both times one length; 0 if both are 0.
    #[must_use]
    pub fn below(&self, sides: [f64; 2]) -> usize {
        let order = angle_order(sides);
        self.0.partition_point(|edge| *edge <= order)
    }
}

/// Returns a number that ascends with the angle of a sine and a cosine, both times one length: from -2 at -pi to 2 at pi.
#[inline]
fn angle_order([sin, cos]: [f64; 2]) -> f64 {
    let quarter = sin / (sin.abs() + cos.abs());
    if cos >= 0.0 {
        quarter
    } else {
        2.0_f64.copysign(sin) - quarter
    }
}

/// Outcome of a chi-square test of counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquare {
    /// Pearson's statistic after pooling.
    pub statistic: f64,
    /// Degrees of freedom: cells after pooling, less one.
    pub degrees_of_freedom: usize,
    /// Probability of a statistic at least this large if the density is right.
    pub p_value: f64,
    /// Number of cells with an expected count below the limit, which were pooled.
    pub pooled: usize,
}

/// Computes Pearson's chi-square test of counts against expected counts.
///
/// Cells expected to hold fewer than `min_expected` samples (5 by custom) are pooled, smallest first, until each pool holds that many. A
/// remainder joins the last pool. A sample in a cell that expects none is a failure outright, with the p-value 0.
///
/// One degree of freedom is taken for the total, so `expected` must sum to the number of samples. Give discarded samples a cell of their
/// own. A density whose mass is not 1 shows in that sum: assert the sum beside this test, which alone would miss a uniform scale.
///
/// - Units: counts.
/// - Shape: `observed` and `expected` of one length.
/// - Domain: p-value NaN when the lengths differ, an expected count is negative or not finite, or fewer than two cells are left.
#[must_use]
pub fn chi_square(observed: &[u64], expected: &[f64], min_expected: f64) -> ChiSquare {
    let mut result = ChiSquare {
        statistic: f64::NAN,
        degrees_of_freedom: 0,
        p_value: f64::NAN,
        pooled: 0,
    };
    if observed.len() != expected.len() || expected.iter().any(|e| !(e.is_finite() && *e >= 0.0)) {
        return result;
    }
    let mut order: Vec<usize> = (0..expected.len()).collect();
    order.sort_by(|&a, &b| expected[a].total_cmp(&expected[b]).then(a.cmp(&b)));
    let mut cells: Vec<(f64, f64)> = Vec::new();
    let (mut pool_observed, mut pool_expected) = (0.0, 0.0);
    for &i in &order {
        let (o, e) = (observed[i] as f64, expected[i]);
        if e == 0.0 {
            if o > 0.0 {
                result.statistic = f64::INFINITY;
                result.p_value = 0.0;
                return result;
            }
            continue;
        }
        if e >= min_expected {
            cells.push((o, e));
            continue;
        }
        result.pooled += 1;
        pool_observed += o;
        pool_expected += e;
        if pool_expected >= min_expected {
            cells.push((pool_observed, pool_expected));
            (pool_observed, pool_expected) = (0.0, 0.0);
        }
    }
    if pool_expected > 0.0 {
        // The order is ascending, so the remainder is small: it joins the smallest cell kept.
        match cells.iter_mut().min_by(|a, b| a.1.total_cmp(&b.1)) {
            Some(cell) => {
                cell.0 += pool_observed;
                cell.1 += pool_expected;
            }
            None => cells.push((pool_observed, pool_expected)),
        }
    }
    if cells.len() < 2 {
        return result;
    }
    result.statistic = cells.iter().map(|(o, e)| (o - e) * (o - e) / e).sum();
    result.degrees_of_freedom = cells.len() - 1;
    result.p_value = chi_square_tail(result.statistic, result.degrees_of_freedom);
    result
}

/// Returns the Kolmogorov-Smirnov distance between samples and a continuous distribution.
///
/// `D = max |F_n(x) - F(x)|`, taken on both sides of each step.
///
/// - Shape: `samples` is sorted in place.
/// - Domain: NaN without samples, or when `cdf` gives NaN for one.
#[must_use]
pub fn ks_statistic(samples: &mut [f64], cdf: impl Fn(f64) -> f64) -> f64 {
    if samples.is_empty() {
        return f64::NAN;
    }
    samples.sort_by(f64::total_cmp);
    let n = samples.len() as f64;
    let mut d = 0.0_f64;
    for (i, &x) in samples.iter().enumerate() {
        let f = cdf(x);
        if f.is_nan() {
            return f64::NAN;
        }
        d = d.max(f - i as f64 / n).max((i + 1) as f64 / n - f);
    }
    d
}

/// Returns the probability of a Kolmogorov-Smirnov distance of at least `d` from `n` samples of the right distribution.
///
/// Kolmogorov's limit law with Stephens' small-sample correction `(sqrt(n) + 0.12 + 0.11/sqrt(n)) d`; good to about 1% of the p-value from n = 20 on.
///
/// - Domain: `d` in [0, 1]; NaN gives NaN.
#[must_use]
pub fn ks_p_value(d: f64, n: usize) -> f64 {
    let root = (n as f64).sqrt();
    let t = (root + 0.12 + 0.11 / root) * d;
    if t.is_nan() {
        return f64::NAN;
    }
    if t < 0.2 {
        // The alternating series needs more and more terms here, where the result is 1 to twelve digits.
        return 1.0;
    }
    let mut sum = 0.0;
    let mut sign = 1.0;
    for k in 1..=100_u32 {
        let k = f64::from(k);
        let term = (-2.0 * k * k * t * t).exp();
        sum += sign * term;
        sign = -sign;
        if term < 1e-18 {
            break;
        }
    }
    (2.0 * sum).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probe::Draws;
    use core::f64::consts::{FRAC_PI_2, PI};
    use statrs::function::erf::erfc;

    #[test]
    fn chi_square_of_a_loaded_die() {
        let r = chi_square(&[22, 24, 38, 30, 46, 44], &[34.0; 6], 5.0);
        assert_eq!(r.degrees_of_freedom, 5);
        assert!((r.statistic - 520.0 / 34.0).abs() < 1e-12, "{r:?}");
        // Q(5/2, x/2) in closed form: erfc and two terms.
        let x: f64 = 520.0 / 34.0;
        let want =
            erfc((0.5 * x).sqrt()) + (2.0 * x / PI).sqrt() * (-x / 2.0).exp() * (1.0 + x / 3.0);
        assert!((r.p_value - want).abs() < 1e-13, "{} {want}", r.p_value);
    }

    #[test]
    fn pooling_keeps_totals_and_counts() {
        let r = chi_square(&[1, 2, 3, 40, 54], &[1.0, 2.0, 3.0, 40.0, 54.0], 5.0);
        assert_eq!(
            (r.pooled, r.degrees_of_freedom, r.statistic, r.p_value),
            (3, 2, 0.0, 1.0)
        );
        // 4.9 never reaches the limit alone and joins the cell of 40.
        let r = chi_square(&[5, 40, 55], &[4.9, 40.1, 55.0], 5.0);
        assert_eq!((r.pooled, r.degrees_of_freedom), (1, 1));
        assert!(r.statistic < 1e-25);
    }

    #[test]
    fn angles_are_in_order() {
        let all = (-1000..=1000).map(|k| f64::from(k) * PI / 1000.0);
        let order: Vec<f64> = all
            .map(|x| angle_order([3.0 * x.sin(), 3.0 * x.cos()]))
            .collect();
        assert!(order.is_sorted_by(|a, b| a < b), "{order:?}");
        assert_eq!(
            [[0.0, -1.0], [-0.0, -1.0]].map(angle_order),
            [2.0, -2.0],
            "the seam"
        );
        assert_eq!(
            [order[0], order[500], order[1000], order[1500], order[2000]].map(f64::round),
            [-2.0, -1.0, 0.0, 1.0, 2.0]
        );
    }

    #[test]
    fn edges_below_an_angle_are_counted() {
        // Even ones, some together, and many close to each other.
        let mut angles: Vec<f64> = (-3..=3).map(f64::from).collect();
        angles.extend([-PI, -FRAC_PI_2, -FRAC_PI_2, 0.0, PI]);
        angles.extend((0..50).map(|i| 0.5 + 1e-5 * f64::from(i)));
        angles.sort_by(f64::total_cmp);
        let edges = AngleEdges::new(&angles);
        let between = (0..4000).map(|i| -PI + f64::from(i) * PI / 2000.0);
        for angle in angles.iter().copied().chain(between) {
            let below = angles.iter().filter(|edge| **edge <= angle).count();
            let [sin, cos] = angle.sin_cos().into();
            assert_eq!(edges.below([sin, cos]), below, "{angle}");
        }
        assert_eq!(edges.below([0.0, 0.0]), 0);
        assert_eq!(AngleEdges::new(&[]).below([0.0, 1.0]), 0);
    }

    #[test]
    fn chi_square_edges() {
        assert_eq!(
            chi_square(&[1, 99, 100], &[0.0, 100.0, 100.0], 5.0).p_value,
            0.0
        );
        assert_eq!(
            chi_square(&[0, 100, 100], &[0.0, 100.0, 100.0], 5.0).p_value,
            1.0
        );
        assert!(chi_square(&[1], &[1.0, 2.0], 5.0).p_value.is_nan());
        assert!(chi_square(&[1, 2], &[f64::NAN, 2.0], 5.0).p_value.is_nan());
        assert!(chi_square(&[10], &[10.0], 5.0).p_value.is_nan());
        assert!(chi_square(&[1, 1], &[1.0, 1.0], 5.0).p_value.is_nan());
        assert!(chi_square(&[], &[], 5.0).p_value.is_nan());
    }

    #[test]
    fn p_values_of_a_right_density_are_uniform() {
        // 1000 tests of 20 cells, some pooled: the p-values themselves pass Kolmogorov-Smirnov at 1%.
        let weights: Vec<f64> = (1..=20).map(|i| f64::from(i * i)).collect();
        let total: f64 = weights.iter().sum();
        let n = 5_000.0;
        let expected: Vec<f64> = weights.iter().map(|w| n * w / total).collect();
        let mut p_values = Vec::new();
        let mut draws = Draws(17);
        for _ in 0..1_000 {
            let mut observed = [0_u64; 20];
            for _ in 0..5_000 {
                let mut u = draws.between(0.0, total);
                let mut cell = 0;
                while cell < 19 && u >= weights[cell] {
                    u -= weights[cell];
                    cell += 1;
                }
                observed[cell] += 1;
            }
            p_values.push(chi_square(&observed, &expected, 5.0).p_value);
        }
        let d = ks_statistic(&mut p_values, |p| p.clamp(0.0, 1.0));
        assert!(ks_p_value(d, 1_000) > 0.01, "distance {d}");
    }

    #[test]
    fn ks_distance_and_law() {
        let mut s = [0.1, 0.4, 0.7];
        assert!((ks_statistic(&mut s, |x| x) - 0.3).abs() < 1e-15);
        assert!(ks_statistic(&mut [], |x| x).is_nan());
        assert!(ks_statistic(&mut [f64::NAN], |x| x).is_nan());
        // Kolmogorov's law: 5% at 1.3581, 1% at 1.6276, 0.1% at 1.9495.
        for (t, p) in [(1.358_1, 0.05), (1.627_6, 0.01), (1.949_5, 0.001)] {
            let got = ks_p_value(t / 1e4, 100_000_000);
            assert!((got / p - 1.0).abs() < 1e-3, "t {t}: {got}");
        }
        assert_eq!(ks_p_value(0.0, 10), 1.0);
        assert!(ks_p_value(1.0, 100) < 1e-15);
    }

    #[test]
    fn tails_are_those_of_the_tables() {
        // Percentiles of the chi-square distribution, from tables of five decimals or closed forms.
        let two = |x: f64| (-0.5 * x).exp();
        for x in [0.1, 1.0, 5.0, 30.0] {
            assert!(
                (chi_square_tail(x, 2) / two(x) - 1.0).abs() < 1e-9,
                "two degrees at {x}"
            );
        }
        for (x, freedom, tail) in [
            (3.841_459, 1, 0.05),
            (18.307_04, 10, 0.05),
            (23.209_25, 10, 0.01),
            (149.449_25, 100, 0.001),
        ] {
            let got = chi_square_tail(x, freedom);
            assert!(
                (got / tail - 1.0).abs() < 1e-4,
                "{freedom} degrees at {x}: {got}, not {tail}"
            );
        }
    }
}
