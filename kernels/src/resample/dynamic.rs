//! Resampling with a BSDF of a type that is known, or chosen at run time.

use super::{CandidateColumns, Counts, Partition, WeightColumns, candidate_columns, weigh_evals};
use crate::columns::{EvalColumns, LengthError, SampleColumns, WI, XI, check_lengths3};
use crate::handle::Bsdf;
use crate::model::{DynBsdf, Model};

/// BSDF that proposes and weighs candidates for a [`Pool`](super::Pool).
///
/// A [`Bsdf`] has a kernel of either call. Objects of a model that is chosen at run time, [`DynBsdf`], have the same bits from samples
/// and evaluations: a host of many models then compiles no further kernel of each, and proposes in half as much time again.
pub trait Resample {
    /// Draws the BSDF's candidates: see [`Bsdf::propose_columns`].
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the columns differ in length.
    fn propose_columns(&self, xi: [&[f32]; 3], wi: [&mut [f32]; 3]) -> Result<(), LengthError>;

    /// Computes contributions and weights of candidates: see [`Bsdf::weigh_columns`].
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the columns differ in length.
    fn weigh_columns(
        &self,
        candidates: CandidateColumns<'_>,
        counts: Counts,
        partition: Partition,
        out: WeightColumns<'_>,
    ) -> Result<(), LengthError>;
}

impl<M: Model> Resample for Bsdf<M> {
    #[inline]
    fn propose_columns(&self, xi: [&[f32]; 3], wi: [&mut [f32]; 3]) -> Result<(), LengthError> {
        self.propose_columns(xi, wi)
    }

    #[inline]
    fn weigh_columns(
        &self,
        candidates: CandidateColumns<'_>,
        counts: Counts,
        partition: Partition,
        out: WeightColumns<'_>,
    ) -> Result<(), LengthError> {
        self.weigh_columns(candidates, counts, partition, out)
    }
}

/// Number of candidates whose densities or evaluations are kept at a time.
const CHUNK: usize = 64;

/// Returns the entries from `at` on, at most a chunk of them.
fn chunk(column: &[f32], at: usize) -> &[f32] {
    let rest = column.get(at..).unwrap_or_default();
    rest.get(..CHUNK).unwrap_or(rest)
}

/// Returns the entries from `at` on, at most a chunk of them.
fn chunk_mut(column: &mut [f32], at: usize) -> &mut [f32] {
    let end = column.len().min(at + CHUNK);
    column.get_mut(at..end).unwrap_or_default()
}

impl Resample for dyn DynBsdf + '_ {
    #[inline]
    fn propose_columns(&self, xi: [&[f32]; 3], mut wi: [&mut [f32]; 3]) -> Result<(), LengthError> {
        let len = xi[0].len();
        check_lengths3(len, XI, xi)?;
        check_lengths3(len, WI, wi.each_ref().map(|column| &**column))?;
        let mut densities = [0.0; CHUNK];
        for at in (0..len).step_by(CHUNK) {
            let mut wi = wi.each_mut().map(|column| chunk_mut(column, at));
            let pdf = chunk_mut(&mut densities, 0);
            let pdf = pdf.get_mut(..wi[0].len()).unwrap_or_default();
            let out = SampleColumns {
                wi: Some(wi.each_mut().map(|column| &mut **column)),
                pdf: Some(&mut *pdf),
                ..SampleColumns::default()
            };
            self.sample_columns(xi.map(|column| chunk(column, at)), out)?;
            // Compared by bits, as integers: see `Material::prepare`.
            for column in wi {
                for (x, _) in column
                    .iter_mut()
                    .zip(&*pdf)
                    .filter(|(_, pdf)| pdf.to_bits() == 0)
                {
                    *x = 0.0;
                }
            }
        }
        Ok(())
    }

    #[inline]
    fn weigh_columns(
        &self,
        candidates: CandidateColumns<'_>,
        counts: Counts,
        partition: Partition,
        out: WeightColumns<'_>,
    ) -> Result<(), LengthError> {
        let WeightColumns {
            mut contribution,
            weight,
        } = out;
        candidate_columns(
            candidates,
            WeightColumns {
                contribution: contribution.each_mut().map(|column| &mut **column),
                weight: &mut *weight,
            },
        )?;
        let mut kept = [[0.0; CHUNK]; 4];
        for at in (0..weight.len()).step_by(CHUNK) {
            let part = CandidateColumns {
                wi: candidates.wi.map(|column| chunk(column, at)),
                radiance: candidates.radiance.map(|column| chunk(column, at)),
                pdf_light: chunk(candidates.pdf_light, at),
            };
            let len = part.pdf_light.len();
            let mut evals = kept
                .each_mut()
                .map(|column| column.get_mut(..len).unwrap_or_default());
            let [r, g, b, pdf] = evals.each_mut().map(|column| &mut **column);
            let values = EvalColumns {
                value: Some([r, g, b]),
                pdf: Some(pdf),
            };
            self.eval_columns(part.wi, values)?;
            let out = WeightColumns {
                contribution: contribution.each_mut().map(|column| chunk_mut(column, at)),
                weight: chunk_mut(weight, at),
            };
            let evals = evals.each_ref().map(|column| &**column);
            weigh_evals(self.level(), evals, part, counts, partition, out)?;
        }
        Ok(())
    }
}
