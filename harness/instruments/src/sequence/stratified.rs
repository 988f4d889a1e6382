//! Jittered stratification of the unit cube, with cells in shuffled order.

use super::{Independent, XiSource};

/// Returns the numbers of cells along each of `dims` axes, whose product is exactly `samples`. The cells are as near to cubes as the
/// divisors allow.
///
/// The prime factors are dealt out, largest first, each to the axis with the fewest cells. A prime number of samples yields strips.
///
/// - Shape: `dims` elements, descending; 1 for each axis if `samples` is 0.
#[must_use]
pub fn strata(samples: usize, dims: usize) -> Vec<usize> {
    let (mut counts, mut factors) = (vec![1; dims], Vec::new());
    let (mut rest, mut p) = (samples.max(1), 2);
    while rest > 1 {
        if rest.is_multiple_of(p) {
            factors.push(p);
            rest /= p;
        } else {
            p += 1;
        }
    }
    for &f in factors.iter().rev() {
        if let Some(least) = counts.iter_mut().min() {
            *least *= f;
        }
    }
    counts.sort_unstable_by(|a, b| b.cmp(a));
    counts
}

/// Source of jittered points, one in each cell of a grid, in random order. After the last cell a new randomisation begins.
///
/// Each pass over the grid is an independent randomisation, so the spread of the passes' means is the error. The order is shuffled so
/// that two sources side by side (light and scattering samples) do not pair their cells.
///
/// - Shape: as many coordinates per point as the grid has axes, or fewer.
///
/// # Examples
/// ```
/// use hairis_instruments::sequence::{Stratified, XiSource};
/// let mut source = Stratified::new(&[4, 4], 1, 0);
/// let left = (0..16).filter(|_| source.next_xi::<2>()[0] < 0.25).count();
/// assert_eq!(left, 4, "one column of four cells");
/// ```
#[derive(Clone, Debug)]
pub struct Stratified {
    counts: Vec<usize>,
    order: Vec<usize>,
    next: usize,
    rng: Independent,
}

impl Stratified {
    /// Makes a grid with `counts` cells along each axis, whose randomisations are drawn from `(seed, stream)`. A count of 0 is taken as
    /// 1.
    #[must_use]
    pub fn new(counts: &[usize], seed: u64, stream: u64) -> Self {
        let counts: Vec<usize> = counts.iter().map(|&c| c.max(1)).collect();
        let cells = counts.iter().product();
        Self {
            counts,
            order: (0..cells).collect(),
            next: cells,
            rng: Independent::new(seed, stream),
        }
    }

    /// Returns the number of cells, which is the number of points in one randomisation.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.order.len()
    }
}

impl XiSource for Stratified {
    fn next_point(&mut self, point: &mut [f64]) {
        assert!(
            point.len() <= self.counts.len(),
            "more coordinates than axes: {} of {:?}",
            point.len(),
            self.counts
        );
        if self.next >= self.order.len() {
            for i in (1..self.order.len()).rev() {
                let j = self.rng.next_below(i + 1);
                self.order.swap(i, j);
            }
            self.next = 0;
        }
        let mut cell = self.order[self.next];
        self.next += 1;
        for (x, &count) in point.iter_mut().zip(&self.counts) {
            let jitter = self.rng.next_f64();
            *x = (((cell % count) as f64 + jitter) / count as f64).min(1.0 - f64::EPSILON / 2.0);
            cell /= count;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairis_conformance::statistics::{ks_p_value, ks_statistic};

    #[test]
    fn strata_multiply_to_the_number_of_samples() {
        assert_eq!(strata(16, 2), [4, 4]);
        assert_eq!(strata(32, 2), [8, 4]);
        assert_eq!(strata(64, 3), [4, 4, 4]);
        assert_eq!(strata(17, 2), [17, 1]);
        assert_eq!(strata(0, 2), [1, 1]);
        for n in 1..200 {
            for dims in 1..4 {
                assert_eq!(
                    strata(n, dims).iter().product::<usize>(),
                    n,
                    "{n} in {dims}"
                );
            }
        }
    }

    #[test]
    fn each_cell_holds_one_point_of_each_pass() {
        let mut source = Stratified::new(&[4, 3, 2], 1, 2);
        let mut orders = Vec::new();
        for pass in 0..5 {
            let mut counts = [0; 24];
            let mut order = Vec::new();
            for _ in 0..24 {
                let [x, y, z] = source.next_xi::<3>();
                let cell = |x: f64, n: usize| {
                    (0..n)
                        .rev()
                        .find(|&i| x >= i as f64 / n as f64)
                        .unwrap_or(0)
                };
                let c = (cell(z, 2) * 3 + cell(y, 3)) * 4 + cell(x, 4);
                counts[c] += 1;
                order.push(c);
            }
            assert!(counts.iter().all(|&c| c == 1), "pass {pass}");
            orders.push(order);
        }
        assert_ne!(orders[0], orders[1], "each pass is shuffled anew");
    }

    #[test]
    fn the_first_point_is_uniform_over_randomisations() {
        let mut s: Vec<f64> = (0..20_000)
            .map(|stream| Stratified::new(&[4, 4], 6, stream).next_xi::<2>()[1])
            .collect();
        let d = ks_statistic(&mut s, |x| x);
        assert!(ks_p_value(d, s.len()) > 0.01, "distance {d}");
    }
}
