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
