//! Arguments of calls: slices of one length, which every call checks.

use core::cell::Cell;
use core::fmt;
use core::slice;
use hairis::columns::{HitColumns, LengthError};
use hairis::f32x8;

/// Numbers of an evaluation: red, green, blue, and the density.
const RESULTS: usize = 4;
/// Numbers of a hit and a direction: `wo`, `h`, `wi`.
const ARGUMENTS: usize = 7;
/// Numbers that are read for each hit: the arguments, and a weight per result.
pub(crate) const INPUTS: usize = ARGUMENTS + RESULTS;
/// Numbers that are written for each hit: the results, and a derivative per argument.
pub(crate) const OUTPUTS: usize = RESULTS + ARGUMENTS;
/// Packets of one call of a dispatched function.
pub(crate) const GROUP: usize = 16;

/// Error of a call that was rejected before anything was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum GradError {
    /// A slice differs in length from the first.
    Length(LengthError),
    /// The count of the derivatives by the material differs from that of its numbers.
    Numbers {
        /// Name of the slice at fault.
        field: &'static str,
        /// Length of the slice at fault.
        len: usize,
        /// Count of the numbers of the material.
        numbers: usize,
    },
}

impl fmt::Display for GradError {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length(error) => error.fmt(f),
            Self::Numbers {
                field,
                len,
                numbers,
            } => {
                write!(
                    f,
                    "{field} must have {numbers} entries, one per number of the material, got {len}"
                )
            }
        }
    }
}

impl core::error::Error for GradError {}

impl From<LengthError> for GradError {
    #[inline]
    fn from(error: LengthError) -> Self {
        Self::Length(error)
    }
}

/// Weights of the results, one entry per hit. The derivatives are those of the sum of `weight * result` over all results and hits, in
/// which results without weights have weight 0.
///
/// Reverse-mode automatic differentiation calls these weights cotangents or adjoints: if the sum is part of a loss, they are the
/// derivatives of the loss by the results.
#[derive(Clone, Copy, Debug, Default)]
pub struct Weights<'a> {
    /// Weights of S in red, green and blue.
    pub value: Option<[&'a [f32]; 3]>,
    /// Weights of the density. [`eval_grad`](crate::Gradients::eval_grad), which computes no density, ignores them.
    pub pdf: Option<&'a [f32]>,
}

/// Results and derivatives that a call writes, each in columns. Columns that are `None` are left out.
#[derive(Debug, Default)]
pub struct GradColumns<'a, 'b> {
    /// S in red, green and blue, per steradian. This and the following columns have one entry per hit.
    pub value: Option<[&'a mut [f32]; 3]>,
    /// Density, per steradian; 0 from [`eval_grad`](crate::Gradients::eval_grad).
    pub pdf: Option<&'a mut [f32]>,
    /// Derivative by `wo`: u, v, w.
    pub d_wo: Option<[&'a mut [f32]; 3]>,
    /// Derivative by the offset `h`, which is 0 outside `[-1, 1]` and for models of the far field.
    pub d_h: Option<&'a mut [f32]>,
    /// Derivative by `wi`: u, v, w.
    pub d_wi: Option<[&'a mut [f32]; 3]>,
    /// Derivative by each number of the material, summed over the hits: [`NUMBERS`](crate::Gradients::NUMBERS) entries, to which the call
    /// adds. [`by_parameters`](crate::Gradients::by_parameters) turns them into derivatives by parameters.
    ///
    /// Each of eight lanes sums 512 hits in single precision, and the sums of the lanes are added in double precision, from the first hit
    /// on. The sum depends on whether the level fuses, and on no other property of the machine.
    pub d_material: Option<&'a mut [f64]>,
    /// Derivative by each number of the material per hit: one column per number, each with one entry per hit. With these columns, packets
    /// of eight hits are computed one at a time, which takes longer than computing sums.
    pub d_material_of_hits: Option<&'a mut [&'b mut [f32]]>,
}

/// Columns of a call in the order of the generated rows, all of one length. Columns that are left out are empty.
#[derive(Debug)]
pub(crate) struct Call<'a, 'b> {
    pub(crate) len: usize,
    inputs: [&'a [f32]; INPUTS],
    outputs: [&'a mut [f32]; OUTPUTS],
    pub(crate) sums: &'a mut [f64],
    each: &'a mut [&'b mut [f32]],
}

/// Names of the input columns, in order.
const INPUT_NAMES: [&str; INPUTS] = [
    "wo.u",
    "wo.v",
    "wo.w",
    "h",
    "wi.u",
    "wi.v",
    "wi.w",
    "weights.value.r",
    "weights.value.g",
    "weights.value.b",
    "weights.pdf",
];
/// Names of the output columns, in order.
const OUTPUT_NAMES: [&str; OUTPUTS] = [
    "value.r", "value.g", "value.b", "pdf", "d_wo.u", "d_wo.v", "d_wo.w", "d_h", "d_wi.u",
    "d_wi.v", "d_wi.w",
];

/// Returns a derivative, or 0 if it is not finite.
pub(crate) fn finite_or_0(x: f32) -> f32 {
    if x.is_finite() { x } else { 0.0 }
}

fn three<T>(columns: Option<[T; 3]>) -> [Option<T>; 3] {
    columns.map_or([None, None, None], |columns| columns.map(Some))
}

fn check(field: &'static str, len: usize, expected: usize) -> Result<(), LengthError> {
    if len == expected {
        return Ok(());
    }
    Err(LengthError {
        field,
        len,
        expected,
    })
}

impl<'a, 'b> Call<'a, 'b> {
    /// Collects the columns of a call, or returns an error if they differ in length.
    pub(crate) fn new(
        hits: HitColumns<'a>,
        wi: [&'a [f32]; 3],
        weights: Weights<'a>,
        out: GradColumns<'a, 'b>,
        numbers: usize,
    ) -> Result<Self, GradError> {
        let len = hits.wo[0].len();
        let ([ou, ov, ow], [iu, iv, iw]) = (three(Some(hits.wo)), three(Some(wi)));
        let [wr, wg, wb] = three(weights.value);
        let inputs = [ou, ov, ow, hits.h, iu, iv, iw, wr, wg, wb, weights.pdf];
        for (name, column) in INPUT_NAMES.into_iter().zip(inputs) {
            check(name, column.map_or(len, <[f32]>::len), len)?;
        }
        let ([r, g, b], [u, v, w], [x, y, z]) =
            (three(out.value), three(out.d_wo), three(out.d_wi));
        let outputs = [r, g, b, out.pdf, u, v, w, out.d_h, x, y, z];
        for (name, column) in OUTPUT_NAMES.into_iter().zip(&outputs) {
            check(name, column.as_deref().map_or(len, <[f32]>::len), len)?;
        }
        let (sums, each) = (out.d_material, out.d_material_of_hits);
        for (field, count) in [
            ("d_material", sums.as_deref().map(<[f64]>::len)),
            (
                "d_material_of_hits",
                each.as_deref().map(<[&mut [f32]]>::len),
            ),
        ] {
            if let Some(len) = count.filter(|count| *count != numbers) {
                return Err(GradError::Numbers {
                    field,
                    len,
                    numbers,
                });
            }
        }
        let (sums, each) = (sums.unwrap_or_default(), each.unwrap_or_default());
        for column in each.iter() {
            check("d_material_of_hits[..]", column.len(), len)?;
        }
        // Columns by numbers that the derivatives do not read stay 0.
        each.iter_mut().for_each(|column| column.fill(0.0));
        Ok(Self {
            len,
            inputs: inputs.map(Option::unwrap_or_default),
            outputs: outputs.map(Option::unwrap_or_default),
            sums,
            each,
        })
    }

    /// Returns true if derivatives by the material are requested per hit.
    pub(crate) fn has_each(&self) -> bool {
        !self.each.is_empty()
    }

    /// Calls `run` with packets from hit `at` on, and returns their count: at least one, and at most `most` and [`GROUP`]. If fewer than
    /// eight hits are left, they form a packet whose other lanes repeat the last hit with weights of 0.
    #[inline(always)]
    pub(crate) fn packets(
        &mut self,
        at: usize,
        most: usize,
        run: impl FnOnce([&[[f32; 8]]; INPUTS], [&[Cell<[f32; 8]>]; OUTPUTS]),
    ) -> usize {
        let full = ((self.len - at) / 8).min(most).min(GROUP);
        let left_out = ([[0.0; 8]; GROUP], [const { Cell::new([0.0; 8]) }; GROUP]);
        let mut few = ([[0.0; 8]; INPUTS], [const { Cell::new([0.0; 8]) }; OUTPUTS]);
        let mut inputs = [&left_out.0[..full]; INPUTS];
        let mut outputs = [&left_out.1[..full]; OUTPUTS];
        let weights = RESULTS + 3;
        if full == 0 {
            for (place, (column, to)) in self.inputs.iter().zip(&mut few.0).enumerate() {
                let column = column.get(at..).unwrap_or_default();
                if place < weights {
                    to.fill(column.last().copied().unwrap_or(0.0));
                }
                to[..column.len()].copy_from_slice(column);
            }
            inputs = few.0.each_ref().map(slice::from_ref);
            outputs = few.1.each_ref().map(slice::from_ref);
        } else {
            for (column, to) in self.inputs.iter().zip(&mut inputs) {
                if let Some(packets) = column.get(at..at + 8 * full) {
                    *to = packets.as_chunks().0;
                }
            }
            for (column, to) in self.outputs.iter_mut().zip(&mut outputs) {
                if let Some(packets) = column.get_mut(at..at + 8 * full) {
                    *to = Cell::from_mut(packets.as_chunks_mut().0).as_slice_of_cells();
                }
            }
        }
        run(inputs, outputs);
        if full == 0 {
            for (column, from) in self.outputs.iter_mut().zip(&few.1) {
                let column = column.get_mut(at..).unwrap_or_default();
                column.copy_from_slice(&from.get()[..column.len()]);
            }
        }
        full.max(1)
    }

    /// Writes the derivatives by numbers of the material of up to eight hits from `at` on, each number to the column of its place. The
    /// derivatives by the hit, which are already written, are set to 0 where they are not finite.
    pub(crate) fn finish(&mut self, at: usize, places: &[usize], rows: &[f32x8]) {
        let eight = at..self.len.min(at + 8);
        for column in &mut self.outputs[RESULTS..] {
            for derivative in column.get_mut(eight.clone()).unwrap_or_default() {
                *derivative = finite_or_0(*derivative);
            }
        }
        for (place, row) in places.iter().zip(rows) {
            if let Some(column) = self.each.get_mut(*place) {
                let column = &mut column[eight.clone()];
                column.copy_from_slice(&row.to_array()[..column.len()]);
            }
        }
    }
}
