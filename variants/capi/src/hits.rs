//! One direction at each of many hits, on one material or on several.
//!
//! Hits in a row on one material are a slice call of Rust's. Others run as packets of eight: those whose materials differ, and
//! those of materials that conserve energy by quadrature, beside which a packet costs little. A second kernel for these would
//! be a third of the library.

use crate::columns::{
    CHUNK, are_candidates, are_there, discard, evals, input, input3, output, samples,
};
use crate::handles::{is_conserving, material, model_of};
use crate::layout::{ARGUMENT, Evals, Hits, OK, RawMaterial, Samples};
use crate::models::visit;
use core::slice::from_raw_parts;
use hairis::columns::{EvalColumns, HitColumns, SampleColumns};
use hairis::{Bsdf8, Hit8, Material8, Vec3x8, f32x8};
use hairis_variants::{ModelId, Registered};

/// Columns that a call takes besides hits: a direction to evaluate, or numbers to sample with.
#[derive(Clone, Copy)]
enum Call {
    Eval([*mut f32; 4]),
    Sample([*mut f32; 11]),
}

/// The columns of a call from one row on.
#[derive(Clone, Copy)]
struct Rows {
    wo: [*const f32; 3],
    h: *const f32,
    query: [*const f32; 3],
    call: Call,
}

impl Rows {
    /// The columns from row `at` on.
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

/// `n` numbers to write; `None` if the host leaves them out.
unsafe fn optional<'a>(to: *mut f32, n: usize) -> Option<&'a mut [f32]> {
    // SAFETY: the caller's promise.
    (!to.is_null()).then(|| unsafe { output(to, n) })
}

/// Three columns to write; `None` if the host leaves them out.
unsafe fn optional3<'a>(to: [*mut f32; 3], n: usize) -> Option<[&'a mut [f32]; 3]> {
    // SAFETY: the caller's promise.
    (!to[0].is_null()).then(|| to.map(|to| unsafe { output(to, n) }))
}

/// Hits in a row on one material.
unsafe fn run(id: ModelId, raw: *const RawMaterial, rows: *const Rows, n: usize) {
    visit!(id, M, (raw: *const RawMaterial, rows: *const Rows, n: usize) -> (), {
        // SAFETY: the tag is the model's; the caller's promise.
        unsafe {
            let (material, rows) = (material::<M>(raw), &*rows);
            if !M::CONSERVES && is_conserving(raw) {
                packets::<M>(&[raw; 8], true, rows, n);
                return;
            }
            let h = (!rows.h.is_null()).then(|| input(rows.h, n));
            let (hits, query) = (HitColumns { wo: input3(rows.wo, 0, n), h }, input3(rows.query, 0, n));
            // All columns have `n` numbers.
            let _ = match rows.call {
                Call::Eval([r, g, b, pdf]) => {
                    let out = EvalColumns { value: optional3([r, g, b], n), pdf: optional(pdf, n) };
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
    });
}

/// Up to eight hits in a row, of one model and energy.
unsafe fn run_mixed(
    id: ModelId,
    lanes: *const [*const RawMaterial; 8],
    rows: *const Rows,
    n: usize,
) {
    visit!(id, M, (lanes: *const [*const RawMaterial; 8], rows: *const Rows, n: usize) -> (), {
        // SAFETY: the tags are the model's; the caller's promise.
        unsafe { packets::<M>(&*lanes, is_conserving((*lanes)[0]), &*rows, n) };
    });
}

/// Hits eight at a time, with one material per lane.
#[inline(never)]
unsafe fn packets<M: Registered>(
    lanes: &[*const RawMaterial; 8],
    conserve: bool,
    rows: &Rows,
    n: usize,
) {
    // SAFETY: the caller's promise.
    let pack = Material8::<M>::pack(lanes.map(|raw| unsafe { material::<M>(raw) }));
    let mut at = 0;
    while at < n {
        let count = 8.min(n - at);
        // SAFETY: the caller's promise.
        unsafe {
            let rows = rows.after(at);
            let hits = Hit8::new(load3(rows.wo, count), load(rows.h, count));
            let bsdf = pack.prepare8(hits);
            if !M::CONSERVES && conserve {
                store_rows(&bsdf.conserving(), &rows, count);
            } else {
                store_rows(&bsdf, &rows, count);
            }
        }
        at += count;
    }
}

/// Evaluates or samples eight hits, and writes the first `count` of them.
#[inline(never)]
unsafe fn store_rows<M: Registered>(bsdf: &Bsdf8<M>, rows: &Rows, count: usize) {
    // SAFETY: the caller's promise.
    unsafe {
        let query = load3(rows.query, count);
        match &rows.call {
            Call::Eval(to) => {
                let eval = bsdf.eval_pdf8(&query);
                let [r, g, b] = &eval.value;
                store([r, g, b, &eval.pdf], to, count);
            }
            Call::Sample(to) => {
                let s = bsdf.sample8(&[query.x, query.y, query.z]);
                let ([r, g, b], [wr, wg, wb]) = (&s.value, &s.weight);
                let lanes = [
                    &s.wi.x, &s.wi.y, &s.wi.z, r, g, b, &s.pdf, wr, wg, wb, &s.slot,
                ];
                store(lanes, to, count);
            }
        }
    }
}

/// Up to eight numbers, 0 for the others; 0 where the host leaves the column out.
unsafe fn load(from: *const f32, count: usize) -> f32x8 {
    let mut lanes = [0.0; 8];
    if !from.is_null() {
        // SAFETY: the caller's promise.
        lanes[..count].copy_from_slice(unsafe { input(from, count) });
    }
    f32x8::new(lanes)
}

/// Up to eight vectors.
unsafe fn load3(from: [*const f32; 3], count: usize) -> Vec3x8 {
    // SAFETY: the caller's promise.
    let [x, y, z] = from.map(|from| unsafe { load(from, count) });
    Vec3x8::new(x, y, z)
}

/// Writes the first `count` numbers of each column that the host wants.
unsafe fn store<const N: usize>(lanes: [&f32x8; N], to: &[*mut f32; N], count: usize) {
    for (lanes, to) in lanes.into_iter().zip(to) {
        if !to.is_null() {
            // SAFETY: the caller's promise.
            unsafe { output(*to, count) }.copy_from_slice(&lanes.as_array()[..count]);
        }
    }
}

/// Whether three columns are all there, or none of them.
fn are_whole(columns: [*mut f32; 3]) -> bool {
    let [first, rest @ ..] = columns;
    rest.iter()
        .all(|column| column.is_null() == first.is_null())
}

/// Runs a call over hits in order: those of one material in a row, and up to eight of one model and energy.
unsafe fn run_all(materials: *const RawMaterial, index: Option<&[u32]>, rows: &Rows, n: usize) {
    // SAFETY: the caller's promise: indices are checked, and no material is empty.
    unsafe {
        let Some(index) = index else {
            if let Some(id) = model_of(materials) {
                run(id, materials, rows, n);
            }
            return;
        };
        let at = |hit: usize| materials.add(index[hit] as usize);
        let kind = |raw: *const RawMaterial| (model_of(raw), is_conserving(raw));
        let mut done = 0;
        while done < n {
            let (first, rest) = (at(done), &index[done..]);
            let (Some(id), _) = kind(first) else { return };
            let alike = rest.iter().take_while(|other| **other == rest[0]).count();
            let rows = rows.after(done);
            if alike >= 8 || alike == rest.len() {
                run(id, first, &rows, alike);
                done += alike;
                continue;
            }
            let mut lanes = [first; 8];
            let mut count = 0;
            while count < 8.min(rest.len()) && kind(at(done + count)) == kind(first) {
                lanes[count] = at(done + count);
                count += 1;
            }
            run_mixed(id, &lanes, &rows, count);
            done += count;
        }
    }
}

/// Checks a call, and runs it.
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
    let is_known =
        |index: usize| index < count && unsafe { model_of(materials.add(index)) }.is_some();
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

/// Samples directions alone: those of discarded samples are 0, which the density tells.
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

/// `hairis_eval_hits`.
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

/// `hairis_sample_hits`.
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
