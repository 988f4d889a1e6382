//! Handles of any model of the family, with the names of the handles of [`hairis`]. The tests are compiled once, and these calls once per
//! model.

use crate::erased::{ErasedBsdf, ErasedBsdf8};
use glam::Vec3;
use hairis::model::{DynBsdf, LobeEval, LobeEval8, Model};
use hairis::simd::{Level, f32x8};
use hairis::{Conserving, HairParams, Hit, Hit8, LobeMask, PerLobe, Sample8, Vec3x8};

/// Model of the family, without its types.
pub(super) trait AnyModel {
    fn prepare(&self, params: &HairParams, hit: Hit) -> Box<dyn ErasedBsdf>;
    fn prepare8(&self, params: &HairParams, level: Level, hits: &Hit8) -> Box<dyn ErasedBsdf8>;
    /// Returns the constants of a shading point, by the function for one lane and by the function for lanes.
    fn constants(&self, params: &HairParams, hit: Hit) -> [String; 2];
    /// Returns the albedo of hair that conserves energy.
    fn conserving_albedo(&self, params: &HairParams, hit: Hit) -> PerLobe<[f32; 3]>;
    fn max_albedo(&self, params: &HairParams) -> f32;
    fn conserving_scale(&self, params: &HairParams) -> f32;
}

/// Makes a material with the types of [`Conserving`], but without its limit. Packages that list the models have compiled these types
/// already.
fn material<M: Model<Params = HairParams>>(
    model: &M,
    params: &HairParams,
) -> hairis::Material<Conserving<M>> {
    hairis::Material::new(model, params).into()
}

impl<M: Model<Params = HairParams> + 'static> AnyModel for M {
    fn prepare(&self, params: &HairParams, hit: Hit) -> Box<dyn ErasedBsdf> {
        Box::new(material(self, params).prepare(hit))
    }

    fn prepare8(&self, params: &HairParams, level: Level, hits: &Hit8) -> Box<dyn ErasedBsdf8> {
        Box::new(material(self, params).with_level(level).prepare8(hits))
    }

    fn constants(&self, params: &HairParams, hit: Hit) -> [String; 2] {
        let material = self.material(params);
        [
            format!("{:?}", M::prepare_one(&material, hit)),
            format!("{:?}", M::prepare::<f32, f32>(&material, hit)),
        ]
    }

    fn conserving_albedo(&self, params: &HairParams, hit: Hit) -> PerLobe<[f32; 3]> {
        hairis::Material::new(&Conserving(*self), params)
            .prepare(hit)
            .albedo()
    }

    fn max_albedo(&self, params: &HairParams) -> f32 {
        material(self, params).max_albedo()
    }

    fn conserving_scale(&self, params: &HairParams) -> f32 {
        material(self, params).conserving_scale()
    }
}

/// Sampler under comparison, with the few calls that such tests make.
pub(super) trait Sampler {
    fn prepare(&self, params: &HairParams, wo: Vec3, lobes: LobeMask) -> Box<dyn Sampling>;
}

/// Shading point of a [`Sampler`].
pub(super) trait Sampling {
    fn lobes(&self, wi: Vec3) -> PerLobe<LobeEval>;
    fn lobes8(&self, wi: &Vec3x8) -> PerLobe<LobeEval8>;
    fn albedo(&self) -> PerLobe<[f32; 3]>;
    fn sample8(&self, xi: &[f32x8; 3]) -> Sample8;
}

impl<M: Model<Params = HairParams> + 'static> Sampler for M {
    fn prepare(&self, params: &HairParams, wo: Vec3, lobes: LobeMask) -> Box<dyn Sampling> {
        Box::new(material(self, params).prepare(wo).with_lobes(lobes))
    }
}

impl<M: Model> Sampling for hairis::Bsdf<M> {
    fn lobes(&self, wi: Vec3) -> PerLobe<LobeEval> {
        DynBsdf::lobes(self, wi)
    }

    fn lobes8(&self, wi: &Vec3x8) -> PerLobe<LobeEval8> {
        DynBsdf::lobes8(self, wi)
    }

    fn albedo(&self) -> PerLobe<[f32; 3]> {
        DynBsdf::albedo(self)
    }

    fn sample8(&self, xi: &[f32x8; 3]) -> Sample8 {
        DynBsdf::sample8(self, xi)
    }
}

/// Parameters with a model of the family, as [`hairis::Material`] has them.
#[derive(Clone, Copy)]
pub(super) struct Material<'a> {
    model: &'a dyn AnyModel,
    pub(super) params: HairParams,
    level: Level,
}

impl<'a> Material<'a> {
    pub(super) fn new(model: &'a dyn AnyModel, params: &HairParams) -> Self {
        Self {
            model,
            params: *params,
            level: Level::detect(),
        }
    }

    pub(super) fn prepare(&self, hit: impl Into<Hit>) -> Bsdf {
        self.model.prepare(&self.params, hit.into())
    }

    pub(super) fn with_level(mut self, level: Level) -> Self {
        self.level = level;
        self
    }

    pub(super) fn prepare8(&self, hits: impl Into<Hit8>) -> Box<dyn ErasedBsdf8> {
        self.model.prepare8(&self.params, self.level, &hits.into())
    }

    pub(super) fn max_albedo(&self) -> f32 {
        self.model.max_albedo(&self.params)
    }

    pub(super) fn conserving_scale(&self) -> f32 {
        self.model.conserving_scale(&self.params)
    }
}

/// Shading point of any model of the family.
pub(super) type Bsdf = Box<dyn ErasedBsdf>;
