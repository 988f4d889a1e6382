//! Shading points of any model that weigh candidates.

use super::{ErasedBsdf, MaterialSet, Set, Which};
use crate::subject::Subject;
use hairis::model::Model;
use hairis::resample::{Counts, Partition, Pool, Weighed8};
use hairis::simd::{Level, f32x8};
use hairis::{Bsdf, Bsdf8, Hit, Hit8, Vec3x8};

/// A [`Subject`] under light: pass a reference to any subject.
///
/// A trait apart, as [`HitsSubject`](super::hits::HitsSubject).
pub trait LitSubject: Sync {
    /// Everyday materials.
    #[doc(hidden)]
    fn lit(&self) -> Box<dyn LitSet + '_>;
}

impl<S: Subject> LitSubject for S {
    fn lit(&self) -> Box<dyn LitSet + '_> {
        Box::new(Set::new(self, Which::Everyday))
    }
}

/// Materials whose shading points weigh candidates.
pub trait LitSet: MaterialSet {
    fn lit(&self, index: usize, hit: Hit) -> Box<dyn LitBsdf>;
    fn lit8(&self, index: usize, level: Level, hits: Hit8) -> Box<dyn LitBsdf8>;
}

impl<S: Subject> LitSet for Set<'_, S> {
    fn lit(&self, index: usize, hit: Hit) -> Box<dyn LitBsdf> {
        Box::new(self.materials[index].prepare(hit))
    }

    fn lit8(&self, index: usize, level: Level, hits: Hit8) -> Box<dyn LitBsdf8> {
        Box::new(self.materials[index].prepare8_at(level, hits))
    }
}

/// A shading point that weighs a pool of candidates.
pub trait LitBsdf: ErasedBsdf {
    fn propose(&self, pool: &mut Pool<16>, xi: [&[f32]; 3]);
    fn weigh(&self, pool: &mut Pool<16>);
}

impl<M: Model + 'static> LitBsdf for Bsdf<M> {
    fn propose(&self, pool: &mut Pool<16>, xi: [&[f32]; 3]) {
        pool.propose(self, xi).expect("of one length");
    }

    fn weigh(&self, pool: &mut Pool<16>) {
        pool.weigh(self);
    }
}

/// Eight shading points that weigh a candidate each.
pub trait LitBsdf8 {
    fn propose(&self, level: Level, xi: &[f32x8; 3]) -> Vec3x8;
    fn weigh(
        &self,
        level: Level,
        wi: &Vec3x8,
        radiance: &[f32x8; 3],
        pdf: &f32x8,
        counts: Counts,
    ) -> Weighed8;
}

impl<M: Model + 'static> LitBsdf8 for Bsdf8<M> {
    fn propose(&self, level: Level, xi: &[f32x8; 3]) -> Vec3x8 {
        self.propose8_at(level, xi)
    }

    fn weigh(
        &self,
        level: Level,
        wi: &Vec3x8,
        radiance: &[f32x8; 3],
        pdf: &f32x8,
        counts: Counts,
    ) -> Weighed8 {
        self.weigh8_at(level, wi, radiance, pdf, counts, Partition::All)
    }
}
