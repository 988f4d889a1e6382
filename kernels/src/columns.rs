//! Arguments of slice calls: structures of arrays, whose lengths are checked.

pub use crate::handle::{HitsError, MaterialTable};

use crate::simd::columns::Columns;
use core::fmt;

/// Slices of one call whose lengths differ: which, how long it is, and how long the first is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LengthError {
    /// Name of the slice at fault.
    pub field: &'static str,
    /// Its length.
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

/// Output of [`Bsdf::eval_pdf_batch`](crate::Bsdf::eval_pdf_batch): one entry per direction.
#[derive(Debug)]
pub struct EvalSlices<'a> {
    /// S, red, green and blue, per steradian.
    pub value: [&'a mut [f32]; 3],
    /// Density, per steradian.
    pub pdf: &'a mut [f32],
}

/// Output of [`Bsdf::sample_batch`](crate::Bsdf::sample_batch): one entry per sample, all 0 but the direction and the slot for a discarded one.
#[derive(Debug)]
pub struct SampleSlices<'a> {
    /// Towards the light, in the fibre's frame: u, v, w.
    pub wi: [&'a mut [f32]; 3],
    /// S, red, green and blue, per steradian.
    pub value: [&'a mut [f32]; 3],
    /// Density, per steradian.
    pub pdf: &'a mut [f32],
    /// `S cos theta_i / pdf`, red, green and blue.
    pub weight: [&'a mut [f32]; 3],
    /// Slot of the chosen lobe as a number, -1 for a discarded sample.
    pub slot: &'a mut [f32],
}

/// Output of [`Bsdf::sample_weight_batch`](crate::Bsdf::sample_weight_batch): one entry per sample, all 0 but the direction for a
/// discarded one: its density is 0.
#[derive(Debug)]
pub struct SampleWeightSlices<'a> {
    /// Towards the light, in the fibre's frame: u, v, w.
    pub wi: [&'a mut [f32]; 3],
    /// Density, per steradian.
    pub pdf: &'a mut [f32],
    /// `S cos theta_i / pdf`, red, green and blue.
    pub weight: [&'a mut [f32]; 3],
}

/// Hits by column, one entry per hit.
#[derive(Clone, Copy, Debug)]
pub struct HitSlices<'a> {
    /// Towards the viewer, in the fibre's frame: u, v, w. Of any length, as for [`Material::prepare`](crate::Material::prepare).
    pub wo: [&'a [f32]; 3],
    /// Offset across the fibre, as [`Hit::h`](crate::Hit::h): clamped to `[-1, 1]`, NaN counts as 0. `None` is 0 for all
    /// hits; models of the far field ignore it.
    pub h: Option<&'a [f32]>,
}

/// Output of [`Material::eval_pdf_hits`](crate::Material::eval_pdf_hits): one entry per hit. Columns that are `None` are not written.
#[derive(Debug, Default)]
pub struct EvalColumns<'a> {
    /// S, red, green and blue, per steradian.
    pub value: Option<[&'a mut [f32]; 3]>,
    /// Density, per steradian.
    pub pdf: Option<&'a mut [f32]>,
}

/// Output of [`Material::sample_hits`](crate::Material::sample_hits): one entry per hit, all 0 but the direction and the slot for a discarded sample.
/// Columns that are `None` are not written.
#[derive(Debug, Default)]
pub struct SampleColumns<'a> {
    /// Towards the light, in the fibre's frame: u, v, w.
    pub wi: Option<[&'a mut [f32]; 3]>,
    /// S, red, green and blue, per steradian.
    pub value: Option<[&'a mut [f32]; 3]>,
    /// Density, per steradian.
    pub pdf: Option<&'a mut [f32]>,
    /// `value * cos theta_i / pdf`, red, green and blue.
    pub weight: Option<[&'a mut [f32]; 3]>,
    /// Slot of the chosen lobe as a number, -1 for a discarded sample.
    pub slot: Option<&'a mut [f32]>,
}

impl<'a> HitSlices<'a> {
    pub(crate) const fn len(&self) -> usize {
        self.wo[0].len()
    }

    /// The columns of the hits and three more, of one length.
    #[inline]
    pub(crate) fn with(
        &self,
        [x, y, z]: [&'a [f32]; 3],
        names: [&'static str; 3],
    ) -> Result<[&'a [f32]; 7], LengthError> {
        let [u, v, w] = self.wo;
        check_lengths(
            self.len(),
            [
                ("wo.v", Some(v.len())),
                ("wo.w", Some(w.len())),
                ("h", self.h.map(<[f32]>::len)),
            ],
        )?;
        check_lengths(
            self.len(),
            [
                (names[0], Some(x.len())),
                (names[1], Some(y.len())),
                (names[2], Some(z.len())),
            ],
        )?;
        Ok([u, v, w, self.h.unwrap_or_default(), x, y, z])
    }
}

impl<'a> EvalColumns<'a> {
    #[inline]
    pub(crate) fn columns(self, expected: usize) -> Result<[&'a mut [f32]; 4], LengthError> {
        check_lengths(expected, lens3(VALUE, self.value.as_ref()))?;
        check_lengths(
            expected,
            [("pdf", self.pdf.as_ref().map(|column| column.len()))],
        )?;
        let [r, g, b] = self.value.unwrap_or_default();
        Ok([r, g, b, self.pdf.unwrap_or_default()])
    }
}

impl<'a> SampleColumns<'a> {
    #[inline]
    pub(crate) fn columns(self, expected: usize) -> Result<[&'a mut [f32]; 11], LengthError> {
        check_lengths(expected, lens3(WI, self.wi.as_ref()))?;
        check_lengths(expected, lens3(VALUE, self.value.as_ref()))?;
        check_lengths(
            expected,
            [("pdf", self.pdf.as_ref().map(|column| column.len()))],
        )?;
        check_lengths(
            expected,
            lens3(["weight.r", "weight.g", "weight.b"], self.weight.as_ref()),
        )?;
        check_lengths(
            expected,
            [("slot", self.slot.as_ref().map(|column| column.len()))],
        )?;
        let [u, v, w] = self.wi.unwrap_or_default();
        let [r, g, b] = self.value.unwrap_or_default();
        let [wr, wg, wb] = self.weight.unwrap_or_default();
        Ok([
            u,
            v,
            w,
            r,
            g,
            b,
            self.pdf.unwrap_or_default(),
            wr,
            wg,
            wb,
            self.slot.unwrap_or_default(),
        ])
    }
}

/// Names of the slices of a direction.
pub(crate) const WI: [&str; 3] = ["wi.u", "wi.v", "wi.w"];
/// Names of the slices of the uniform numbers.
pub(crate) const XI: [&str; 3] = ["xi.lobe", "xi.theta", "xi.phi"];
/// Names of the slices of a value.
const VALUE: [&str; 3] = ["value.r", "value.g", "value.b"];

/// Names and lengths of three columns; no length where they are left out.
#[inline(always)]
fn lens3(
    names: [&'static str; 3],
    columns: Option<&[&mut [f32]; 3]>,
) -> [(&'static str, Option<usize>); 3] {
    let len = |i: usize| columns.map(|columns| columns[i].len());
    [(names[0], len(0)), (names[1], len(1)), (names[2], len(2))]
}

/// Columns of one length. The lengths of those that differ are put together only for the error: the check is most of what a short
/// slice costs.
#[inline(always)]
pub(crate) fn check_columns<'a, const I: usize, const N: usize>(
    in_names: &'static [&'static str; I],
    inputs: [&'a [f32]; I],
    out_names: &'static [&'static str; N],
    outputs: [&'a mut [f32]; N],
) -> Result<Columns<'a, I, N>, LengthError> {
    // By value: columns that a cold call refers to would be copied to memory before every check.
    let lens = (
        inputs.map(<[f32]>::len),
        outputs.each_ref().map(|column| column.len()),
    );
    Columns::all(inputs, outputs)
        .ok_or_else(|| first_that_differs(in_names, lens.0, out_names, lens.1))
}

/// The first of the slices that is not of the length of the first input.
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

/// Refuses the first column that has a length, and not the expected one.
#[inline(always)]
pub(crate) fn check_lengths<const N: usize>(
    expected: usize,
    columns: [(&'static str, Option<usize>); N],
) -> Result<(), LengthError> {
    for (field, len) in columns {
        if let Some(len) = len
            && len != expected
        {
            return Err(LengthError {
                field,
                len,
                expected,
            });
        }
    }
    Ok(())
}
