//! Order statistics of timing samples: timings have a long right tail, so the median and the quartiles describe them, not the mean.

use serde::Serialize;

/// Value below which a fraction `p` of `sorted` lies, by linear interpolation between order statistics.
///
/// `h = p (n - 1)`; type 7 of Hyndman and Fan 1996, the default of R and `NumPy`.
///
/// - Units: those of the samples; `p` in [0, 1], clamped.
/// - Shape: `sorted` ascending.
/// - Domain: NaN without samples.
#[must_use]
pub fn percentile(sorted: &[f64], p: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let h = p.clamp(0.0, 1.0) * last as f64;
    let lo = index(h.floor(), last);
    let hi = (lo + 1).min(last);
    let t = h - h.floor();
    // Equal neighbours must give themselves, also when they are infinite.
    if t == 0.0 || sorted[lo] == sorted[hi] { sorted[lo] } else { sorted[lo] + t * (sorted[hi] - sorted[lo]) }
}

/// A whole, non-negative number as an index no larger than `last`.
fn index(x: f64, last: usize) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "x is whole and clamped to 0..=last")]
    let i = x.clamp(0.0, last as f64) as usize;
    i.min(last)
}

/// Median and spread of a set of samples, in the unit of the samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Number of samples.
    pub count: usize,
    /// Smallest sample.
    pub min: f64,
    /// First quartile.
    pub q1: f64,
    /// Median.
    pub median: f64,
    /// Third quartile.
    pub q3: f64,
    /// Largest sample.
    pub max: f64,
    /// Median absolute deviation from the median, unscaled (times 1.4826 it estimates a normal deviation).
    pub mad: f64,
    /// Lower end of the 95% interval of the median.
    pub median_lo: f64,
    /// Upper end of the 95% interval of the median.
    pub median_hi: f64,
}

impl Spread {
    /// Spread of `samples`, in any order; `None` without samples or when one is NaN.
    ///
    /// The interval of the median is the distribution-free one: order statistics `n/2 -+ 0.98 sqrt(n)`, the ends of the set when it has fewer than six.
    #[must_use]
    pub fn of(samples: &[f64]) -> Option<Self> {
        if samples.is_empty() || samples.iter().any(|x| x.is_nan()) {
            return None;
        }
        let mut sorted = samples.to_vec();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len();
        let median = percentile(&sorted, 0.5);
        let mut deviations: Vec<f64> = sorted.iter().map(|x| (x - median).abs()).collect();
        deviations.sort_by(f64::total_cmp);
        let n = count as f64;
        let half_width = 0.5 * 1.959_963_984_540_054 * n.sqrt();
        let last = count - 1;
        Some(Self {
            count,
            min: sorted[0],
            q1: percentile(&sorted, 0.25),
            median,
            q3: percentile(&sorted, 0.75),
            max: sorted[last],
            mad: percentile(&deviations, 0.5),
            median_lo: sorted[index((0.5 * n - half_width).floor() - 1.0, last)],
            median_hi: sorted[index((0.5 * n + half_width).ceil(), last)],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sequence::Independent;

    #[test]
    fn percentiles_match_type_seven() {
        let s = [1.0, 2.0, 3.0, 4.0];
        for (p, want) in [(0.0, 1.0), (0.25, 1.75), (0.5, 2.5), (0.75, 3.25), (1.0, 4.0), (2.0, 4.0), (-1.0, 1.0)] {
            assert_eq!(percentile(&s, p), want, "p {p}");
        }
        assert!(percentile(&[], 0.5).is_nan());
        assert_eq!(percentile(&[7.0], 0.99), 7.0);
        assert_eq!(percentile(&[f64::INFINITY; 3], 0.3), f64::INFINITY);
    }

    #[test]
    fn spread_ignores_order_and_one_outlier() {
        let s = Spread::of(&[5.0, 1.0, 3.0, 2.0, 1_000.0, 4.0, 6.0]).expect("finite samples");
        assert_eq!((s.count, s.min, s.q1, s.median, s.q3, s.max, s.mad), (7, 1.0, 2.5, 4.0, 5.5, 1_000.0, 2.0));
        assert!(Spread::of(&[]).is_none() && Spread::of(&[1.0, f64::NAN]).is_none());
        let one = Spread::of(&[2.0]).expect("one sample");
        assert_eq!((one.median_lo, one.median, one.median_hi, one.mad), (2.0, 2.0, 2.0, 0.0));
    }

    #[test]
    fn median_interval_covers_the_median() {
        // 2000 runs of 101 skewed samples: coverage is at least 95% (discreteness only widens it), with a standard error of 0.5%.
        let truth = core::f64::consts::LN_2;
        let mut covered = 0;
        for run in 0..2_000 {
            let mut xi = Independent::new(5, run);
            let samples: Vec<f64> = (0..101).map(|_| -(1.0 - xi.next_f64()).ln()).collect();
            let s = Spread::of(&samples).expect("finite samples");
            covered += usize::from(s.median_lo <= truth && truth <= s.median_hi);
        }
        let rate = f64::from(u32::try_from(covered).expect("small")) / 2_000.0;
        assert!((0.93..0.99).contains(&rate), "coverage {rate}");
    }
}
