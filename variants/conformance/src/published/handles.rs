//! Handles of any model of the family, with the names of those of [`hairis`]: the tests are compiled once, and these calls once
//! per model.

use crate::erased::{Direction, ErasedBsdf, ErasedBsdf8};
use hairis::model::{LobeEval, LobeEval8};
use hairis::simd::{Level, f32x8};
use hairis::{
    Conserving, Eval, Eval8, HairParams, Hit, Hit8, LobeMask, PerLobe, Sample, Sample8, Vec3x8,
};

/// A model of the family.
pub(super) trait AnyModel {
    fn prepare(&self, params: &HairParams, hit: Hit) -> Box<dyn ErasedBsdf>;
    fn prepare8(&self, params: &HairParams, level: Level, hits: Hit8) -> Box<dyn ErasedBsdf8>;
    fn prepare_packed(
        &self,
        params: [&HairParams; 8],
        level: Level,
        hits: Hit8,
    ) -> Box<dyn ErasedBsdf8>;
    /// The constants of a shading point, by the function for one lane and by that for lanes.
    fn constants(&self, params: &HairParams, hit: Hit) -> [String; 2];
    /// Albedo of hair that conserves energy.
    fn conserving_albedo(&self, params: &HairParams, hit: Hit) -> PerLobe<[f32; 3]>;
    fn max_albedo(&self, params: &HairParams) -> f32;
    fn conserving_scale(&self, params: &HairParams) -> f32;
}

impl<M: hairis::model::Model<Params = HairParams> + 'static> AnyModel for M {
    fn prepare(&self, params: &HairParams, hit: Hit) -> Box<dyn ErasedBsdf> {
        Box::new(hairis::Material::new(self, params).prepare(hit))
    }

    fn prepare8(&self, params: &HairParams, level: Level, hits: Hit8) -> Box<dyn ErasedBsdf8> {
        Box::new(hairis::Material::new(self, params).prepare8_at(level, hits))
    }

    fn prepare_packed(
        &self,
        params: [&HairParams; 8],
        level: Level,
        hits: Hit8,
    ) -> Box<dyn ErasedBsdf8> {
        let materials = params.map(|params| hairis::Material::new(self, params));
        Box::new(hairis::Material8::pack(materials.each_ref()).prepare8_at(level, hits))
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
        hairis::Material::new(self, params).max_albedo()
    }

    fn conserving_scale(&self, params: &HairParams) -> f32 {
        hairis::Material::new(self, params).conserving_scale()
    }
}

/// A material.
#[derive(Clone, Copy)]
pub(super) struct Material<'a> {
    model: &'a dyn AnyModel,
    pub(super) params: HairParams,
}

impl<'a> Material<'a> {
    pub(super) fn new(model: &'a dyn AnyModel, params: &HairParams) -> Self {
        Self {
            model,
            params: *params,
        }
    }

    pub(super) fn prepare(&self, hit: impl Into<Hit>) -> Bsdf {
        Bsdf(self.model.prepare(&self.params, hit.into()))
    }

    pub(super) fn prepare8_at(&self, level: Level, hits: impl Into<Hit8>) -> Bsdf8 {
        Bsdf8(self.model.prepare8(&self.params, level, hits.into()))
    }

    /// Eight hits on eight materials of one model.
    pub(super) fn prepare_packed(
        materials: [&Self; 8],
        level: Level,
        hits: impl Into<Hit8>,
    ) -> Bsdf8 {
        Bsdf8(materials[0].model.prepare_packed(
            materials.map(|material| &material.params),
            level,
            hits.into(),
        ))
    }

    pub(super) fn max_albedo(&self) -> f32 {
        self.model.max_albedo(&self.params)
    }

    pub(super) fn conserving_scale(&self) -> f32 {
        self.model.conserving_scale(&self.params)
    }
}

/// A shading point.
#[derive(Debug)]
pub(super) struct Bsdf(Box<dyn ErasedBsdf>);

impl Bsdf {
    pub(super) fn eval_pdf(&self, wi: impl Into<Direction>) -> Eval {
        self.0.eval(wi.into())
    }

    pub(super) fn eval(&self, wi: impl Into<Direction>) -> [f32; 3] {
        self.0.value(wi.into())
    }

    pub(super) fn pdf(&self, wi: impl Into<Direction>) -> f32 {
        self.0.pdf(wi.into())
    }

    pub(super) fn eval_pdf8_at(&self, level: Level, wi: &Vec3x8) -> Eval8 {
        self.0.eval8(level, wi)
    }

    pub(super) fn lobes(&self, wi: impl Into<Direction>) -> PerLobe<LobeEval> {
        self.0.lobes(wi.into())
    }

    pub(super) fn lobes8_at(&self, level: Level, wi: &Vec3x8) -> PerLobe<LobeEval8> {
        self.0.lobes8(level, wi)
    }

    pub(super) fn lobes8(&self, wi: &Vec3x8) -> PerLobe<LobeEval8> {
        self.lobes8_at(Level::detect(), wi)
    }

    pub(super) fn sample(&self, xi: [f32; 3]) -> Option<Sample> {
        self.0.sample(xi)
    }

    pub(super) fn sample8_at(&self, level: Level, xi: &[f32x8; 3]) -> Sample8 {
        self.0.sample8(level, xi)
    }

    pub(super) fn albedo(&self) -> PerLobe<[f32; 3]> {
        self.0.albedo()
    }

    pub(super) fn with_lobes(&self, lobes: LobeMask) -> Self {
        Self(self.0.with_lobes(lobes))
    }
}

/// Eight shading points.
#[derive(Debug)]
pub(super) struct Bsdf8(Box<dyn ErasedBsdf8>);

impl Bsdf8 {
    pub(super) fn eval_pdf8_at(&self, level: Level, wi: &Vec3x8) -> Eval8 {
        self.0.eval(level, wi)
    }

    pub(super) fn lobes8(&self, wi: &Vec3x8) -> PerLobe<LobeEval8> {
        self.0.lobes(wi)
    }

    pub(super) fn sample8_at(&self, level: Level, xi: &[f32x8; 3]) -> Sample8 {
        self.0.sample(level, xi)
    }

    pub(super) fn albedo8_at(&self, level: Level) -> PerLobe<[f32x8; 3]> {
        self.0.albedo(level)
    }

    pub(super) fn conserving_at(&self, level: Level) -> Self {
        Self(self.0.conserving(level))
    }

    pub(super) fn with_lobes(&self, lobes: LobeMask) -> Self {
        Self(self.0.with_lobes(lobes))
    }

    pub(super) fn lane(&self, lane: usize) -> Bsdf {
        Bsdf(self.0.lane(lane))
    }
}
