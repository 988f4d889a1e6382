//! Calls on many directions at one hit, and on candidates for resampling.
//!
//! Each call has one kernel per model, which writes every column; columns that the host leaves out go to a scratch buffer. One
//! kernel per set of columns, as in the Rust interface, would double the size of the library.

use crate::handles::{bsdf, is_handle, model_of};
use crate::layout::{
    ARGUMENT, Candidates, Choice, Counts, Evals, OK, PARTITION_ALL, PARTITION_BALANCE,
    PARTITION_POWER, RawBsdf, Samples, Weights,
};
use crate::models::visit;
use core::slice::{from_raw_parts, from_raw_parts_mut};
use hairis::model::Model;
use hairis::resample::{self, CandidateColumns, Partition, WeightColumns};
use hairis::simd::{Lanes, Level, Row, Vec3x};

/// Largest count of numbers that a column may have.
const MOST: usize = isize::MAX as usize / size_of::<f32>();
/// Rows of a scratch buffer, whose columns lie apart by a distance that is not a power of two.
pub(crate) const CHUNK: usize = 256;

/// Returns true if each of these columns can hold `n` numbers, as far as a pointer shows.
pub(crate) fn are_there<const N: usize>(columns: [*const f32; N], n: usize) -> bool {
    n <= MOST && columns.iter().all(|column| !column.is_null())
}

/// Borrows `n` numbers of the host.
pub(crate) unsafe fn input<'a>(from: *const f32, n: usize) -> &'a [f32] {
    // SAFETY: the caller's promise.
    unsafe { from_raw_parts(from, n) }
}

/// Borrows `n` numbers of each component of the host's columns, from number `at` on.
pub(crate) unsafe fn input3<'a>(from: [*const f32; 3], at: usize, n: usize) -> [&'a [f32]; 3] {
    // SAFETY: the caller's promise.
    from.map(|from| unsafe { input(from.add(at), n) })
}

/// Borrows `n` numbers of the host for writing.
pub(crate) unsafe fn output<'a>(to: *mut f32, n: usize) -> &'a mut [f32] {
    // SAFETY: the caller's promise.
    unsafe { from_raw_parts_mut(to, n) }
}

/// Kernel that evaluates one row at a BSDF.
struct Eval<'a, M: Model>(&'a M::Prepared<f32>);
/// Kernel that draws one row of samples from a BSDF.
struct Sample<'a, M: Model>(&'a M::Prepared<f32>);

impl<M: Model> Clone for Eval<'_, M> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<M: Model> Copy for Eval<'_, M> {}
impl<M: Model> Clone for Sample<'_, M> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<M: Model> Copy for Sample<'_, M> {}

impl<M: Model> Row<3, 4> for Eval<'_, M> {
    #[inline(always)]
    fn row<L: Lanes>(self, [x, y, z]: [L; 3]) -> [L; 4] {
        let eval = M::eval::<L, f32>(self.0, Vec3x::new(x, y, z));
        let [r, g, b] = eval.value;
        [r, g, b, eval.pdf]
    }
}

impl<M: Model> Row<3, 11> for Sample<'_, M> {
    #[inline(always)]
    fn row<L: Lanes>(self, xi: [L; 3]) -> [L; 11] {
        let s = M::sample::<L, f32>(self.0, xi);
        let ([r, g, b], [wr, wg, wb]) = (s.value, s.weight);
        [s.wi.x, s.wi.y, s.wi.z, r, g, b, s.pdf, wr, wg, wb, s.slot]
    }
}

/// Returns the columns of an evaluation, which are the value and the density.
pub(crate) const fn evals(to: &Evals) -> [*mut f32; 4] {
    let [r, g, b] = to.value;
    [r, g, b, to.pdf]
}

/// Returns the columns of a sample, in the order of the Rust interface.
pub(crate) const fn samples(to: &Samples) -> [*mut f32; 11] {
    let ([u, v, w], [r, g, b], [wr, wg, wb]) = (to.wi, to.value, to.weight);
    [u, v, w, r, g, b, to.pdf, wr, wg, wb, to.lobe]
}

/// Returns true if the host wants only the directions of samples. Such candidates are 0 where a sample is discarded.
pub(crate) fn are_candidates(to: &[*mut f32; 11]) -> bool {
    to[..3].iter().all(|column| !column.is_null()) && to[3..].iter().all(|column| column.is_null())
}

/// Runs `rows` over all `n` rows: at once if the host wants every column, or else chunk by chunk with a scratch buffer for the
/// columns that it leaves out. `rows` takes the first row, the count of rows and the columns.
///
/// # Safety
///
/// Each column is null or has `n` numbers, which nothing else refers to.
unsafe fn in_chunks<const N: usize>(
    n: usize,
    to: &[*mut f32; N],
    rows: impl Fn(usize, usize, &mut [&mut [f32]; N]),
) {
    if to.iter().all(|column| !column.is_null()) {
        // SAFETY: the caller's promise.
        rows(0, n, &mut to.map(|column| unsafe { output(column, n) }));
        return;
    }
    let mut scratch = [[0.0; CHUNK + 16]; N];
    let mut at = 0;
    while at < n {
        let count = CHUNK.min(n - at);
        let mut wanted = to.iter();
        let mut columns = scratch.each_mut().map(|scratch| match wanted.next() {
            // SAFETY: the caller's promise.
            Some(column) if !column.is_null() => unsafe { output(column.add(at), count) },
            _ => &mut scratch[..count],
        });
        rows(at, count, &mut columns);
        at += count;
    }
}

/// Writes what an empty handle scatters, which is nothing: all columns of an evaluation, of samples or of candidates are 0, except that
/// of the lobes, which is that of discarded samples.
///
/// # Safety
///
/// Each column is null or has `n` numbers, which nothing else refers to.
pub(crate) unsafe fn write_nothing<const N: usize>(to: &[*mut f32; N], n: usize) {
    const LOBE: usize = 10;
    for (place, column) in to
        .iter()
        .enumerate()
        .filter(|(_, column)| !column.is_null())
    {
        let number = if place == LOBE { -1.0 } else { 0.0 };
        // SAFETY: the caller's promise.
        unsafe { output(*column, n) }.fill(number);
    }
}

/// Sets the directions of discarded samples, whose density is 0, to zero.
pub(crate) unsafe fn discard(wi: &[*mut f32; 3], pdf: &[f32], count: usize) {
    for (row, pdf) in pdf.iter().take(count).enumerate() {
        if *pdf <= 0.0 {
            for column in wi {
                // SAFETY: the caller's promise: the columns have as many rows.
                unsafe { column.add(row).write(0.0) };
            }
        }
    }
}

/// Implements `hairis_eval_columns`: evaluates many directions at one BSDF.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_eval_columns(
    raw: *const RawBsdf,
    n: usize,
    wi: *const [*const f32; 3],
    to: *const Evals,
) -> i32 {
    if n == 0 {
        return OK;
    }
    if raw.is_null() || wi.is_null() || to.is_null() {
        return ARGUMENT;
    }
    // SAFETY: the caller's promise.
    let (id, wi, to) = unsafe { (model_of(raw), wi.read(), evals(&*to)) };
    // SAFETY: the caller's promise.
    if !unsafe { is_handle(raw) } || !are_there(wi, n) {
        return ARGUMENT;
    }
    let Some(id) = id else {
        // SAFETY: the caller's promise.
        unsafe { write_nothing(&to, n) };
        return OK;
    };
    visit!(id, M, (raw: *const RawBsdf, n: usize, wi: [*const f32; 3], to: [*mut f32; 4]) -> (), {
        // SAFETY: the tag is the model's.
        let bsdf = unsafe { bsdf::<M>(raw) };
        // SAFETY: the caller's promise.
        let rows = |at, count, columns: &mut [&mut [f32]; 4]| unsafe {
            bsdf.level().run_rows(Eval::<M>(bsdf.constants()), input3(wi, at, count), columns);
        };
        // SAFETY: the caller's promise.
        unsafe { in_chunks(n, &to, rows) };
    });
    OK
}

/// Implements `hairis_sample_columns`: draws many samples from one BSDF.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_sample_columns(
    raw: *const RawBsdf,
    n: usize,
    xi: *const [*const f32; 3],
    to: *const Samples,
) -> i32 {
    if n == 0 {
        return OK;
    }
    if raw.is_null() || xi.is_null() || to.is_null() {
        return ARGUMENT;
    }
    // SAFETY: the caller's promise.
    let (id, xi, to) = unsafe { (model_of(raw), xi.read(), samples(&*to)) };
    // SAFETY: the caller's promise.
    if !unsafe { is_handle(raw) } || !are_there(xi, n) {
        return ARGUMENT;
    }
    let Some(id) = id else {
        // SAFETY: the caller's promise.
        unsafe { write_nothing(&to, n) };
        return OK;
    };
    visit!(id, M, (raw: *const RawBsdf, n: usize, xi: [*const f32; 3], to: [*mut f32; 11]) -> (), {
        // SAFETY: the tag is the model's.
        let bsdf = unsafe { bsdf::<M>(raw) };
        let is_candidate = are_candidates(&to);
        // SAFETY: the caller's promise.
        let rows = |at, count, columns: &mut [&mut [f32]; 11]| unsafe {
            let row = Sample::<M>(bsdf.constants());
            bsdf.level().run_rows(row, input3(xi, at, count), columns);
            if is_candidate {
                let wi = [to[0].add(at), to[1].add(at), to[2].add(at)];
                discard(&wi, columns[6], count);
            }
        };
        // SAFETY: the caller's promise.
        unsafe { in_chunks(n, &to, rows) };
    });
    OK
}

/// Returns all columns of a call that weighs candidates.
const fn weigh_columns(from: &Candidates, to: &Weights) -> [*const f32; 11] {
    let ([u, v, w], [r, g, b], [fr, fg, fb]) = (from.wi, from.radiance, to.contribution);
    [u, v, w, r, g, b, from.pdf_light, fr, fg, fb, to.weight]
}

/// Implements `hairis_weigh_columns`: weighs candidates for resampling.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_weigh_columns(
    raw: *const RawBsdf,
    n: usize,
    from: *const Candidates,
    counts: Counts,
    to: *const Weights,
) -> i32 {
    let partition = match counts.partition {
        PARTITION_ALL => Partition::All,
        PARTITION_BALANCE => Partition::Balance,
        PARTITION_POWER => Partition::Power,
        _ => return ARGUMENT,
    };
    if n == 0 {
        return OK;
    }
    if raw.is_null() || from.is_null() || to.is_null() {
        return ARGUMENT;
    }
    // SAFETY: the caller's promise.
    let (id, columns) = unsafe { (model_of(raw), weigh_columns(&*from, &*to)) };
    // SAFETY: the caller's promise.
    if !unsafe { is_handle(raw) } || !are_there(columns, n) {
        return ARGUMENT;
    }
    let Some(id) = id else {
        // SAFETY: the caller's promise.
        unsafe {
            let [r, g, b] = (*to).contribution;
            write_nothing(&[r, g, b, (*to).weight], n);
        }
        return OK;
    };
    let counts = resample::Counts {
        bsdf: counts.bsdf,
        light: counts.light,
    };
    visit!(id, M, (
        raw: *const RawBsdf,
        n: usize,
        from: *const Candidates,
        counts: resample::Counts,
        partition: Partition,
        to: *const Weights,
    ) -> (), {
        // SAFETY: the tag is the model's; the caller's promise.
        let (bsdf, from, to) = unsafe { (bsdf::<M>(raw), &*from, &*to) };
        let mut scratch = [[0.0; CHUNK + 16]; 4];
        let mut at = 0;
        while at < n {
            let count = CHUNK.min(n - at);
            let mut evals = scratch.each_mut().map(|column| &mut column[..count]);
            // SAFETY: the caller's promise.
            let (wi, radiance, pdf_light, contribution, weight) = unsafe {
                let to3 = to.contribution.map(|column| output(column.add(at), count));
                (
                    input3(from.wi, at, count),
                    input3(from.radiance, at, count),
                    input(from.pdf_light.add(at), count),
                    to3,
                    output(to.weight.add(at), count),
                )
            };
            bsdf.level().run_rows(Eval::<M>(bsdf.constants()), wi, &mut evals);
            weigh_chunk(
                bsdf.level(),
                evals.map(|column| &*column),
                CandidateColumns { wi, radiance, pdf_light },
                (counts, partition),
                WeightColumns { contribution, weight },
            );
            at += count;
        }
    });
    OK
}

/// Weighs candidates that have been evaluated. This function is compiled once for all models.
#[inline(never)]
fn weigh_chunk(
    level: Level,
    evals: [&[f32]; 4],
    candidates: CandidateColumns<'_>,
    (counts, partition): (resample::Counts, Partition),
    out: WeightColumns<'_>,
) {
    // All columns have one length.
    let _ = resample::weigh_evals(level, evals, candidates, counts, partition, out);
}

/// Implements `hairis_choose`: chooses among weighed candidates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_choose(
    from: *const Weights,
    n: usize,
    k: u32,
    u: f32,
    to: *mut Choice,
) -> usize {
    if n == 0 || from.is_null() || to.is_null() {
        return 0;
    }
    // SAFETY: the caller's promise.
    let from = unsafe { &*from };
    let [r, g, b] = from.contribution.map(<*mut f32>::cast_const);
    if !are_there([r, g, b, from.weight.cast_const()], n) {
        return 0;
    }
    // SAFETY: the caller's promise.
    let choices = unsafe { resample::choose(input3([r, g, b], 0, n), input(from.weight, n), k, u) };
    let mut count = 0;
    for choice in choices {
        let choice = Choice {
            index: choice.index,
            count: choice.count,
            contribution: choice.contribution,
        };
        // SAFETY: the caller's promise; there are at most `k` choices.
        unsafe { to.add(count).write(choice) };
        count += 1;
    }
    count
}
