//! Throughput by number of threads, of slices in chunks through rayon.

use super::{TimedInputs, TimedOp};
use crate::timer::quartiles;
use core::hint::black_box;
use hairis::ParamError;
use hairis::columns::{EvalColumns, SampleColumns};
use hairis::simd::Level;
use hairis_variants::ModelId;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use serde::Serialize;
use std::time::Instant;

/// Times that a chunk repeats the inputs, so that it stays in its core's cache.
const REPEATS: usize = 9;
/// Number of chunks per thread and pass, enough for every core to finish at about the same time.
const CHUNKS_A_THREAD: usize = 16;
/// Number of passes that are timed on each number of threads.
const ROUNDS: usize = 15;

/// Throughput on a number of threads, which is a row of the table.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ThreadsResult {
    /// Operation that was timed through slices: [`TimedOp::EvalPdf`] or [`TimedOp::Sample`].
    pub op: TimedOp,
    /// Name of the model.
    pub model: &'static str,
    /// Instruction set of the lanes.
    pub level: &'static str,
    /// Number of threads at work.
    pub threads: usize,
    /// Millions of directions a second, all threads together: median over the rounds.
    pub millions: f64,
    /// Speed-up over one thread: median over the rounds of the ratio within a round.
    pub speedup: f64,
    /// First quartile of the speed-up over the rounds.
    pub speedup_q1: f64,
    /// Third quartile of the speed-up over the rounds.
    pub speedup_q3: f64,
}

/// Slices of one chunk, with `N` slices of results.
struct Chunk<const N: usize> {
    inputs: [Vec<f32>; 3],
    out: [Vec<f32>; N],
}

impl<const N: usize> Chunk<N> {
    fn new(rows: &[[f32; 3]]) -> Self {
        let inputs = core::array::from_fn(|k| {
            rows.iter()
                .map(|row| row[k])
                .cycle()
                .take(rows.len() * REPEATS)
                .collect()
        });
        Self {
            inputs,
            out: core::array::from_fn(|_| vec![0.0; rows.len() * REPEATS]),
        }
    }
}

/// Returns the numbers of threads: one, two, four and so on up to all logical cores.
pub fn thread_counts() -> Vec<usize> {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    let mut counts: Vec<usize> = core::iter::successors(Some(1), |n| Some(2 * n))
        .take_while(|n| *n < all)
        .collect();
    counts.push(all);
    counts
}

/// Measures evaluation and sampling of one model on every number of threads.
///
/// # Errors
///
/// Returns an error if the default hair is rejected.
pub fn run(model: ModelId, inputs: &TimedInputs) -> Result<Vec<ThreadsResult>, ParamError> {
    let counts = thread_counts();
    let pools: Result<Vec<_>, _> = counts
        .iter()
        .map(|n| ThreadPoolBuilder::new().num_threads(*n).build())
        .collect();
    // If the system cannot start the threads, there is nothing to report.
    let Ok(pools) = pools else {
        return Ok(Vec::new());
    };
    let bsdf = model.material(&model.measured())?.prepare(inputs.wo[0]);
    let wi: Vec<[f32; 3]> = inputs.wi.iter().map(|wi| wi.to_array()).collect();
    let eval = time(&pools, &wi, |chunk: &mut Chunk<4>| {
        let [r, g, b, pdf] = chunk.out.each_mut().map(Vec::as_mut_slice);
        // The columns of a chunk are of one length.
        let _ = bsdf.eval_columns(
            chunk.inputs.each_ref().map(Vec::as_slice),
            EvalColumns {
                value: Some([r, g, b]),
                pdf: Some(pdf),
            },
        );
    });
    let sample = time(&pools, &inputs.xi, |chunk: &mut Chunk<11>| {
        let [u, v, w, r, g, b, pdf, wr, wg, wb, slot] = chunk.out.each_mut().map(Vec::as_mut_slice);
        let out = SampleColumns {
            wi: Some([u, v, w]),
            value: Some([r, g, b]),
            pdf: Some(pdf),
            weight: Some([wr, wg, wb]),
            slot: Some(slot),
        };
        let _ = bsdf.sample_columns(chunk.inputs.each_ref().map(Vec::as_slice), out);
    });
    let rows = |(op, ns): (TimedOp, Vec<Vec<f64>>)| {
        let of = |(threads, times): (&usize, &Vec<f64>)| {
            let ratios: Vec<f64> = ns[0]
                .iter()
                .zip(times)
                .map(|(one, many)| one / many)
                .collect();
            let ([_, ns, _], [speedup_q1, speedup, speedup_q3]) =
                (quartiles(times), quartiles(&ratios));
            let (model, level) = (model.name(), Level::detect().name());
            ThreadsResult {
                op,
                model,
                level,
                threads: *threads,
                millions: 1e3 / ns,
                speedup,
                speedup_q1,
                speedup_q3,
            }
        };
        counts.iter().zip(&ns).map(of).collect::<Vec<_>>()
    };
    Ok([(TimedOp::EvalPdf, eval), (TimedOp::Sample, sample)]
        .into_iter()
        .flat_map(rows)
        .collect())
}

/// Returns the time per direction of each pool in each round, ns; the pools take turns.
fn time<const N: usize>(
    pools: &[ThreadPool],
    rows: &[[f32; 3]],
    work: impl Fn(&mut Chunk<N>) + Sync,
) -> Vec<Vec<f64>> {
    let most = pools
        .iter()
        .map(ThreadPool::current_num_threads)
        .max()
        .unwrap_or(1);
    let mut chunks: Vec<Chunk<N>> = (0..CHUNKS_A_THREAD * most)
        .map(|_| Chunk::new(rows))
        .collect();
    let directions = (chunks.len() * rows.len() * REPEATS) as f64;
    let mut ns = vec![Vec::new(); pools.len()];
    for round in 0..=ROUNDS {
        for (pool, ns) in pools.iter().zip(&mut ns) {
            let start = Instant::now();
            pool.install(|| chunks.par_iter_mut().with_max_len(1).for_each(&work));
            let elapsed = start.elapsed().as_secs_f64() * 1e9;
            black_box(&chunks);
            // The first round allocates the memory and wakes the threads, and is not counted.
            if round > 0 {
                ns.push(elapsed / directions);
            }
        }
    }
    ns
}
