//! Subjects, materials and shading points without their types.
//!
//! Properties take these, so that each is compiled once; the calls below are compiled once per model.

pub(crate) mod hits;
pub(crate) mod light;

use crate::subject::{Claims, ParamsOf, Reference, Subject};
use core::fmt;
use hairis::columns::{EvalSlices, LengthError, SampleSlices, SampleWeightSlices};
use hairis::model::{LobeEval, LobeEval8, Model};
use hairis::simd::{Level, Vec3x, f32x8};
use hairis::{
    Bsdf, Bsdf8, Eval, Eval8, Hit, Hit8, Lobe, LobeMask, Material, Material8, PerLobe, Sample,
    Sample8, Vec3x8,
};

/// A direction, or any vector, in the fibre's frame.
pub(crate) type Direction = Vec3x<f32>;

/// A [`Subject`] without its model's type: pass a reference to any subject.
pub trait ErasedSubject: Sync {
    /// See [`Subject::claims`].
    #[doc(hidden)]
    fn claims(&self) -> Claims;
    /// Number of the model's lobes.
    #[doc(hidden)]
    fn lobe_count(&self) -> usize;
    #[doc(hidden)]
    fn set(&self, which: Which) -> Box<dyn MaterialSet + '_>;
}

/// Materials of a subject.
#[derive(Clone, Copy, Debug)]
pub enum Which {
    /// [`Subject::materials`].
    Everyday,
    /// The same, and [`Subject::extremes`].
    WithExtremes,
    /// The everyday ones, and [`Subject::random_materials`].
    WithRandom,
    /// [`Subject::white`].
    White,
}

impl dyn ErasedSubject + '_ {
    /// The slots that the model names.
    pub(crate) fn slots(&self) -> impl Iterator<Item = Lobe> + use<> {
        Lobe::ALL.into_iter().take(self.lobe_count())
    }

    /// Each lobe alone, and all together.
    pub(crate) fn parts(&self) -> impl Iterator<Item = LobeMask> + use<> {
        self.slots()
            .map(|lobe| LobeMask::of(&[lobe]))
            .chain([LobeMask::ALL])
    }
}

impl<S: Subject> ErasedSubject for S {
    fn claims(&self) -> Claims {
        Subject::claims(self)
    }

    fn lobe_count(&self) -> usize {
        S::Model::LOBES.len()
    }

    fn set(&self, which: Which) -> Box<dyn MaterialSet + '_> {
        Box::new(Set::new(self, which))
    }
}

/// Materials of one model, by index.
pub trait MaterialSet {
    fn len(&self) -> usize;
    fn name(&self, index: usize) -> &'static str;
    fn prepare(&self, index: usize, hit: Hit) -> Box<dyn ErasedBsdf>;
    fn prepare8(&self, index: usize, level: Level, hits: Hit8) -> Box<dyn ErasedBsdf8>;
    fn prepare_packed(&self, index: [usize; 8], level: Level, hits: Hit8) -> Box<dyn ErasedBsdf8>;
    fn edges(&self, index: usize, hit: &Hit) -> [Vec<f64>; 2];
    fn weight_bound(&self, index: usize, hit: &Hit, lobes: LobeMask) -> Option<f64>;
    fn reference(&self, index: usize, hit: &Hit) -> Option<Box<dyn Reference>>;
}

impl dyn MaterialSet + '_ {
    pub(crate) fn iter(&self) -> impl Iterator<Item = NamedMaterial<'_>> {
        (0..self.len()).map(|index| NamedMaterial { set: self, index })
    }
}

/// One material of a set.
#[derive(Clone, Copy)]
pub(crate) struct NamedMaterial<'a> {
    set: &'a dyn MaterialSet,
    index: usize,
}

impl NamedMaterial<'_> {
    pub(crate) fn name(&self) -> &'static str {
        self.set.name(self.index)
    }

    pub(crate) fn prepare(&self, hit: Hit) -> Box<dyn ErasedBsdf> {
        self.set.prepare(self.index, hit)
    }

    pub(crate) fn prepare8(&self, level: Level, hits: Hit8) -> Box<dyn ErasedBsdf8> {
        self.set.prepare8(self.index, level, hits)
    }

    /// Eight hits on eight materials of one set.
    pub(crate) fn prepare_packed(
        materials: [Self; 8],
        level: Level,
        hits: Hit8,
    ) -> Box<dyn ErasedBsdf8> {
        materials[0]
            .set
            .prepare_packed(materials.map(|material| material.index), level, hits)
    }

    pub(crate) fn edges(&self, hit: &Hit) -> [Vec<f64>; 2] {
        self.set.edges(self.index, hit)
    }

    pub(crate) fn weight_bound(&self, hit: &Hit, lobes: LobeMask) -> Option<f64> {
        self.set.weight_bound(self.index, hit, lobes)
    }

    pub(crate) fn reference(&self, hit: &Hit) -> Option<Box<dyn Reference>> {
        self.set.reference(self.index, hit)
    }
}

/// Materials of one model, with its types.
pub(crate) struct Set<'s, S: Subject> {
    subject: &'s S,
    names: Vec<&'static str>,
    params: Vec<ParamsOf<S>>,
    pub(crate) materials: Vec<Material<S::Model>>,
}

impl<'s, S: Subject> Set<'s, S> {
    pub(crate) fn new(subject: &'s S, which: Which) -> Self {
        let mut materials = if matches!(which, Which::White) {
            subject.white()
        } else {
            subject.materials()
        };
        match which {
            Which::Everyday | Which::White => {}
            Which::WithExtremes => materials.extend(subject.extremes()),
            Which::WithRandom => {
                let random = subject.random_materials();
                materials.extend(
                    random
                        .into_iter()
                        .map(|params| ("a random material", params)),
                );
            }
        }
        let (names, params): (Vec<_>, Vec<_>) = materials.into_iter().unzip();
        let materials = params
            .iter()
            .map(|params| Material::new(&subject.model(), params))
            .collect();
        Self {
            subject,
            names,
            params,
            materials,
        }
    }
}

impl<S: Subject> MaterialSet for Set<'_, S> {
    fn len(&self) -> usize {
        self.names.len()
    }

    fn name(&self, index: usize) -> &'static str {
        self.names[index]
    }

    fn prepare(&self, index: usize, hit: Hit) -> Box<dyn ErasedBsdf> {
        Box::new(self.materials[index].prepare(hit))
    }

    fn prepare8(&self, index: usize, level: Level, hits: Hit8) -> Box<dyn ErasedBsdf8> {
        Box::new(self.materials[index].prepare8_at(level, hits))
    }

    fn prepare_packed(&self, index: [usize; 8], level: Level, hits: Hit8) -> Box<dyn ErasedBsdf8> {
        Box::new(Material8::pack(index.map(|i| &self.materials[i])).prepare8_at(level, hits))
    }

    fn edges(&self, index: usize, hit: &Hit) -> [Vec<f64>; 2] {
        self.subject.edges(&self.params[index], hit)
    }

    fn weight_bound(&self, index: usize, hit: &Hit, lobes: LobeMask) -> Option<f64> {
        self.subject.weight_bound(&self.params[index], hit, lobes)
    }

    fn reference(&self, index: usize, hit: &Hit) -> Option<Box<dyn Reference>> {
        self.subject.reference(&self.params[index], hit)
    }
}

/// Columns of a sample in slices: direction, value, density, weight, slot.
pub(crate) const COLUMNS: usize = 11;

/// Places of the columns of [`ErasedBsdf::weight_slices`] among those of [`ErasedBsdf::sample_slices`].
pub(crate) const WEIGHT_COLUMNS: [usize; 7] = [0, 1, 2, 6, 7, 8, 9];

/// Outcome of a call on slices: an error if their lengths differ.
type SliceResult = Result<(), LengthError>;

/// [`Bsdf`] of any model. Without a level, slices run on the one that is found.
pub trait ErasedBsdf: fmt::Debug {
    fn eval(&self, wi: Direction) -> Eval;
    fn value(&self, wi: Direction) -> [f32; 3];
    fn pdf(&self, wi: Direction) -> f32;
    fn eval8(&self, level: Level, wi: &Vec3x8) -> Eval8;
    fn lobes(&self, wi: Direction) -> PerLobe<LobeEval>;
    fn lobes8(&self, level: Level, wi: &Vec3x8) -> PerLobe<LobeEval8>;
    fn sample(&self, xi: [f32; 3]) -> Option<Sample>;
    fn sample8(&self, level: Level, xi: &[f32x8; 3]) -> Sample8;
    fn albedo(&self) -> PerLobe<[f32; 3]>;
    fn with_lobes(&self, lobes: LobeMask) -> Box<dyn ErasedBsdf>;
    fn conserving(&self) -> Box<dyn ErasedBsdf>;
    fn eval_slices(
        &self,
        level: Option<Level>,
        wi: [&[f32]; 3],
        out: [&mut [f32]; 4],
    ) -> SliceResult;
    fn value_slices(&self, level: Level, wi: [&[f32]; 3], out: [&mut [f32]; 3]) -> SliceResult;
    fn pdf_slice(&self, level: Level, wi: [&[f32]; 3], out: &mut [f32]) -> SliceResult;
    fn sample_slices(
        &self,
        level: Option<Level>,
        xi: [&[f32]; 3],
        out: [&mut [f32]; COLUMNS],
    ) -> SliceResult;
    fn weight_slices(
        &self,
        level: Option<Level>,
        xi: [&[f32]; 3],
        out: [&mut [f32]; WEIGHT_COLUMNS.len()],
    ) -> SliceResult;
}

impl<M: Model + 'static> ErasedBsdf for Bsdf<M> {
    fn eval(&self, wi: Direction) -> Eval {
        self.eval_pdf(wi)
    }

    fn value(&self, wi: Direction) -> [f32; 3] {
        self.eval(wi)
    }

    fn pdf(&self, wi: Direction) -> f32 {
        self.pdf(wi)
    }

    fn eval8(&self, level: Level, wi: &Vec3x8) -> Eval8 {
        self.eval_pdf8_at(level, wi)
    }

    fn lobes(&self, wi: Direction) -> PerLobe<LobeEval> {
        self.lobes(wi)
    }

    fn lobes8(&self, level: Level, wi: &Vec3x8) -> PerLobe<LobeEval8> {
        self.lobes8_at(level, wi)
    }

    fn sample(&self, xi: [f32; 3]) -> Option<Sample> {
        self.sample(xi)
    }

    fn sample8(&self, level: Level, xi: &[f32x8; 3]) -> Sample8 {
        self.sample8_at(level, xi)
    }

    fn albedo(&self) -> PerLobe<[f32; 3]> {
        self.albedo()
    }

    fn with_lobes(&self, lobes: LobeMask) -> Box<dyn ErasedBsdf> {
        Box::new(self.with_lobes(lobes))
    }

    fn conserving(&self) -> Box<dyn ErasedBsdf> {
        Box::new(self.conserving())
    }

    fn eval_slices(
        &self,
        level: Option<Level>,
        wi: [&[f32]; 3],
        out: [&mut [f32]; 4],
    ) -> SliceResult {
        let [r, g, b, pdf] = out;
        let out = EvalSlices {
            value: [r, g, b],
            pdf,
        };
        match level {
            Some(level) => self.eval_pdf_batch_at(level, wi, out),
            None => self.eval_pdf_batch(wi, out),
        }
    }

    fn value_slices(&self, level: Level, wi: [&[f32]; 3], out: [&mut [f32]; 3]) -> SliceResult {
        self.eval_batch_at(level, wi, out)
    }

    fn pdf_slice(&self, level: Level, wi: [&[f32]; 3], out: &mut [f32]) -> SliceResult {
        self.pdf_batch_at(level, wi, out)
    }

    fn sample_slices(
        &self,
        level: Option<Level>,
        xi: [&[f32]; 3],
        out: [&mut [f32]; COLUMNS],
    ) -> SliceResult {
        let [u, v, w, r, g, b, pdf, wr, wg, wb, slot] = out;
        let out = SampleSlices {
            wi: [u, v, w],
            value: [r, g, b],
            pdf,
            weight: [wr, wg, wb],
            slot,
        };
        match level {
            Some(level) => self.sample_batch_at(level, xi, out),
            None => self.sample_batch(xi, out),
        }
    }

    fn weight_slices(
        &self,
        level: Option<Level>,
        xi: [&[f32]; 3],
        out: [&mut [f32]; WEIGHT_COLUMNS.len()],
    ) -> SliceResult {
        let [u, v, w, pdf, wr, wg, wb] = out;
        let out = SampleWeightSlices {
            wi: [u, v, w],
            pdf,
            weight: [wr, wg, wb],
        };
        match level {
            Some(level) => self.sample_weight_batch_at(level, xi, out),
            None => self.sample_weight_batch(xi, out),
        }
    }
}

/// [`Bsdf8`] of any model.
pub trait ErasedBsdf8: fmt::Debug {
    fn eval(&self, level: Level, wi: &Vec3x8) -> Eval8;
    fn lobes(&self, wi: &Vec3x8) -> PerLobe<LobeEval8>;
    fn sample(&self, level: Level, xi: &[f32x8; 3]) -> Sample8;
    fn albedo(&self, level: Level) -> PerLobe<[f32x8; 3]>;
    fn with_lobes(&self, lobes: LobeMask) -> Box<dyn ErasedBsdf8>;
    fn conserving(&self, level: Level) -> Box<dyn ErasedBsdf8>;
    fn lane(&self, lane: usize) -> Box<dyn ErasedBsdf>;
}

impl<M: Model + 'static> ErasedBsdf8 for Bsdf8<M> {
    fn eval(&self, level: Level, wi: &Vec3x8) -> Eval8 {
        self.eval_pdf8_at(level, wi)
    }

    fn lobes(&self, wi: &Vec3x8) -> PerLobe<LobeEval8> {
        self.lobes8(wi)
    }

    fn sample(&self, level: Level, xi: &[f32x8; 3]) -> Sample8 {
        self.sample8_at(level, xi)
    }

    fn albedo(&self, level: Level) -> PerLobe<[f32x8; 3]> {
        self.albedo8_at(level)
    }

    fn with_lobes(&self, lobes: LobeMask) -> Box<dyn ErasedBsdf8> {
        Box::new(self.with_lobes(lobes))
    }

    fn conserving(&self, level: Level) -> Box<dyn ErasedBsdf8> {
        Box::new(self.conserving_at(level))
    }

    fn lane(&self, lane: usize) -> Box<dyn ErasedBsdf> {
        Box::new(self.lane(lane))
    }
}
