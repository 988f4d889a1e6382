//! Search for the largest value of a function over a cube, without derivatives.
//!
//! Errors of arithmetic are a smooth slope under noise of the size of a rounding. Steps therefore have any size from a quarter of the cube down to a
//! rounding, in a few coordinates at a time.

use core::time::Duration;
use hairis_conformance::published::support::{Draws, narrow};
use std::time::Instant;

/// Number of random points from which a round chooses where it starts.
const POOL: usize = 256;
/// Number of starts of a round, of which half are given up at a time.
const STARTS: usize = 8;
/// Number of steps of each start before the first are given up; twice as many before the next.
const STEPS: usize = 64;
/// Number of steps in a row without a gain after which the last climber is done.
const PATIENCE: usize = 400;
/// Smallest step, as a power of two.
const FINEST: f64 = -24.0;

/// Largest values that random points and climbing found, and the point of the larger.
#[derive(Clone, Debug, Default)]
pub(crate) struct Found {
    /// Largest value at random points, in the first half of the time.
    pub(crate) sampled: f64,
    /// Largest value of all.
    pub(crate) searched: f64,
    pub(crate) at: Vec<f32>,
    pub(crate) evaluations: u64,
}

/// Length of a search.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Budget {
    Time(Duration),
    Evaluations(u64),
}

/// Search under way.
struct Search<F> {
    function: F,
    dimension: usize,
    draws: Draws,
    begin: Instant,
    budget: Budget,
    found: Found,
}

/// Point with its value.
#[derive(Clone)]
struct Climber {
    at: Vec<f32>,
    value: f64,
}

/// Searches for the largest value of a function of so many numbers in `[0, 1]`, for so long: half of it at random points, half uphill from
/// the best of them and from `start`, if there is one, and then from the best of others. A NaN counts as the largest value of all.
pub(crate) fn climb(
    dimension: usize,
    function: impl FnMut(&[f32]) -> f64,
    start: Option<&[f32]>,
    draws: Draws,
    budget: Budget,
) -> Found {
    let mut search = Search {
        function,
        dimension,
        draws,
        begin: Instant::now(),
        budget,
        found: Found::default(),
    };
    let mut best = Vec::new();
    while !search.has_used(0.5) {
        search.pool(&mut best);
    }
    search.found.sampled = search.found.searched;
    if let Some(start) = start {
        let (at, value) = (start.to_vec(), search.value(start));
        best.insert(0, Climber { at, value });
    }
    while !search.is_over() {
        search.round(core::mem::take(&mut best));
        search.pool(&mut best);
    }
    search.found
}

impl<F: FnMut(&[f32]) -> f64> Search<F> {
    /// Returns true if this share of the budget is used.
    fn has_used(&self, share: f64) -> bool {
        match self.budget {
            Budget::Time(time) => self.begin.elapsed() >= time.mul_f64(share),
            Budget::Evaluations(count) => self.found.evaluations as f64 >= share * count as f64,
        }
    }

    fn is_over(&self) -> bool {
        self.has_used(1.0)
    }

    fn value(&mut self, at: &[f32]) -> f64 {
        let value = (self.function)(at);
        let value = if value.is_nan() { f64::INFINITY } else { value };
        self.found.evaluations += 1;
        if value > self.found.searched {
            self.found.searched = value;
            self.found.at = at.to_vec();
        }
        value
    }

    /// Adds random points to `best`, which keeps the largest of them.
    fn pool(&mut self, best: &mut Vec<Climber>) {
        for _ in 0..POOL {
            if self.is_over() {
                break;
            }
            let at: Vec<f32> = (0..self.dimension).map(|_| self.draws.xi()).collect();
            let value = self.value(&at);
            best.push(Climber { at, value });
        }
        best.sort_by(|a, b| b.value.total_cmp(&a.value));
        best.truncate(STARTS);
    }

    fn round(&mut self, mut climbers: Vec<Climber>) {
        let mut steps = STEPS;
        while climbers.len() > 1 {
            for climber in &mut climbers {
                for _ in 0..steps {
                    self.step(climber);
                }
            }
            climbers.sort_by(|a, b| b.value.total_cmp(&a.value));
            climbers.truncate(climbers.len() / 2);
            steps *= 2;
        }
        let Some(last) = climbers.first_mut() else {
            return;
        };
        let mut idle = 0;
        while idle < PATIENCE && !self.is_over() {
            idle = if self.step(last) { 0 } else { idle + 1 };
        }
    }

    /// Takes a random step if it does not lead down, and returns true if it leads up.
    fn step(&mut self, from: &mut Climber) -> bool {
        if self.is_over() {
            return false;
        }
        let mut at = from.at.clone();
        let must = self.draws.below(self.dimension);
        let size = self.draws.between(FINEST, -1.0).exp2();
        for (i, x) in at.iter_mut().enumerate() {
            if i == must || self.draws.below(self.dimension) == 0 {
                let by = size * self.draws.between(-1.0, 1.0);
                // Ends of ranges are where many errors are largest.
                *x = narrow(f64::from(*x) + by).clamp(0.0, 1.0);
            }
        }
        let value = self.value(&at);
        let is_up = value > from.value;
        if value >= from.value {
            *from = Climber { at, value };
        }
        is_up
    }
}

/// A ridge that few random points come near, with a peak at its end, and noise in the last bits.
#[test]
fn a_peak_is_found_that_random_points_miss() {
    let height = |x: &[f32]| {
        let x: Vec<f64> = x.iter().map(|x| f64::from(*x)).collect();
        let across: f64 = x[1..].iter().map(|y| (y - x[0] * x[0]).powi(2)).sum();
        let noise = 1e-6 * (1e9 * x[0]).sin();
        x[0] / (1.0 + 1e3 * across) + noise
    };
    let found = climb(8, height, None, Draws(1), Budget::Evaluations(2_000_000));
    assert!(
        found.sampled < 0.5 && found.searched > 0.5,
        "sampled {}, searched {}",
        found.sampled,
        found.searched
    );
    assert_eq!(height(&found.at), found.searched, "the point has the value");
}
