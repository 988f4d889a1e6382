//! Calls on one direction at each of many hits, on one material or on several. The hits of each material are one slice call of the
//! Rust interface.

use crate::columns::{
    CHUNK, are_candidates, are_there, discard, evals, input, input3, output, samples, write_nothing,
};
use crate::handles::{is_handle, is_raw, material, model_of};
use crate::layout::{ARGUMENT, Evals, Hits, OK, RawMaterial, Samples};
use crate::models::visit;
use core::ptr;
use core::slice::from_raw_parts;
use hairis::Material;
use hairis::columns::{EvalColumns, HitColumns, SampleColumns, in_groups};
use hairis::model::Model;
use hairis_variants::ModelId;

/// Columns that a call writes, for evaluations or for samples.
#[derive(Clone, Copy)]
enum Call {
    Eval([*mut f32; 4]),
    Sample([*mut f32; 11]),
}

/// Columns of a call, which start at one row.
#[derive(Clone, Copy)]
struct Rows {
    wo: [*const f32; 3],
    h: *const f32,
    query: [*const f32; 3],
    call: Call,
}

impl Rows {
    /// Returns the columns from row `at` on.
    unsafe fn after(&self, at: usize) -> Self {
        // SAFETY: the caller's promise: columns have as many rows, or are null.
        let (from, to) = (
            |column: *const f32| {
                if column.is_null() {
                    column
                } else {
                    unsafe { column.add(at) }
                }
            },
            |column: *mut f32| {
                if column.is_null() {
                    column
                } else {
                    unsafe { column.add(at) }
                }
            },
        );
        Self {
            wo: self.wo.map(from),
            h: from(self.h),
            query: self.query.map(from),
            call: match self.call {
                Call::Eval(columns) => Call::Eval(columns.map(to)),
                Call::Sample(columns) => Call::Sample(columns.map(to)),
            },
        }
    }
}

/// Borrows `n` numbers for writing; returns `None` if the host leaves the column out.
unsafe fn optional<'a>(to: *mut f32, n: usize) -> Option<&'a mut [f32]> {
    // SAFETY: the caller's promise.
    (!to.is_null()).then(|| unsafe { output(to, n) })
}

/// Borrows three columns for writing; returns `None` if the host leaves them out.
unsafe fn optional3<'a>(to: [*mut f32; 3], n: usize) -> Option<[&'a mut [f32]; 3]> {
    // SAFETY: the caller's promise.
    (!to[0].is_null()).then(|| to.map(|to| unsafe { output(to, n) }))
}

/// Runs a call over consecutive hits on one material.
///
/// With the feature `raw-hits` hits on raw materials have kernels of their own, because the constants that change nothing cost up to a
/// fifth of their time.
unsafe fn run(id: ModelId, raw: *const RawMaterial, rows: *const Rows, n: usize) {
    visit!(id, M, (raw: *const RawMaterial, rows: *const Rows, n: usize) -> (), {
        // SAFETY: the tag is the model's; the caller's promise.
        unsafe {
            let (material, rows) = (material::<M>(raw), &*rows);
            if const { cfg!(feature = "raw-hits") && !M::CONSERVES } && is_raw(raw) {
                run_on(&material.inner(), rows, n);
            } else {
                run_on(material, rows, n);
            }
        }
    });
}

/// Runs a call over consecutive hits on a material of Rust.
unsafe fn run_on<M: Model>(material: &Material<M>, rows: &Rows, n: usize) {
    // SAFETY: the caller's promise.
    unsafe {
        let h = (!rows.h.is_null()).then(|| input(rows.h, n));
        let (wo, query) = (input3(rows.wo, 0, n), input3(rows.query, 0, n));
        let hits = HitColumns { wo, h };
        // All columns have `n` numbers.
        let _ = match rows.call {
            Call::Eval([r, g, b, pdf]) => {
                let out = EvalColumns {
                    value: optional3([r, g, b], n),
                    pdf: optional(pdf, n),
                };
                material.eval_hits(hits, query, out)
            }
            Call::Sample([u, v, w, r, g, b, pdf, wr, wg, wb, slot]) => {
                let out = SampleColumns {
                    wi: optional3([u, v, w], n),
                    value: optional3([r, g, b], n),
                    pdf: optional(pdf, n),
                    weight: optional3([wr, wg, wb], n),
                    slot: optional(slot, n),
                };
                material.sample_hits(hits, query, out)
            }
        };
    }
}

/// Returns true if all three columns are given, or none of them.
fn are_whole(columns: [*mut f32; 3]) -> bool {
    let [first, rest @ ..] = columns;
    rest.iter()
        .all(|column| column.is_null() == first.is_null())
}

/// Runs a call over hits, one material at a time.
unsafe fn run_all(materials: *const RawMaterial, index: Option<&[u32]>, rows: &Rows, n: usize) {
    // SAFETY: the caller's promise.
    unsafe {
        match (index, rows.call) {
            (None, _) => run_one(materials, 0, rows, n),
            (Some(index), Call::Eval(columns)) => {
                run_groups(materials, index, rows, columns, Call::Eval);
            }
            (Some(index), Call::Sample(columns)) => {
                run_groups(materials, index, rows, columns, Call::Sample);
            }
        }
    }
}

/// Runs a call over hits on the material at `index`, which scatters nothing if it is empty.
unsafe fn run_one(materials: *const RawMaterial, index: u32, rows: &Rows, n: usize) {
    // SAFETY: the caller's promise: indices are checked.
    unsafe {
        let material = materials.add(index as usize);
        match (model_of(material), rows.call) {
            (Some(id), _) => run(id, material, rows, n),
            (None, Call::Eval(to)) => write_nothing(&to, n),
            (None, Call::Sample(to)) => write_nothing(&to, n),
        }
    }
}

/// Runs a call over hits on several materials; `call` wraps the columns of results.
unsafe fn run_groups<const N: usize>(
    materials: *const RawMaterial,
    index: &[u32],
    rows: &Rows,
    columns: [*mut f32; N],
    call: fn([*mut f32; N]) -> Call,
) {
    let n = index.len();
    let ([u, v, w], [x, y, z]) = (rows.wo, rows.query);
    // SAFETY: the caller's promise.
    let inputs = [u, v, w, rows.h, x, y, z].map(|column| {
        let column = (!column.is_null()).then(|| unsafe { input(column, n) });
        column.unwrap_or_default()
    });
    // SAFETY: the caller's promise.
    let outputs = columns.map(|column| unsafe { optional(column, n) }.unwrap_or_default());
    in_groups(index, inputs, outputs, 1, |index, inputs, outputs| {
        // Columns that the host leaves out are null.
        let [u, v, w, h, x, y, z] = inputs.map(|column| match column {
            [] => ptr::null(),
            column => column.as_ptr(),
        });
        let rows = Rows {
            wo: [u, v, w],
            h,
            query: [x, y, z],
            call: call(outputs.map(|column| match column {
                [] => ptr::null_mut(),
                column => column.as_mut_ptr(),
            })),
        };
        // SAFETY: the caller's promise.
        unsafe { run_one(materials, index[0], &rows, index.len()) };
    });
}

/// Checks the arguments of a call and runs the call.
unsafe fn call(
    materials: *const RawMaterial,
    count: usize,
    n: usize,
    hits: *const Hits,
    query: *const [*const f32; 3],
    call: Call,
) -> i32 {
    if materials.is_null() || count == 0 || hits.is_null() || query.is_null() {
        return ARGUMENT;
    }
    // SAFETY: the caller's promise.
    let (hits, query) = unsafe { (&*hits, query.read()) };
    let ([u, v, w], [x, y, z]) = (hits.wo, query);
    if !are_there([u, v, w, x, y, z], n) {
        return ARGUMENT;
    }
    // SAFETY: the caller's promise.
    let index = (!hits.index.is_null()).then(|| unsafe { from_raw_parts(hits.index, n) });
    // SAFETY: the caller's promise: there are `count` materials.
    let is_known = |index: usize| index < count && unsafe { is_handle(materials.add(index)) };
    let all_known = match index {
        None => is_known(0),
        Some(index) => index.iter().all(|index| is_known(*index as usize)),
    };
    if !all_known {
        return ARGUMENT;
    }
    let rows = Rows {
        wo: hits.wo,
        h: hits.h,
        query,
        call,
    };
    match call {
        // SAFETY: the caller's promise.
        Call::Sample(to) if are_candidates(&to) => unsafe {
            run_candidates(materials, index, &rows, to, n);
        },
        // SAFETY: the caller's promise.
        _ => unsafe { run_all(materials, index, &rows, n) },
    }
    OK
}

/// Samples directions alone. The directions of discarded samples, which the density marks, are set to zero.
unsafe fn run_candidates(
    materials: *const RawMaterial,
    index: Option<&[u32]>,
    rows: &Rows,
    mut to: [*mut f32; 11],
    n: usize,
) {
    let mut pdf = [0.0; CHUNK];
    to[6] = pdf.as_mut_ptr();
    let [u, v, w, ..] = to;
    let mut done = 0;
    while done < n {
        let count = CHUNK.min(n - done);
        // SAFETY: the caller's promise.
        unsafe {
            let columns = [u, v, w].map(|column| column.add(done));
            to[..3].copy_from_slice(&columns);
            let rows = Rows {
                call: Call::Sample(to),
                ..rows.after(done)
            };
            let index = index.map(|index| &index[done..done + count]);
            run_all(materials, index, &rows, count);
            discard(&columns, &pdf, count);
        }
        done += count;
    }
}

/// Implements `hairis_eval_hits`: evaluates one direction at each hit.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_eval_hits(
    materials: *const RawMaterial,
    count: usize,
    n: usize,
    hits: *const Hits,
    wi: *const [*const f32; 3],
    to: *const Evals,
) -> i32 {
    if n == 0 {
        return OK;
    }
    // SAFETY: the caller's promise: null, or columns.
    let Some(to) = (unsafe { to.as_ref() }).filter(|to| are_whole(to.value)) else {
        return ARGUMENT;
    };
    // SAFETY: the caller's promise.
    unsafe { call(materials, count, n, hits, wi, Call::Eval(evals(to))) }
}

/// Implements `hairis_sample_hits`: draws one sample at each hit.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_sample_hits(
    materials: *const RawMaterial,
    count: usize,
    n: usize,
    hits: *const Hits,
    xi: *const [*const f32; 3],
    to: *const Samples,
) -> i32 {
    if n == 0 {
        return OK;
    }
    let are_whole = |to: &&Samples| are_whole(to.wi) && are_whole(to.value) && are_whole(to.weight);
    // SAFETY: the caller's promise: null, or columns.
    let Some(to) = (unsafe { to.as_ref() }).filter(are_whole) else {
        return ARGUMENT;
    };
    // SAFETY: the caller's promise.
    unsafe { call(materials, count, n, hits, xi, Call::Sample(samples(to))) }
}
