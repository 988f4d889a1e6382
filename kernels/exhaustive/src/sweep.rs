//! A sweep over the floats of a domain, on all cores: the largest errors and where they are, bits that differ between levels that must
//! have the same, and exceptions.

use crate::functions::Function;
use core::ops::AddAssign;
use core::sync::atomic::{AtomicU64, Ordering};
use hairis::simd::{Level, control, set_control};
use std::thread;

/// Number of arguments at a time, which stay in the first two levels of cache.
const CHUNK: usize = 4096;
/// Flags of invalid operations, divisions by zero and overflows.
const FLAGS: u32 = 1 | 4 | 8;

/// Arguments of a sweep: every `stride`-th float of the domain from its place `offset` on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    pub(crate) stride: u64,
    pub(crate) offset: u64,
}

/// Largest error of a result, and the argument that has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Worst {
    pub(crate) error: f64,
    pub(crate) at: f32,
}

impl Worst {
    #[inline]
    fn see(&mut self, error: f64, at: f32) {
        let error = if error.is_nan() { f64::INFINITY } else { error };
        if error > self.error {
            *self = Self { error, at };
        }
    }
}

/// Findings of a sweep, by arithmetic: one lane, then the levels that fuse. Without such a level the second are those of one lane.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Found {
    pub(crate) arguments: u64,
    /// By arithmetic and result.
    pub(crate) worst: [[Worst; 2]; 2],
    /// Number of results of other levels that differ in a bit from those of their arithmetic.
    pub(crate) differing: u64,
    /// Flags of the exceptions that were raised, by arithmetic.
    pub(crate) flags: [u32; 2],
}

impl AddAssign for Found {
    fn add_assign(&mut self, other: Self) {
        self.arguments += other.arguments;
        self.differing += other.differing;
        for (arithmetic, worst) in other.worst.iter().enumerate() {
            self.flags[arithmetic] |= other.flags[arithmetic];
            for (result, worst) in worst.iter().enumerate() {
                self.worst[arithmetic][result].see(worst.error, worst.at);
            }
        }
    }
}

/// Place of a float among all floats, in their order; both zeros have the place 0.
fn place(x: f32) -> i64 {
    let magnitude = i64::from(x.to_bits() & !(1 << 31));
    if x.is_sign_negative() {
        -magnitude
    } else {
        magnitude
    }
}

fn at_place(place: i64) -> f32 {
    let magnitude = u32::try_from(place.unsigned_abs()).expect("the place of a float");
    f32::from_bits(magnitude | u32::from(place < 0) << 31)
}

/// Results of every argument of a chunk on one kind of lanes.
type Results = [Box<[f32]>; 2];

/// Sweeps over the domain of a function.
pub(crate) fn sweep<F: Function>(choice: Choice) -> Found {
    let [first, last] = F::DOMAIN.map(place);
    let floats = last.abs_diff(first) + 1;
    let count = floats.saturating_sub(choice.offset).div_ceil(choice.stride);
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
            found += chunk.run(len, |i| {
                let step = choice.offset + (from + i as u64) * choice.stride;
                at_place(first.wrapping_add_unsigned(step))
            });
        }
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let mut all = Found::default();
        for worker in workers {
            all += worker.join().expect("a worker does not panic");
        }
        all
    })
}

struct Chunk<F> {
    function: F,
    levels: Vec<Level>,
    numbers: Box<[f32]>,
    arguments: [Box<[f32]>; 3],
    one: Results,
    levels_results: Vec<Results>,
}

impl<F: Function> Chunk<F> {
    fn new() -> Self {
        let column = || vec![0.0; CHUNK].into_boxed_slice();
        let levels: Vec<Level> = Level::available().collect();
        Self {
            function: F::default(),
            numbers: column(),
            arguments: [column(), column(), column()],
            one: [column(), column()],
            levels_results: levels.iter().map(|_| [column(), column()]).collect(),
            levels,
        }
    }

    fn run(&mut self, len: usize, number: impl Fn(usize) -> f32) -> Found {
        for i in 0..len {
            self.numbers[i] = number(i);
            for (column, x) in self.arguments.iter_mut().zip(F::arguments(self.numbers[i])) {
                column[i] = x;
            }
        }
        let mut found = Found {
            arguments: len as u64,
            ..Found::default()
        };
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
        found.flags[0] = control() & FLAGS;
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
                    [0, 1].map(|result| F::UNIT.error(self.numbers[i], got[result], want[result]))
                });
                for (worst, error) in found.worst[arithmetic].iter_mut().zip(errors) {
                    worst.see(error, self.numbers[i]);
                }
            }
        }
        found
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

    impl Row<3, 2> for Planted {
        fn row<L: Lanes>(self, arguments: [L; 3]) -> [L; 2] {
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
        fn arguments(x: f32) -> [f32; 3] {
            Sqrt::arguments(x)
        }
        fn exact(arguments: [f64; 3]) -> [f64; 2] {
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
            assert_eq!(worst.at.to_bits(), AT.to_bits());
        }
        assert_eq!(found.differing, 0);
        assert_eq!(found.arguments, place(2.72).abs_diff(place(2.71)) + 1);
    }

    #[test]
    fn places_are_in_the_order_of_floats() {
        for x in [
            -f32::MAX,
            -1.0,
            -f32::from_bits(1),
            0.0,
            1e-40,
            1.0,
            f32::MAX,
        ] {
            assert_eq!(at_place(place(x)).to_bits(), x.to_bits());
            assert_eq!(place(x.next_up()), place(x) + 1);
        }
    }
}
