//! Calls on columns at one hit: structures of arrays of any length and alignment.
//!
//! On many CPUs columns whose addresses differ by a multiple of 4 KiB, such as columns a power of two long, cost up to 40 % more.
//! The reason is that a load waits for an earlier store whose address has the same lower twelve bits. Leave a few unused numbers
//! between the columns to avoid the wait.

use super::Bsdf;
use super::kernels::{AtBsdf, Pdf, Samples, ValuePdf};
use crate::columns::{
    EvalColumns, LengthError, SampleColumns, VALUE_PDF, WI, check_columns, check_lengths3,
};
use crate::model::Model;
use crate::simd::dispatch::clean_upper_halves;

impl<M: Model> Bsdf<M> {
    /// Evaluates S and the density of many directions; `wi` holds the components u, v, w. Columns left out of `out` are not
    /// computed.
    ///
    /// Nothing is read or written beyond the columns, which may be of any length and alignment.
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the columns differ in length.
    ///
    /// ```
    /// use hairis::columns::EvalColumns;
    /// use hairis::{Gaussian, HairParams, Material, Published};
    /// let bsdf = Material::new(&Published(Gaussian), &HairParams::default()).prepare(glam::Vec3::Y);
    /// let wi = [[0.0; 11], [0.6; 11], [0.8; 11]];
    /// let (mut value, mut pdf) = ([[0.0; 11]; 3], [0.0; 11]);
    /// let [r, g, b] = &mut value;
    /// let out = EvalColumns { value: Some([r, g, b]), pdf: Some(&mut pdf) };
    /// bsdf.eval_columns([&wi[0], &wi[1], &wi[2]], out)?;
    /// assert!(pdf.iter().all(|pdf| *pdf > 0.0));
    /// # Ok::<(), hairis::columns::LengthError>(())
    /// ```
    #[inline]
    pub fn eval_columns(&self, wi: [&[f32]; 3], out: EvalColumns<'_>) -> Result<(), LengthError> {
        clean_upper_halves();
        match out {
            // A kernel of its own, because half of the terms are those of the value.
            EvalColumns {
                value: None,
                pdf: Some(pdf),
            } => {
                let columns = check_columns(&WI, wi, &[VALUE_PDF[3]], [pdf])?;
                let row = AtBsdf::<M::Inner, Pdf>::new(&self.prepared);
                self.level.run_columns(row, &columns);
            }
            EvalColumns {
                value: None,
                pdf: None,
            } => check_lengths3(wi[0].len(), WI, wi)?,
            mut out => {
                let Some(columns) = out.of(&wi) else {
                    return out.check(wi);
                };
                let row = AtBsdf::<M::Inner, ValuePdf>::new(&self.prepared);
                self.level.run_columns(row, &columns);
            }
        }
        Ok(())
    }

    /// Draws many samples; `xi` holds uniform numbers in `[0, 1)` for the lobe, the inclination and the azimuth.
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the columns differ in length.
    #[inline]
    pub fn sample_columns(
        &self,
        xi: [&[f32]; 3],
        mut out: SampleColumns<'_>,
    ) -> Result<(), LengthError> {
        clean_upper_halves();
        let Some(columns) = out.of(&xi) else {
            return out.check(xi);
        };
        let row = AtBsdf::<M::Inner, Samples>::new(&self.prepared);
        self.level.run_columns(row, &columns);
        Ok(())
    }
}
