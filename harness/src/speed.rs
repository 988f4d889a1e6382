//! Time of each operation: the formulas in scalar code, the kernel on one lane, and on eight lanes of every
//! instruction set of this CPU, interleaved in one run.
//!
//! The formulas are timed twice: on the libm crate, and on the methods of std, which are the platform's library. Ratios are to the faster
//! of the two.
//!
//! A round times every contender of every operation once, under the same state of the machine. A ratio is formed within a round, and the
//! report has the median over the rounds with its quartiles. Directions and numbers are drawn beforehand and stay in the second-level
//! cache. After the timing, the answers of every contender are compared with the reference in `f64`.

pub mod threads;

use crate::subject::random;
use crate::timer::{quartiles, stretch, turns};
use core::hint::black_box;
use hairis::ParamError;
use hairis::simd::Level;
pub use hairis_benches::contenders::TimedOp;
pub use hairis_benches::contenders::{Contender, Contest, TIMED_DIRECTIONS, TimedInputs, contests};
use hairis_instruments::direction::uniform_direction;
use hairis_instruments::sequence::{Independent, stream_id};
use hairis_variants::ModelId;
use serde::Serialize;
use std::time::Instant;
pub use threads::ThreadsResult;

/// Least number of rounds, however slow the machine.
const MIN_ROUNDS: usize = 15;
/// Shortest time of a stretch, ns, timed or not: a thousand times the clock's own. It is also longer than the upper halves of the vector
/// units of many CPUs take to wake after code without them (10 to 20 us at a quarter of their speed).
const MIN_STRETCH: f64 = 5e4;
/// Share of wrong answers from which a contender fails. Samples next to the boundary of two lobes may choose either, and the `f32`
/// reference loses digits near the axis; a wrong lane is an eighth.
pub const MAX_WRONG: f64 = 0.01;

/// Duration of a measurement, and the seed of its inputs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpeedConfig {
    /// Time for all rounds together, s. At least fifteen rounds are made even if they take longer.
    pub seconds: f64,
    /// Seed of the directions, of the numbers and of the hair.
    pub seed: u64,
}

impl SpeedConfig {
    /// Returns settings for about twenty seconds, or for three if `quick`.
    pub(crate) const fn new(seed: u64, quick: bool) -> Self {
        Self {
            seconds: if quick { 3.0 } else { 20.0 },
            seed,
        }
    }
}

/// Time of one contender in one operation, which is a row of the table.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpeedResult {
    /// Operation that was timed.
    pub op: TimedOp,
    /// Name of the model.
    pub model: &'static str,
    /// Name of the contender: `reference`, `one lane`, or eight lanes, one of the kinds of packets and slices.
    pub contender: &'static str,
    /// Instruction set of the lanes; `scalar` for one lane, with the library that the reference takes its functions from.
    pub level: &'static str,
    /// Number of rounds.
    pub rounds: usize,
    /// Number of calls over all the inputs in each timed stretch.
    pub passes: u32,
    /// Time for one direction (or one shading point if each direction has its own), ns: median over the rounds.
    pub ns: f64,
    /// First quartile of the time over the rounds, ns.
    pub ns_q1: f64,
    /// Third quartile of the time over the rounds, ns.
    pub ns_q3: f64,
    /// Speed-up over the faster reference: median over the rounds of the ratio within a round.
    pub ratio: f64,
    /// First quartile of the speed-up over the rounds.
    pub ratio_q1: f64,
    /// Third quartile of the speed-up over the rounds.
    pub ratio_q3: f64,
    /// Share of the answers further than 1e-3 (relative, or rad) from the `f64` reference.
    pub wrong_share: f64,
    /// Whether the answers are right, except for one in a hundred. Times of a row that did not pass are not valid results.
    pub passed: bool,
}

/// Times of all contenders, with the settings and instruction sets of the measurement.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpeedReport {
    /// Settings that were requested.
    pub config: SpeedConfig,
    /// Number of directions per pass.
    pub directions: usize,
    /// Instruction set that the program was compiled for.
    pub compiled_level: &'static str,
    /// Default instruction set of eight lanes.
    pub detected_level: &'static str,
    /// Rows by model, operation and contender; the two references come first in each block.
    pub rows: Vec<SpeedResult>,
    /// Throughput of slices on several threads.
    pub threads: Vec<ThreadsResult>,
}

impl SpeedReport {
    /// Returns the row of a contender, by operation, model, name and level.
    #[must_use]
    pub fn row(
        &self,
        op: TimedOp,
        model: &str,
        contender: &str,
        level: &str,
    ) -> Option<&SpeedResult> {
        self.rows.iter().find(|row| {
            row.op == op && row.model == model && row.contender == contender && row.level == level
        })
    }
}

/// Measures all operations on every model, with its first sampler. After every round, `progress` is called with the share done, from 0 to
/// 1.
///
/// Nothing else should run on the machine meanwhile, including other threads of this program.
///
/// # Errors
///
/// Returns an error only if drawn parameters are rejected, which does not happen because all are drawn within the accepted ranges.
pub fn run(config: &SpeedConfig, mut progress: impl FnMut(f64)) -> Result<SpeedReport, ParamError> {
    let mut cells = Vec::new();
    for model in ModelId::defaults_of_names() {
        cells.extend(
            contests(model, &draw(model, config.seed))?
                .into_iter()
                .map(SpeedCell::calibrate),
        );
    }

    let start = Instant::now();
    for round in 0.. {
        let done = start.elapsed().as_secs_f64() / config.seconds;
        progress(done.min(1.0));
        if done >= 1.0 && round >= MIN_ROUNDS {
            break;
        }
        cells.iter_mut().for_each(|cell| cell.round(round));
    }
    // The threads use directions and numbers only, and none of these parameters.
    let inputs = draw(ModelId::Gaussian, config.seed);
    let mut threads = Vec::new();
    for model in ModelId::defaults_of_names() {
        threads.extend(threads::run(model, &inputs)?);
    }
    Ok(SpeedReport {
        config: *config,
        directions: TIMED_DIRECTIONS,
        compiled_level: Level::portable().name(),
        detected_level: Level::detect().name(),
        rows: cells.into_iter().flat_map(SpeedCell::rows).collect(),
        threads,
    })
}

/// Draws uniform directions and numbers. The first parameters are the default, and the other seven are drawn.
#[must_use]
pub fn draw(model: ModelId, seed: u64) -> TimedInputs {
    let (mut from, default) = (
        Independent::new(seed, stream_id(&[0x5eed])),
        model.measured(),
    );
    let mut params = [default; 8];
    params[1..].fill_with(|| random(default, &mut from));
    let narrow = default
        .fields()
        .iter()
        .filter_map(|field| Some((field, field.narrow?)));
    let narrow = narrow.fold(default, |values, (field, narrow)| {
        values.with(field.name, &vec![narrow; field.kind.width()])
    });
    let mut directions = || {
        (0..TIMED_DIRECTIONS)
            .map(|_| uniform_direction(&mut from))
            .collect()
    };
    let (wi, wo) = (directions(), directions());
    let xi = (0..TIMED_DIRECTIONS)
        .map(|_| [from.next_f32(), from.next_f32(), from.next_f32()])
        .collect();
    TimedInputs {
        wi,
        wo,
        xi,
        params,
        narrow,
    }
}

/// Times of a contender, by round.
struct Times {
    /// Number of passes in a stretch.
    passes: u32,
    /// Time per direction in each round, ns.
    ns: Vec<f64>,
}

/// Cell of the measurement: one operation of one model, which is a block of rows in the table.
struct SpeedCell {
    contest: Contest,
    /// Times by contender, in the order of the contest.
    times: Vec<Times>,
}

impl SpeedCell {
    /// Finds how many passes of each contender make a stretch long enough to time.
    fn calibrate(mut contest: Contest) -> Self {
        let passes = |contender: &mut Contender| {
            let fastest = (0..5)
                .map(|_| stretch(&mut *contender.task, 1))
                .fold(f64::INFINITY, f64::min);
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "from 1 to 1000"
            )]
            let passes = (MIN_STRETCH / fastest).ceil().clamp(1.0, 1e3) as u32;
            Times {
                passes,
                ns: Vec::new(),
            }
        };
        let times = contest.contenders.iter_mut().map(passes).collect();
        Self { contest, times }
    }

    /// Times every contender once, in an order that changes from round to round.
    fn round(&mut self, round: usize) {
        let count = self.times.len();
        for k in turns(count, round) {
            let (task, Times { passes, ns }) =
                (&mut self.contest.contenders[k].task, &mut self.times[k]);
            // One stretch is not timed, because the contender before left its own data in the caches and the vector units asleep.
            stretch(&mut **task, *passes);
            let mut time = 0.0;
            deeper(round % FRAMES, &mut || time = stretch(&mut **task, *passes));
            ns.push(time / (f64::from(*passes) * TIMED_DIRECTIONS as f64));
        }
    }

    fn rows(self) -> Vec<SpeedResult> {
        let Self {
            contest:
                Contest {
                    op,
                    model,
                    contenders,
                    truth,
                },
            times,
        } = self;
        // The two references come first; ratios are to the faster of them.
        let [libm, std] = [0, 1].map(|reference: usize| times[reference].ns.clone());
        let fastest = if quartiles(&std)[1] < quartiles(&libm)[1] {
            std
        } else {
            libm
        };
        let row = |(mut contender, Times { passes, ns }): (Contender, Times)| {
            let ratios: Vec<f64> = fastest
                .iter()
                .zip(&ns)
                .map(|(reference, ns)| reference / ns)
                .collect();
            let ([ns_q1, ns, ns_q3], [ratio_q1, ratio, ratio_q3]) =
                (quartiles(&ns), quartiles(&ratios));
            let wrong_share = truth.wrong_share(&contender.task.answers(), contender.conserves);
            SpeedResult {
                op,
                model,
                contender: contender.name,
                level: contender.level,
                rounds: ratios.len(),
                passes,
                ns,
                ns_q1,
                ns_q3,
                ratio,
                ratio_q1,
                ratio_q3,
                wrong_share,
                passed: wrong_share <= MAX_WRONG,
            }
        };
        contenders.into_iter().zip(times).map(row).collect()
    }
}

/// Number of frames of [`deeper`] that fill about a page.
const FRAMES: usize = 23;

/// Calls `f` from so many frames further down the stack.
///
/// Results are left on the stack. If their addresses happen to agree with those of a shading point's constants in the lower twelve bits,
/// each call waits for the stores of the one before and takes up to twice as long. With rounds at different depths, such addresses affect
/// only the tail of the distribution.
#[inline(never)]
fn deeper(depth: usize, f: &mut dyn FnMut()) {
    let frame = black_box([0_u8; 144]);
    if depth == 0 {
        f()
    } else {
        deeper(depth - 1, f)
    }
    black_box(&frame);
}
