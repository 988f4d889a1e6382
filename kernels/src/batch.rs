//! Slice calls: structures of arrays of any length and alignment.
//!
//! Slices whose addresses differ by a multiple of 4 KiB, as those of columns a power of two long do, cost up to 40 % more
//! on many CPUs: a load waits for an earlier store whose address has the same lower twelve bits. A few unused numbers
//! between columns avoid it.

use crate::packet::{AtGather, Pdf, Samples, Value, ValuePdf};
use crate::simd::dispatch::clean_upper_halves;
use crate::{Gather, Level, Model};
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
        let Self { field, len, expected } = self;
        write!(f, "{field} has {len} entries where the first slice has {expected}")
    }
}

impl core::error::Error for LengthError {}

/// Output of [`Gather::eval_pdf_batch`]: one entry per direction.
#[derive(Debug)]
pub struct EvalSlices<'a> {
    /// S, red, green and blue, per steradian.
    pub value: [&'a mut [f32]; 3],
    /// Density, per steradian.
    pub pdf: &'a mut [f32],
}

/// Output of [`Gather::sample_batch`]: one entry per sample, all 0 but the direction and the slot for a discarded one.
#[derive(Debug)]
pub struct SampleSlices<'a> {
    /// Towards the light, in the fibre's frame: u, v, w.
    pub wi: [&'a mut [f32]; 3],
    /// S, red, green and blue, per steradian.
    pub value: [&'a mut [f32]; 3],
    /// Density, per steradian.
    pub pdf: &'a mut [f32],
    /// `value * cos theta_i / pdf`, red, green and blue.
    pub weight: [&'a mut [f32]; 3],
    /// Slot of the chosen lobe as a number, -1 for a discarded sample.
    pub slot: &'a mut [f32],
}

impl<M: Model> Gather<M> {
    /// Value and density of many directions: `wi` by component u, v, w.
    ///
    /// Nothing is read or written beyond the slices, which may be of any length and alignment.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    ///
    /// ```
    /// use hairis::{Bsdf, EvalSlices, Gaussian, Hair, HairParams};
    /// let gather = Bsdf::new(&Hair(Gaussian), &HairParams::default()).prepare(glam::Vec3::Y);
    /// let wi = [[0.0; 11], [0.6; 11], [0.8; 11]];
    /// let (mut value, mut pdf) = ([[0.0; 11]; 3], [0.0; 11]);
    /// let [r, g, b] = &mut value;
    /// gather.eval_pdf_batch([&wi[0], &wi[1], &wi[2]], EvalSlices { value: [r, g, b], pdf: &mut pdf })?;
    /// assert!(pdf.iter().all(|pdf| *pdf > 0.0));
    /// # Ok::<(), hairis::LengthError>(())
    /// ```
    #[inline]
    pub fn eval_pdf_batch(&self, wi: [&[f32]; 3], out: EvalSlices<'_>) -> Result<(), LengthError> {
        self.eval_pdf_batch_at(Level::detect(), wi, out)
    }

    /// As [`eval_pdf_batch`](Self::eval_pdf_batch), on a given instruction set.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    #[inline]
    pub fn eval_pdf_batch_at(&self, level: Level, wi: [&[f32]; 3], out: EvalSlices<'_>) -> Result<(), LengthError> {
        clean_upper_halves();
        let [r, g, b] = out.value;
        let mut out = [r, g, b, out.pdf];
        check_lengths(WI, wi, ["value.r", "value.g", "value.b", "pdf"], &out)?;
        level.run_rows(AtGather::<M, ValuePdf>::new(&self.inner), wi, &mut out);
        Ok(())
    }

    /// Value of many directions, without their densities: `wi` by component u, v, w; `value` red, green and blue.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    #[inline]
    pub fn eval_batch(&self, wi: [&[f32]; 3], value: [&mut [f32]; 3]) -> Result<(), LengthError> {
        self.eval_batch_at(Level::detect(), wi, value)
    }

    /// As [`eval_batch`](Self::eval_batch), on a given instruction set.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    #[inline]
    pub fn eval_batch_at(&self, level: Level, wi: [&[f32]; 3], value: [&mut [f32]; 3]) -> Result<(), LengthError> {
        clean_upper_halves();
        let mut out = value;
        check_lengths(WI, wi, VALUE, &out)?;
        level.run_rows(AtGather::<M, Value>::new(&self.inner), wi, &mut out);
        Ok(())
    }

    /// Density of many directions, without their values: `wi` by component u, v, w.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    #[inline]
    pub fn pdf_batch(&self, wi: [&[f32]; 3], pdf: &mut [f32]) -> Result<(), LengthError> {
        self.pdf_batch_at(Level::detect(), wi, pdf)
    }

    /// As [`pdf_batch`](Self::pdf_batch), on a given instruction set.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    #[inline]
    pub fn pdf_batch_at(&self, level: Level, wi: [&[f32]; 3], pdf: &mut [f32]) -> Result<(), LengthError> {
        clean_upper_halves();
        let mut out = [pdf];
        check_lengths(WI, wi, ["pdf"], &out)?;
        level.run_rows(AtGather::<M, Pdf>::new(&self.inner), wi, &mut out);
        Ok(())
    }

    /// Many samples: `xi` by component, for the lobe, the longitude and the azimuth, each in `[0, 1)`.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    #[inline]
    pub fn sample_batch(&self, xi: [&[f32]; 3], out: SampleSlices<'_>) -> Result<(), LengthError> {
        self.sample_batch_at(Level::detect(), xi, out)
    }

    /// As [`sample_batch`](Self::sample_batch), on a given instruction set.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    #[inline]
    pub fn sample_batch_at(&self, level: Level, xi: [&[f32]; 3], out: SampleSlices<'_>) -> Result<(), LengthError> {
        clean_upper_halves();
        let ([u, v, w], [r, g, b], [wr, wg, wb]) = (out.wi, out.value, out.weight);
        let mut out = [u, v, w, r, g, b, out.pdf, wr, wg, wb, out.slot];
        let names = [
            "wi.u", "wi.v", "wi.w", "value.r", "value.g", "value.b", "pdf", "weight.r", "weight.g", "weight.b", "slot",
        ];
        check_lengths(["xi.lobe", "xi.theta", "xi.phi"], xi, names, &out)?;
        level.run_rows(AtGather::<M, Samples>::new(&self.inner), xi, &mut out);
        Ok(())
    }
}

/// Names of the slices of a direction, and of a value.
const WI: [&str; 3] = ["wi.u", "wi.v", "wi.w"];
const VALUE: [&str; 3] = ["value.r", "value.g", "value.b"];

#[inline]
fn check_lengths<const N: usize>(
    in_names: [&'static str; 3],
    inputs: [&[f32]; 3],
    out_names: [&'static str; N],
    outputs: &[&mut [f32]; N],
) -> Result<(), LengthError> {
    let expected = inputs[0].len();
    let differs = |len: usize| len != expected;
    if differs(inputs[1].len()) | differs(inputs[2].len()) | outputs.iter().any(|s| differs(s.len())) {
        return Err(first_that_differs(
            expected,
            &in_names,
            &inputs.map(<[f32]>::len),
            &out_names,
            &outputs.each_ref().map(|s| s.len()),
        ));
    }
    Ok(())
}

/// The first of the slices that is not of the expected length.
#[cold]
fn first_that_differs(
    expected: usize,
    in_names: &[&'static str],
    inputs: &[usize],
    out_names: &[&'static str],
    outputs: &[usize],
) -> LengthError {
    let all = in_names.iter().zip(inputs).chain(out_names.iter().zip(outputs));
    let mut error = LengthError { field: "", len: expected, expected };
    for (field, len) in all {
        if *len != expected {
            error = LengthError { field, len: *len, expected };
            break;
        }
    }
    error
}
