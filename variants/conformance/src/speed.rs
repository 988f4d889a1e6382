//! Property that eight lanes use their instruction sets, because every function over lanes is inlined.

use crate::erased::{ErasedBsdf, ErasedSubject, Which};
use crate::failure::{Failure, Outcome};
use crate::probe::{Direction, Draws, packet, triples};
use core::hint::black_box;
use hairis::simd::{Level, f32x8};
use std::time::Instant;

const NAME: &str = "every function over lanes is inlined";

/// Packets of a run, followed by the number of runs, of which the fastest counts.
const PACKETS: usize = 64;
const RUNS: usize = 25;

/// Largest time of a level, relative to portable lanes. Inlined, wider levels take at most 1.1 times as long if a test calls a small
/// model through trait objects. With a call in each operation they take 10 times as long.
const MOST: f64 = 5.0;

/// Names of the calls that are timed.
const CALLS: [&str; 2] = ["eval_pdf8", "sample8"];

/// Returns the shortest time that each call takes.
fn times(
    bsdf: &dyn ErasedBsdf,
    level: Level,
    wi: &[hairis::Vec3x8],
    xi: &[[f32x8; 3]],
) -> [f64; CALLS.len()] {
    let bsdf = bsdf.with_level(level);
    let mut least = [f64::INFINITY; CALLS.len()];
    for _ in 0..RUNS {
        let start = Instant::now();
        for wi in wi {
            black_box(bsdf.eval_pdf8(black_box(wi)));
        }
        let between = Instant::now();
        for xi in xi {
            black_box(bsdf.sample8(black_box(xi)));
        }
        let times = [between - start, between.elapsed()].map(|time| time.as_secs_f64());
        least = [0, 1].map(|call| f64::min(least[call], times[call]));
    }
    least
}

/// Checks that evaluation and sampling on no level of the CPU take much longer than on portable lanes. They would if a function over
/// lanes, such as `lobes`, lacked `#[inline(always)]`, because each of its operations would then be a call.
///
/// # Errors
///
/// Returns a failure with the name of the call and the level if a call takes longer.
pub fn lanes_are_inlined(subject: &dyn ErasedSubject) -> Outcome {
    let mut draws = Draws(0x5bee);
    let set = subject.set(Which::Everyday);
    let bsdf = set.prepare(0, draws.hit());
    let mut directions = || -> [Direction; 8] { core::array::from_fn(|_| draws.direction()) };
    let wi: Vec<_> = (0..PACKETS).map(|_| packet(&directions())).collect();
    let mut numbers = || -> [[f32; 3]; 8] { core::array::from_fn(|_| draws.xi3()) };
    let xi: Vec<_> = (0..PACKETS).map(|_| triples(&numbers())).collect();
    let portable = times(&*bsdf, Level::portable(), &wi, &xi);
    for level in Level::available() {
        let took = times(&*bsdf, level, &wi, &xi);
        for (call, (took, portable)) in CALLS.into_iter().zip(took.into_iter().zip(portable)) {
            let ratio = took / portable;
            println!("{NAME}: {call} on {level} takes {ratio:.2} times as long as portable lanes");
            if ratio > MOST {
                let message = format!(
                    "{call} on {level} takes {ratio:.1} times as long as portable lanes, allowed {MOST}: \
                     a function over lanes lacks `#[inline(always)]`, or calls one that does"
                );
                return Err(Failure::new(NAME, message));
            }
        }
    }
    Ok(())
}
