//! Slices of hits of any model, without its types.

use super::{MaterialSet, Set, Which};
use crate::subject::Subject;
use hairis::Material;
use hairis::columns::{EvalColumns, HitColumns, HitsError, MaterialTable, SampleColumns};
use hairis::simd::Level;

/// Requested columns of a call.
#[derive(Debug)]
pub(crate) enum Columns<'a> {
    /// Columns of an evaluation.
    Eval(EvalColumns<'a>),
    /// Columns of a sample.
    Sample(SampleColumns<'a>),
    /// Columns of an evaluation and a sample in one call.
    Both(EvalColumns<'a>, SampleColumns<'a>),
}

/// [`Subject`] whose slices of hits are tested. Every subject implements it, so pass a reference to any subject.
///
/// This trait is separate from [`ErasedSubject`](super::ErasedSubject), so that slices of hits are compiled only for subjects that are
/// tested on them.
pub trait HitsSubject {
    /// Returns everyday materials and extremes.
    #[doc(hidden)]
    fn hits(&self) -> Box<dyn HitsSet + '_>;
}

impl<S: Subject> HitsSubject for S {
    fn hits(&self) -> Box<dyn HitsSet + '_> {
        Box::new(Set::new(self, Which::WithExtremes))
    }
}

/// Arguments of a call on slices of hits.
#[derive(Debug)]
pub struct HitsCall<'a> {
    pub(crate) hits: HitColumns<'a>,
    /// Directions towards the light.
    pub(crate) wi: [&'a [f32]; 3],
    /// Uniform numbers.
    pub(crate) xi: [&'a [f32]; 3],
    pub(crate) out: Columns<'a>,
}

/// Outcome of a call: an error if lengths differ, or if an index is beyond the table.
type HitsResult = Result<(), HitsError>;

/// Materials of one model, with calls on slices of hits.
pub trait HitsSet: MaterialSet {
    fn call(&self, of: HitMaterials<'_>, level: Level, call: HitsCall<'_>) -> HitsResult;
    /// Evaluates hits of one material each on the detected level.
    fn eval_each(
        &self,
        index: &[u32],
        hits: HitColumns<'_>,
        wi: [&[f32]; 3],
        out: EvalColumns<'_>,
    ) -> HitsResult;
}

/// Assignment of materials to hits.
#[derive(Clone, Copy, Debug)]
pub enum HitMaterials<'a> {
    /// One material for all hits, by its index.
    Shared(usize),
    /// One material per hit, by index.
    PerHit(&'a [u32]),
}

impl<S: Subject> HitsSet for Set<'_, S> {
    fn call(&self, of: HitMaterials<'_>, level: Level, call: HitsCall<'_>) -> HitsResult {
        let HitsCall { hits, wi, xi, out } = call;
        match of {
            HitMaterials::Shared(index) => {
                let material = self.materials[index].with_level(level);
                Ok(match out {
                    Columns::Eval(out) => material.eval_hits(hits, wi, out),
                    Columns::Sample(out) => material.sample_hits(hits, xi, out),
                    Columns::Both(evals, samples) => {
                        material.eval_sample_hits(hits, wi, evals, xi, samples)
                    }
                }?)
            }
            HitMaterials::PerHit(index) => {
                let on_level = |material: &Material<S::Model>| material.with_level(level);
                let materials: Vec<_> = self.materials.iter().map(on_level).collect();
                let table = MaterialTable {
                    materials: &materials,
                    index,
                };
                match out {
                    Columns::Eval(out) => table.eval_hits(hits, wi, out),
                    Columns::Sample(out) => table.sample_hits(hits, xi, out),
                    Columns::Both(evals, samples) => {
                        table.eval_sample_hits(hits, wi, evals, xi, samples)
                    }
                }
            }
        }
    }

    fn eval_each(
        &self,
        index: &[u32],
        hits: HitColumns<'_>,
        wi: [&[f32]; 3],
        out: EvalColumns<'_>,
    ) -> HitsResult {
        MaterialTable {
            materials: &self.materials,
            index,
        }
        .eval_hits(hits, wi, out)
    }
}
