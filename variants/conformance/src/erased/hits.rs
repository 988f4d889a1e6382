//! Slices of hits of any model.

use super::{MaterialSet, Set, Which};
use crate::subject::Subject;
use hairis::{EvalColumns, HitSlices, HitsError, Level, MaterialTable, SampleColumns};

/// The columns of a call that are asked for.
#[derive(Debug)]
pub enum Columns<'a> {
    /// Columns of an evaluation.
    Eval(EvalColumns<'a>),
    /// Columns of a sample.
    Sample(SampleColumns<'a>),
}

/// A [`Subject`] whose slices of hits are tested: pass a reference to any subject.
pub trait HitsSubject: Sync {
    /// Everyday materials and extremes.
    #[doc(hidden)]
    fn hits(&self) -> Box<dyn HitsSet + '_>;
}

impl<S: Subject> HitsSubject for S {
    fn hits(&self) -> Box<dyn HitsSet + '_> {
        Box::new(Set::new(self, Which::WithExtremes))
    }
}

/// Materials of one model, and its slices of hits.
pub trait HitsSet: MaterialSet {
    fn call(
        &self,
        of: HitMaterials<'_>,
        level: Level,
        hits: HitSlices<'_>,
        inputs: [&[f32]; 3],
        out: Columns<'_>,
    ) -> Result<(), HitsError>;
    /// One material per hit, on the level that is found.
    fn eval_at_default(
        &self,
        index: &[u32],
        hits: HitSlices<'_>,
        wi: [&[f32]; 3],
        out: EvalColumns<'_>,
    ) -> Result<(), HitsError>;
}

/// Materials of the hits.
#[derive(Clone, Copy, Debug)]
pub enum HitMaterials<'a> {
    /// One, by its index.
    Shared(usize),
    /// One per hit.
    PerHit(&'a [u32]),
}

impl<S: Subject> HitsSet for Set<'_, S> {
    fn call(
        &self,
        of: HitMaterials<'_>,
        level: Level,
        hits: HitSlices<'_>,
        inputs: [&[f32]; 3],
        out: Columns<'_>,
    ) -> Result<(), HitsError> {
        let table = |index| MaterialTable { materials: &self.bsdfs, index };
        match (of, out) {
            (HitMaterials::Shared(i), Columns::Eval(out)) => {
                Ok(self.bsdfs[i].eval_pdf_hits_at(level, hits, inputs, out)?)
            }
            (HitMaterials::Shared(i), Columns::Sample(out)) => {
                Ok(self.bsdfs[i].sample_hits_at(level, hits, inputs, out)?)
            }
            (HitMaterials::PerHit(index), Columns::Eval(out)) => {
                table(index).eval_pdf_hits_at(level, hits, inputs, out)
            }
            (HitMaterials::PerHit(index), Columns::Sample(out)) => {
                table(index).sample_hits_at(level, hits, inputs, out)
            }
        }
    }

    fn eval_at_default(
        &self,
        index: &[u32],
        hits: HitSlices<'_>,
        wi: [&[f32]; 3],
        out: EvalColumns<'_>,
    ) -> Result<(), HitsError> {
        MaterialTable { materials: &self.bsdfs, index }.eval_pdf_hits(hits, wi, out)
    }
}
