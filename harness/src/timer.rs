//! Timer that runs contenders in turns, round by round, with order statistics over the rounds.

use hairis_benches::task::Pass;
use hairis_instruments::stats::{Estimate, percentile};
use std::time::Instant;

/// Spread of a time over the rounds, in ns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeSpread {
    /// First quartile, median and third quartile.
    pub quartiles: [f64; 3],
    /// Standard error of the median, as of a normal spread of the same quartiles.
    pub standard_error: f64,
}

impl TimeSpread {
    /// Returns the median with its standard error.
    #[must_use]
    pub const fn median(&self) -> Estimate {
        Estimate {
            value: self.quartiles[1],
            standard_error: self.standard_error,
        }
    }
}

/// Returns the contenders in the order of a round, which changes from round to round.
pub fn turns(count: usize, round: usize) -> impl Iterator<Item = usize> {
    (0..count).map(move |k| (k + round) % count)
}

/// Times contenders in turn, in an order that changes from round to round; `time` returns the ns of a contender's stretch.
pub fn in_turns<C>(
    contenders: &mut [C],
    rounds: usize,
    mut time: impl FnMut(&mut C) -> f64,
) -> Vec<TimeSpread> {
    let count = contenders.len();
    let mut ns = vec![Vec::with_capacity(rounds); count];
    for round in 0..rounds {
        for k in turns(count, round) {
            ns[k].push(time(&mut contenders[k]));
        }
    }
    let spread = |ns: &Vec<f64>| {
        let quartiles = quartiles(ns);
        TimeSpread {
            quartiles,
            standard_error: median_error(quartiles, rounds),
        }
    };
    ns.iter().map(spread).collect()
}

/// Returns the time of `passes` passes, in ns.
pub fn stretch(task: &mut dyn Pass, passes: u32) -> f64 {
    let start = Instant::now();
    for _ in 0..passes {
        task.pass();
    }
    start.elapsed().as_secs_f64() * 1e9
}

/// Returns first quartile, median and third quartile.
pub fn quartiles(samples: &[f64]) -> [f64; 3] {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    [0.25, 0.5, 0.75].map(|p| percentile(&sorted, p))
}

/// Returns the standard error of the median of `count` numbers with these quartiles. The spread is taken as normal: its deviation is
/// 1/1.349 of the quartiles' distance, and a median's error 1.2533 of a mean's.
#[must_use]
pub fn median_error(quartiles: [f64; 3], count: usize) -> f64 {
    1.2533 / 1.349 * (quartiles[2] - quartiles[0]) / (count as f64).sqrt()
}
