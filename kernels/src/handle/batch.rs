//! Slice calls: structures of arrays of any length and alignment.
//!
//! Slices whose addresses differ by a multiple of 4 KiB, as those of columns a power of two long do, cost up to 40 % more
//! on many CPUs: a load waits for an earlier store whose address has the same lower twelve bits. A few unused numbers
//! between columns avoid it.

use crate::Bsdf;
use crate::columns::{
    EvalSlices, LengthError, SampleSlices, SampleWeightSlices, WI, XI, check_columns,
};
use crate::handle::kernels::{AtBsdf, Pdf, Samples, Value, ValuePdf, Weights};
use crate::model::Model;
use crate::simd::Level;
use crate::simd::dispatch::clean_upper_halves;

impl<M: Model> Bsdf<M> {
    /// Value and density of many directions: `wi` by component u, v, w.
    ///
    /// Nothing is read or written beyond the slices, which may be of any length and alignment.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    ///
    /// ```
    /// use hairis::{Gaussian, HairParams, Material, Published};
    /// use hairis::columns::EvalSlices;
    /// let bsdf = Material::new(&Published(Gaussian), &HairParams::default()).prepare(glam::Vec3::Y);
    /// let wi = [[0.0; 11], [0.6; 11], [0.8; 11]];
    /// let (mut value, mut pdf) = ([[0.0; 11]; 3], [0.0; 11]);
    /// let [r, g, b] = &mut value;
    /// bsdf.eval_pdf_batch([&wi[0], &wi[1], &wi[2]], EvalSlices { value: [r, g, b], pdf: &mut pdf })?;
    /// assert!(pdf.iter().all(|pdf| *pdf > 0.0));
    /// # Ok::<(), hairis::columns::LengthError>(())
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
    pub fn eval_pdf_batch_at(
        &self,
        level: Level,
        wi: [&[f32]; 3],
        out: EvalSlices<'_>,
    ) -> Result<(), LengthError> {
        clean_upper_halves();
        let [r, g, b] = out.value;
        let columns = check_columns(
            &WI,
            wi,
            &["value.r", "value.g", "value.b", "pdf"],
            [r, g, b, out.pdf],
        )?;
        level.run_columns(AtBsdf::<M, ValuePdf>::new(&self.inner), &columns);
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
    pub fn eval_batch_at(
        &self,
        level: Level,
        wi: [&[f32]; 3],
        value: [&mut [f32]; 3],
    ) -> Result<(), LengthError> {
        clean_upper_halves();
        let columns = check_columns(&WI, wi, &["value.r", "value.g", "value.b"], value)?;
        level.run_columns(AtBsdf::<M, Value>::new(&self.inner), &columns);
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
    pub fn pdf_batch_at(
        &self,
        level: Level,
        wi: [&[f32]; 3],
        pdf: &mut [f32],
    ) -> Result<(), LengthError> {
        clean_upper_halves();
        let columns = check_columns(&WI, wi, &["pdf"], [pdf])?;
        level.run_columns(AtBsdf::<M, Pdf>::new(&self.inner), &columns);
        Ok(())
    }

    /// Many samples: `xi` by component, for the lobe, the inclination and the azimuth, each in `[0, 1)`.
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
    pub fn sample_batch_at(
        &self,
        level: Level,
        xi: [&[f32]; 3],
        out: SampleSlices<'_>,
    ) -> Result<(), LengthError> {
        clean_upper_halves();
        let ([u, v, w], [r, g, b], [wr, wg, wb]) = (out.wi, out.value, out.weight);
        let columns = check_columns(
            &XI,
            xi,
            &SAMPLE,
            [u, v, w, r, g, b, out.pdf, wr, wg, wb, out.slot],
        )?;
        level.run_columns(AtBsdf::<M, Samples>::new(&self.inner), &columns);
        Ok(())
    }

    /// Many samples as a path tracer uses them, without value and slot: the same bits as
    /// [`sample_batch`](Self::sample_batch), in less time.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    #[inline]
    pub fn sample_weight_batch(
        &self,
        xi: [&[f32]; 3],
        out: SampleWeightSlices<'_>,
    ) -> Result<(), LengthError> {
        self.sample_weight_batch_at(Level::detect(), xi, out)
    }

    /// As [`sample_weight_batch`](Self::sample_weight_batch), on a given instruction set.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    #[inline]
    pub fn sample_weight_batch_at(
        &self,
        level: Level,
        xi: [&[f32]; 3],
        out: SampleWeightSlices<'_>,
    ) -> Result<(), LengthError> {
        clean_upper_halves();
        let ([u, v, w], [wr, wg, wb]) = (out.wi, out.weight);
        let columns = check_columns(&XI, xi, &WEIGHTS, [u, v, w, out.pdf, wr, wg, wb])?;
        level.run_columns(AtBsdf::<M, Weights>::new(&self.inner), &columns);
        Ok(())
    }
}

/// Names of the slices of samples.
const SAMPLE: [&str; 11] = [
    "wi.u", "wi.v", "wi.w", "value.r", "value.g", "value.b", "pdf", "weight.r", "weight.g",
    "weight.b", "slot",
];
/// The same without value and slot.
const WEIGHTS: [&str; 7] = [
    "wi.u", "wi.v", "wi.w", "pdf", "weight.r", "weight.g", "weight.b",
];
