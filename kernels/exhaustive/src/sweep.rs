//! A sweep over the floats of a domain, on all cores: the largest errors and where they are, bits that differ between levels that must
//! have the same, and exceptions. Functions of several numbers have a climb after it, from the worst thousand.

use crate::floats::{at_place, place};
use crate::functions::Function;
use core::ops::AddAssign;
use core::sync::atomic::{AtomicU64, Ordering};
use hairis::simd::{Level, control, set_control};
use std::thread;

/// Number of arguments at a time, which stay in the first two levels of cache.
const CHUNK: usize = 4096;
/// Flags of invalid operations, divisions by zero and overflows.
const FLAGS: u32 = 1 | 4 | 8;

/// Number of steps from which a climb starts, by arithmetic and result.
const STARTS: usize = 1000;
/// Largest number of rounds of a climb.
const ROUNDS: usize = 100;

/// Arguments of a sweep: every `stride`-th step from the `offset`th on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    pub(crate) stride: u64,
    pub(crate) offset: u64,
}

/// Largest error of a result, and the numbers that have it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Worst {
    pub(crate) error: f64,
    pub(crate) at: [f32; 4],
}

impl Worst {
    #[inline]
    fn see(&mut self, other: Self) {
        if other.error > self.error {
            *self = other;
        }
    }
}

/// Worst steps, the worst first after [`sort`](Self::sort).
#[derive(Clone, Debug, Default)]
struct Starts {
    all: Vec<Worst>,
    /// Error of the last of them, if they are many.
    least: f64,
}

impl Starts {
    #[inline]
    fn see(&mut self, worst: Worst) {
        if worst.error > self.least {
            self.all.push(worst);
            if self.all.len() >= 4 * STARTS {
                self.sort();
            }
        }
    }

    fn sort(&mut self) {
        self.all.sort_by(|a, b| b.error.total_cmp(&a.error));
        self.all.truncate(STARTS);
        if let (STARTS, Some(last)) = (self.all.len(), self.all.last()) {
            self.least = last.error;
        }
    }
}

/// Findings of a sweep, by arithmetic: one lane, then the levels that fuse. Without such a level the second are those of one lane.
#[derive(Clone, Debug, Default)]
pub(crate) struct Found {
    pub(crate) arguments: u64,
    /// By arithmetic and result.
    pub(crate) worst: [[Worst; 2]; 2],
    /// Number of results of other levels that differ in a bit from those of their arithmetic.
    pub(crate) differing: u64,
    /// Flags of the exceptions that were raised, by arithmetic.
    pub(crate) flags: [u32; 2],
    starts: [[Starts; 2]; 2],
}

impl AddAssign for Found {
    fn add_assign(&mut self, other: Self) {
        self.arguments += other.arguments;
        self.differing += other.differing;
        for (arithmetic, worst) in other.worst.iter().enumerate() {
            self.flags[arithmetic] |= other.flags[arithmetic];
            for (result, worst) in worst.iter().enumerate() {
                self.worst[arithmetic][result].see(*worst);
                let starts = &other.starts[arithmetic][result];
                let mine = &mut self.starts[arithmetic][result];
                starts.all.iter().for_each(|start| mine.see(*start));
            }
        }
    }
}

/// Results of every argument of a chunk on one kind of lanes.
type Results = [Box<[f32]>; 2];

/// Sweeps over the steps of a function. A sweep over all steps of a function of several numbers ends with a climb.
pub(crate) fn sweep<F: Function>(choice: Choice) -> Found {
    let count = F::steps()
        .saturating_sub(choice.offset)
        .div_ceil(choice.stride);
    let next = AtomicU64::new(0);
    let work = || {
        let mut chunk = Chunk::<F>::new();
        let mut found = Found::default();
        loop {
            let from = next.fetch_add(CHUNK as u64, Ordering::Relaxed);
            if from >= count {
                return found;
            }
            let len = usize::try_from((count - from).min(CHUNK as u64)).expect("a chunk");
            chunk.run(len, &mut found, |i| {
                F::numbers(choice.offset + (from + i as u64) * choice.stride)
            });
        }
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let mut all = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let mut all = Found::default();
        for worker in workers {
            all += worker.join().expect("a worker does not panic");
        }
        all
    });
    if F::NUMBERS > 1 && choice.stride == 1 {
        climb::<F>(&mut all);
    }
    all
}

/// Moves each of the worst steps to the worst of its neighbours, which have one number up to 2^10 places higher or lower, as long as
/// a neighbour is worse.
fn climb<F: Function>(all: &mut Found) {
    let mut chunk = Chunk::<F>::new();
    for (arithmetic, result) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let mut starts = core::mem::take(&mut all.starts[arithmetic][result]);
        starts.sort();
        for mut start in starts.all {
            for _ in 0..ROUNDS {
                let near = neighbours::<F>(start.at);
                let mut found = Found::default();
                chunk.run(near.len(), &mut found, |i| near[i]);
                let best = found.worst[arithmetic][result];
                // Neighbours of neighbours are no starts.
                found.starts = Default::default();
                *all += found;
                if best.error <= start.error {
                    break;
                }
                start = best;
            }
        }
    }
}

fn neighbours<F: Function>(at: [f32; 4]) -> Vec<[f32; 4]> {
    let mut near = Vec::new();
    for number in 0..F::NUMBERS {
        for by in (0..=10).flat_map(|power| [1 << power, -(1 << power)]) {
            let mut other = at;
            let place = place(at[number]) + by;
            if place.unsigned_abs() < u64::from(f32::INFINITY.to_bits()) {
                other[number] = at_place(place);
                near.push(other);
            }
        }
    }
    near.retain(|numbers| F::holds(*numbers));
    near
}

struct Chunk<F> {
    function: F,
    levels: Vec<Level>,
    numbers: Box<[[f32; 4]]>,
    arguments: [Box<[f32]>; 4],
    one: Results,
    levels_results: Vec<Results>,
}

impl<F: Function> Chunk<F> {
    fn new() -> Self {
        let column = || vec![0.0; CHUNK].into_boxed_slice();
        let levels: Vec<Level> = Level::available().collect();
        Self {
            function: F::default(),
            numbers: vec![[0.0; 4]; CHUNK].into_boxed_slice(),
            arguments: [column(), column(), column(), column()],
            one: [column(), column()],
            levels_results: levels.iter().map(|_| [column(), column()]).collect(),
            levels,
        }
    }

    /// Adds what is found at these numbers.
    fn run(&mut self, len: usize, found: &mut Found, numbers: impl Fn(usize) -> [f32; 4]) {
        for i in 0..len {
            self.numbers[i] = numbers(i);
            for (column, x) in self.arguments.iter_mut().zip(F::arguments(self.numbers[i])) {
                column[i] = x;
            }
        }
        found.arguments += len as u64;
        let before = control();
        set_control(before & !0x3f);
        for i in 0..len {
            let results = self
                .function
                .row::<f32>(self.arguments.each_ref().map(|column| column[i]));
            for (column, x) in self.one.iter_mut().zip(results) {
                column[i] = x;
            }
        }
        found.flags[0] |= control() & FLAGS;
        for (level, results) in self.levels.iter().zip(&mut self.levels_results) {
            set_control(before & !0x3f);
            let inputs = self.arguments.each_ref().map(|column| &column[..len]);
            level.run_rows(
                self.function,
                inputs,
                &mut results.each_mut().map(|column| &mut column[..len]),
            );
            found.flags[usize::from(level.fuses())] |= control() & FLAGS;
        }
        set_control(before);

        let fused = self.levels.iter().position(|level| level.fuses());
        for (level, results) in self.levels.iter().zip(&self.levels_results) {
            let same = if level.fuses() {
                &self.levels_results[fused.expect("this level fuses")]
            } else {
                &self.one
            };
            for (a, b) in results.iter().zip(same) {
                let differ = a[..len].iter().zip(&b[..len]);
                found.differing +=
                    differ.filter(|(a, b)| a.to_bits() != b.to_bits()).count() as u64;
            }
        }
        let fused = fused.map_or(&self.one, |level| &self.levels_results[level]);
        for i in 0..len {
            let arguments = self.arguments.each_ref().map(|column| f64::from(column[i]));
            let want = F::exact(arguments);
            for (arithmetic, results) in [&self.one, fused].into_iter().enumerate() {
                let got = results.each_ref().map(|column| column[i]);
                let errors = F::errors(arguments, got).unwrap_or_else(|| {
                    [0, 1]
                        .map(|result| F::UNIT.error(self.numbers[i][0], got[result], want[result]))
                });
                for (result, error) in errors.into_iter().enumerate() {
                    let error = if error.is_nan() { f64::INFINITY } else { error };
                    let worst = Worst {
                        error,
                        at: self.numbers[i],
                    };
                    found.worst[arithmetic][result].see(worst);
                    if F::NUMBERS > 1 {
                        found.starts[arithmetic][result].see(worst);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::functions::{Sqrt, Unit};
    use hairis::simd::{Lanes, Row};

    /// The square root, one unit in the last place too large at one argument.
    #[derive(Clone, Copy, Default)]
    struct Planted;
    const AT: f32 = 2.718_281_7;

    impl Row<4, 2> for Planted {
        fn row<L: Lanes>(self, arguments: [L; 4]) -> [L; 2] {
            let [root, rest] = Sqrt.row(arguments);
            let [below, above] = [AT.next_down(), AT.next_up()].map(L::splat);
            let here = L::and(below.lt(arguments[0]), arguments[0].lt(above));
            [L::select(here, root + root * f32::EPSILON, root), rest]
        }
    }

    impl Function for Planted {
        const NAME: &'static str = "planted";
        const RESULTS: &'static [&'static str] = Sqrt::RESULTS;
        const UNIT: Unit = Sqrt::UNIT;
        const DOMAIN: [f32; 2] = [2.71, 2.72];
        fn arguments(numbers: [f32; 4]) -> [f32; 4] {
            Sqrt::arguments(numbers)
        }
        fn exact(arguments: [f64; 4]) -> [f64; 2] {
            Sqrt::exact(arguments)
        }
    }

    #[test]
    fn one_unit_at_one_argument_is_found() {
        let found = sweep::<Planted>(Choice {
            stride: 1,
            offset: 0,
        });
        for [worst, _] in found.worst {
            assert!(worst.error > 0.5, "{}", worst.error);
            assert_eq!(worst.at[0].to_bits(), AT.to_bits());
        }
        assert_eq!(found.differing, 0);
        assert_eq!(found.arguments, place(2.72).abs_diff(place(2.71)) + 1);
    }

    /// A quotient whose error grows towards one pair of numbers, of which the sweep has no neighbour.
    #[derive(Clone, Copy, Default)]
    struct Peak;
    const TOP: [f32; 2] = [1.234_567_9, -1.765_432_1];

    impl Row<4, 2> for Peak {
        fn row<L: Lanes>(self, [x, y, ..]: [L; 4]) -> [L; 2] {
            let off = (x - TOP[0]).abs() + (y - TOP[1]).abs();
            let height = L::splat(0.0).max(L::splat(1.0) - off);
            [height * 0.5 + 1.0, x]
        }
    }

    impl Function for Peak {
        const NAME: &'static str = "peak";
        const RESULTS: &'static [&'static str] = &["height"];
        const UNIT: Unit = Unit::One;
        const DOMAIN: [f32; 2] = [-2.0, 2.0];
        const NUMBERS: usize = 2;
        fn steps() -> u64 {
            16
        }
        fn numbers(step: u64) -> [f32; 4] {
            let x = TOP[0] + 1e-5 * step as f32;
            [x, TOP[1] - 1e-4, 0.0, 0.0]
        }
        fn arguments(numbers: [f32; 4]) -> [f32; 4] {
            numbers
        }
        fn exact(_arguments: [f64; 4]) -> [f64; 2] {
            [1.0, 0.0]
        }
        fn errors(_arguments: [f64; 4], [height, _]: [f32; 2]) -> Option<[f64; 2]> {
            Some([f64::from(height) - 1.0, 0.0])
        }
    }

    #[test]
    fn a_climb_reaches_the_top() {
        let found = sweep::<Peak>(Choice {
            stride: 1,
            offset: 0,
        });
        for [worst, _] in found.worst {
            // The height has a step of 1.2e-7, and a slope of 0.5.
            for (at, top) in worst.at.into_iter().zip(TOP) {
                assert!((at - top).abs() < 1e-6, "{worst:?}");
            }
            assert!((worst.error - 0.5).abs() < 3e-7, "{worst:?}");
        }
        let swept = sweep::<Peak>(Choice {
            stride: 2,
            offset: 0,
        });
        assert!(swept.worst[0][0].error < 0.5 - 4e-5, "without a climb");
    }
}
