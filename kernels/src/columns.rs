//! Arguments of calls on columns: one slice per component. All slices must be of one length, which every call checks.

mod frames;
mod groups;

pub use crate::handle::{HitsError, MaterialTable};
pub use frames::FrameColumns;
pub use groups::in_groups;

use crate::simd::columns::{Columns, Naming};
use core::fmt;

/// Error of a call whose slices differ in length: the slice at fault, its length, and the length of the first slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LengthError {
    /// Name of the slice at fault.
    pub field: &'static str,
    /// Length of the slice at fault.
    pub len: usize,
    /// Length of the first slice, which all others must have.
    pub expected: usize,
}

impl fmt::Display for LengthError {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            field,
            len,
            expected,
        } = self;
        write!(
            f,
            "{field} has {len} entries where the first slice has {expected}"
        )
    }
}

impl core::error::Error for LengthError {}

/// Hits stored by column, one entry per hit.
#[derive(Clone, Copy, Debug)]
pub struct HitColumns<'a> {
    /// Direction towards the viewer, in the fibre's frame: u, v, w. It may have any length, as for
    /// [`Material::prepare`](crate::Material::prepare).
    pub wo: [&'a [f32]; 3],
    /// Offset across the fibre like [`Hit::h`](crate::Hit::h), clamped to `[-1, 1]`; NaN counts as 0. With `None` the offset is 0
    /// for all hits; far-field models ignore it.
    pub h: Option<&'a [f32]>,
}

/// Results of [`Bsdf::eval_columns`](crate::Bsdf::eval_columns) and [`Material::eval_hits`](crate::Material::eval_hits), one entry
/// per direction. Columns that are `None` are not written.
#[derive(Debug, Default)]
pub struct EvalColumns<'a> {
    /// S without the cosine, red, green and blue, per steradian.
    pub value: Option<[&'a mut [f32]; 3]>,
    /// Density of sampling the direction, per steradian.
    pub pdf: Option<&'a mut [f32]>,
}

/// Results of [`Bsdf::sample_columns`](crate::Bsdf::sample_columns) and [`Material::sample_hits`](crate::Material::sample_hits), one
/// entry per sample. Columns that are `None` are not written; a path tracer needs neither value nor slot.
///
/// A discarded sample has slot -1, and its value, density and weight are 0.
#[derive(Debug, Default)]
pub struct SampleColumns<'a> {
    /// Direction towards the light, in the fibre's frame: u, v, w.
    pub wi: Option<[&'a mut [f32]; 3]>,
    /// S without the cosine, red, green and blue, per steradian.
    pub value: Option<[&'a mut [f32]; 3]>,
    /// Density of sampling the direction, per steradian.
    pub pdf: Option<&'a mut [f32]>,
    /// Throughput weight `value * cos theta_i / pdf`, red, green and blue.
    pub weight: Option<[&'a mut [f32]; 3]>,
    /// Slot of the chosen lobe as a number, -1 for a discarded sample.
    pub slot: Option<&'a mut [f32]>,
}

impl<'a> HitColumns<'a> {
    pub(crate) const fn len(&self) -> usize {
        self.wo[0].len()
    }

    // Not inlined, like the functions of results below, so that they are compiled once and not in every call of every model.
    /// Returns the columns of the hits and three more, all of one length.
    pub(crate) fn with(
        &self,
        [x, y, z]: [&'a [f32]; 3],
        names: [&'static str; 3],
    ) -> Result<[&'a [f32]; 7], LengthError> {
        let ([u, v, w], len) = (self.wo, self.len());
        check_length(len, "wo.v", Some(v))?;
        check_length(len, "wo.w", Some(w))?;
        check_length(len, "h", self.h)?;
        check_lengths3(len, names, [x, y, z])?;
        Ok([u, v, w, self.h.unwrap_or_default(), x, y, z])
    }

    /// Returns the columns of the hits, of directions and of uniform numbers, all of one length.
    pub(crate) fn with_both(
        &self,
        wi: [&'a [f32]; 3],
        xi: [&'a [f32]; 3],
    ) -> Result<[&'a [f32]; 10], LengthError> {
        let [u, v, w, h, x, y, z] = self.with(wi, WI)?;
        check_lengths3(self.len(), XI, xi)?;
        Ok([u, v, w, h, x, y, z, xi[0], xi[1], xi[2]])
    }
}

impl<'a> EvalColumns<'a> {
    /// Returns all columns, with empty slices for the columns that are left out.
    pub(crate) fn columns(
        self,
        expected: usize,
        names: [&'static str; 4],
    ) -> Result<[&'a mut [f32]; 4], LengthError> {
        let [r, g, b] = three(self.value);
        present(expected, names, [r, g, b, self.pdf])
    }

    /// Returns the columns of a call on these directions, or `None` if they differ in length.
    #[inline(always)]
    pub(crate) fn of<'b>(&'b mut self, wi: &[&'b [f32]; 3]) -> Option<Columns<'b, 3, 4>> {
        Naming::new(wi)
            .output(0, again3(&mut self.value))
            .output(3, again(&mut self.pdf))
            .all()
    }

    /// Returns the error about the first column of such a call that differs from the others in length.
    #[cold]
    pub(crate) fn check(self, wi: [&[f32]; 3]) -> Result<(), LengthError> {
        let len = wi[0].len();
        check_lengths3(len, WI, wi)?;
        self.columns(len, VALUE_PDF).map(drop)
    }
}

impl<'a> SampleColumns<'a> {
    /// Returns all columns, with empty slices for the columns that are left out.
    pub(crate) fn columns(
        self,
        expected: usize,
        names: [&'static str; 11],
    ) -> Result<[&'a mut [f32]; 11], LengthError> {
        let ([u, v, w], [r, g, b]) = (three(self.wi), three(self.value));
        let [wr, wg, wb] = three(self.weight);
        let all = [u, v, w, r, g, b, self.pdf, wr, wg, wb, self.slot];
        present(expected, names, all)
    }

    /// Returns the columns of a call on these uniform numbers, or `None` if they differ in length.
    #[inline(always)]
    pub(crate) fn of<'b>(&'b mut self, xi: &[&'b [f32]; 3]) -> Option<Columns<'b, 3, 11>> {
        Naming::new(xi)
            .output(0, again3(&mut self.wi))
            .output(3, again3(&mut self.value))
            .output(6, again(&mut self.pdf))
            .output(7, again3(&mut self.weight))
            .output(10, again(&mut self.slot))
            .all()
    }

    /// Returns the error about the first column of such a call that differs from the others in length.
    #[cold]
    pub(crate) fn check(self, xi: [&[f32]; 3]) -> Result<(), LengthError> {
        let len = xi[0].len();
        check_lengths3(len, XI, xi)?;
        self.columns(len, SAMPLE).map(drop)
    }
}

/// Borrows columns once more.
#[inline(always)]
fn again3<'a>(columns: &'a mut Option<[&mut [f32]; 3]>) -> Option<[&'a mut [f32]; 3]> {
    columns
        .as_mut()
        .map(|[x, y, z]| [&mut **x, &mut **y, &mut **z])
}

/// Borrows a column once more.
#[inline(always)]
fn again<'a>(column: &'a mut Option<&mut [f32]>) -> Option<[&'a mut [f32]; 1]> {
    column.as_mut().map(|x| [&mut **x])
}

/// Names of the columns of a direction.
pub(crate) const WI: [&str; 3] = ["wi.u", "wi.v", "wi.w"];
/// Names of the columns of the uniform numbers.
pub(crate) const XI: [&str; 3] = ["xi.lobe", "xi.theta", "xi.phi"];
/// Names of the columns of an evaluation.
pub(crate) const VALUE_PDF: [&str; 4] = ["value.r", "value.g", "value.b", "pdf"];
/// Names of the columns of a sample.
pub(crate) const SAMPLE: [&str; 11] = [
    "wi.u", "wi.v", "wi.w", "value.r", "value.g", "value.b", "pdf", "weight.r", "weight.g",
    "weight.b", "slot",
];

/// Names of the columns of a sample in a call that also writes columns of an evaluation.
pub(crate) const SAMPLE_OF_BOTH: [&str; 11] = [
    "sample.wi.u",
    "sample.wi.v",
    "sample.wi.w",
    "sample.value.r",
    "sample.value.g",
    "sample.value.b",
    "sample.pdf",
    "sample.weight.r",
    "sample.weight.g",
    "sample.weight.b",
    "sample.slot",
];

#[inline(always)]
fn three(columns: Option<[&mut [f32]; 3]>) -> [Option<&mut [f32]>; 3] {
    columns.map_or([None, None, None], |columns| columns.map(Some))
}

/// Returns the columns, with empty slices for those that are left out. All others must have the expected length.
#[inline(always)]
fn present<'a, const N: usize>(
    expected: usize,
    names: [&'static str; N],
    columns: [Option<&'a mut [f32]>; N],
) -> Result<[&'a mut [f32]; N], LengthError> {
    for (name, column) in names.into_iter().zip(&columns) {
        check_length(expected, name, column.as_deref())?;
    }
    Ok(columns.map(Option::unwrap_or_default))
}

/// Returns an error if one of three columns is not of the expected length.
#[inline(always)]
pub(crate) fn check_lengths3(
    expected: usize,
    names: [&'static str; 3],
    columns: [&[f32]; 3],
) -> Result<(), LengthError> {
    let [x, y, z] = columns;
    check_length(expected, names[0], Some(x))?;
    check_length(expected, names[1], Some(y))?;
    check_length(expected, names[2], Some(z))
}

/// Returns an error if a column is not of the expected length.
#[inline(always)]
pub(crate) fn check_length<T>(
    expected: usize,
    field: &'static str,
    column: Option<&[T]>,
) -> Result<(), LengthError> {
    match column.map(<[T]>::len) {
        Some(len) if len != expected => Err(LengthError {
            field,
            len,
            expected,
        }),
        _ => Ok(()),
    }
}

/// Checks that all columns are of one length. The lengths are compared one by one only for the error, because the check is most of
/// the cost of a short slice.
#[inline(always)]
pub(crate) fn check_columns<'a, const I: usize, const N: usize>(
    in_names: &[&'static str; I],
    inputs: [&'a [f32]; I],
    out_names: &[&'static str; N],
    outputs: [&'a mut [f32]; N],
) -> Result<Columns<'a, I, N>, LengthError> {
    // By value, because columns that a cold call refers to would be copied to memory before every check.
    let lens = (
        inputs.map(<[f32]>::len),
        outputs.each_ref().map(|column| column.len()),
    );
    let columns = Naming::new(&inputs).output(0, Some(outputs)).all();
    columns.ok_or_else(|| first_that_differs(in_names, lens.0, out_names, lens.1))
}

/// Returns the error about the first of the slices that is not as long as the first input.
#[cold]
fn first_that_differs<const I: usize, const N: usize>(
    in_names: &[&'static str; I],
    inputs: [usize; I],
    out_names: &[&'static str; N],
    outputs: [usize; N],
) -> LengthError {
    let expected = inputs[0];
    let mut all = in_names
        .iter()
        .zip(inputs)
        .chain(out_names.iter().zip(outputs));
    let (field, len) = all
        .find(|(_, len)| *len != expected)
        .unwrap_or((&"", expected));
    LengthError {
        field,
        len,
        expected,
    }
}
