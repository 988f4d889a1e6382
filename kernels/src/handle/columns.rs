//! Calls on columns at one hit: structures of arrays of any length and alignment.
//!
//! On many CPUs columns whose addresses differ by a multiple of 4 KiB, such as columns a power of two long, cost up to 40 % more.
//! The reason is that a load waits for an earlier store whose address has the same lower twelve bits. Leave a few unused numbers
//! between the columns to avoid the wait.

use super::Bsdf;
use super::kernels::{AtBsdf, Pdf, Samples, SomeSamples, Value, ValuePdf, Weights};
use crate::columns::{
    EvalColumns, LengthError, SAMPLE, SAMPLE_WEIGHT, SampleColumns, VALUE_PDF, WI, XI,
    check_columns, check_lengths3,
};
use crate::model::Model;
use crate::simd::Row;
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
        let [value @ .., pdf] = &VALUE_PDF;
        match (out.value, out.pdf) {
            (Some([r, g, b]), Some(pdf)) => {
                self.run::<ValuePdf, 4>(&WI, wi, &VALUE_PDF, [r, g, b, pdf])
            }
            (Some(out), None) => self.run::<Value, 3>(&WI, wi, value, out),
            (None, Some(out)) => self.run::<Pdf, 1>(&WI, wi, &[*pdf], [out]),
            (None, None) => check_lengths3(wi[0].len(), WI, wi),
        }
    }

    /// Draws many samples; `xi` holds uniform numbers in `[0, 1)` for the lobe, the inclination and the azimuth. Samples without
    /// value and slot take less time, with the same bits.
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the columns differ in length.
    #[inline]
    pub fn sample_columns(
        &self,
        xi: [&[f32]; 3],
        out: SampleColumns<'_>,
    ) -> Result<(), LengthError> {
        match out {
            SampleColumns {
                wi: Some([u, v, w]),
                value: Some([r, g, b]),
                pdf: Some(pdf),
                weight: Some([wr, wg, wb]),
                slot: Some(slot),
            } => {
                let out = [u, v, w, r, g, b, pdf, wr, wg, wb, slot];
                self.run::<Samples, 11>(&XI, xi, &SAMPLE, out)
            }
            SampleColumns {
                wi: Some([u, v, w]),
                value: None,
                pdf: Some(pdf),
                weight: Some([wr, wg, wb]),
                slot: None,
            } => {
                let out = [u, v, w, pdf, wr, wg, wb];
                self.run::<Weights, 7>(&XI, xi, &SAMPLE_WEIGHT, out)
            }
            out => {
                check_lengths3(xi[0].len(), XI, xi)?;
                let mut out = out.columns(xi[0].len(), SAMPLE)?;
                clean_upper_halves();
                let row = AtBsdf::<M, SomeSamples>::new(&self.prepared);
                self.level.run_rows(row, xi, &mut out);
                Ok(())
            }
        }
    }

    #[inline(always)]
    fn run<'a, K, const N: usize>(
        &self,
        in_names: &[&'static str; 3],
        inputs: [&'a [f32]; 3],
        out_names: &[&'static str; N],
        outputs: [&'a mut [f32]; N],
    ) -> Result<(), LengthError>
    where
        for<'b> AtBsdf<'b, M, K>: Row<3, N>,
    {
        clean_upper_halves();
        let columns = check_columns(in_names, inputs, out_names, outputs)?;
        let row = AtBsdf::<M, K>::new(&self.prepared);
        self.level.run_columns(row, &columns);
        Ok(())
    }
}
