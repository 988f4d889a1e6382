//! Handles of a model that is chosen at run time: object-safe traits, which the handle of every model implements.
//!
//! Each call is compiled once per model, and dispatch costs one jump. Calls of resampling are not among them, because they follow from
//! those that are: see [`Resample`](crate::resample::Resample). Scalar calls take a `Vec3`, because a `Vec3x` by value would
//! cost 8 to 15 ns.

use super::{Bsdf, Bsdf8};
use crate::columns::{EvalColumns, LengthError, SampleColumns};
use crate::frame::Vec3x8;
use crate::model::{Eval, Eval8, LobeEval, LobeEval8, LobeMask, Model, PerLobe, Sample, Sample8};
use crate::simd::{Level, Vec3x, f32x8};
use core::fmt::Debug;
use glam::Vec3;

/// Object-safe interface of the [`Bsdf`] of any model.
///
/// ```
/// use hairis::model::DynBsdf;
/// use hairis::{Gaussian, HairParams, Matched, Material, Published};
/// let (wo, brown) = (glam::Vec3::Y, HairParams::brown());
/// let one = Material::new(&Published(Gaussian), &brown).prepare(wo);
/// let other = Material::new(&Matched::new(Gaussian), &brown).prepare(wo);
/// let chosen: [&dyn DynBsdf; 2] = [&one, &other];
/// assert_eq!(chosen[0].eval_pdf(wo).value, chosen[1].eval_pdf(wo).value);
/// ```
pub trait DynBsdf: Debug + Send + Sync {
    /// Evaluates S and the density at `wi`: see [`Bsdf::eval_pdf`].
    fn eval_pdf(&self, wi: Vec3) -> Eval;

    /// Evaluates S at `wi`: see [`Bsdf::eval`].
    #[inline]
    fn eval(&self, wi: Vec3) -> [f32; 3] {
        self.eval_pdf(wi).value
    }

    /// Returns the density of sampling `wi`: see [`Bsdf::pdf`].
    #[inline]
    fn pdf(&self, wi: Vec3) -> f32 {
        self.eval_pdf(wi).pdf
    }

    /// Evaluates each lobe at `wi`: see [`Bsdf::lobes`].
    fn lobes(&self, wi: Vec3) -> PerLobe<LobeEval>;

    /// Draws a direction: see [`Bsdf::sample`].
    fn sample(&self, xi: [f32; 3]) -> Option<Sample>;

    /// Evaluates S and the density of eight directions: see [`Bsdf::eval_pdf8`].
    fn eval_pdf8(&self, wi: &Vec3x8) -> Eval8;

    /// Evaluates each lobe at eight directions: see [`Bsdf::lobes8`].
    fn lobes8(&self, wi: &Vec3x8) -> PerLobe<LobeEval8>;

    /// Draws eight directions: see [`Bsdf::sample8`].
    fn sample8(&self, xi: &[f32x8; 3]) -> Sample8;

    /// Evaluates S and the density of many directions: see [`Bsdf::eval_columns`].
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the columns differ in length.
    fn eval_columns(&self, wi: [&[f32]; 3], out: EvalColumns<'_>) -> Result<(), LengthError>;

    /// Draws many samples: see [`Bsdf::sample_columns`].
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the columns differ in length.
    fn sample_columns(&self, xi: [&[f32]; 3], out: SampleColumns<'_>) -> Result<(), LengthError>;

    /// Returns the directional albedo of each lobe: see [`Bsdf::albedo`].
    fn albedo(&self) -> PerLobe<[f32; 3]>;

    /// Restricts the BSDF to some of its lobes: see [`Bsdf::with_lobes`].
    fn set_lobes(&mut self, lobes: LobeMask);

    /// Scales the BSDF so that it returns no more light than arrives: see [`Bsdf::conserving`].
    fn set_conserving(&mut self);

    /// Returns the instruction set of calls of eight lanes and on columns: see [`Bsdf::level`].
    fn level(&self) -> Level;

    /// Selects another instruction set: see [`Bsdf::with_level`].
    fn set_level(&mut self, level: Level);
}

/// Object-safe interface of the [`Bsdf8`] of any model.
pub trait DynBsdf8: Debug + Send + Sync {
    /// Evaluates S and the density at `wi`, each lane at its own hit: see [`Bsdf8::eval_pdf8`].
    fn eval_pdf8(&self, wi: &Vec3x8) -> Eval8;

    /// Evaluates each lobe at `wi`, each lane at its own hit: see [`Bsdf8::lobes8`].
    fn lobes8(&self, wi: &Vec3x8) -> PerLobe<LobeEval8>;

    /// Draws one direction for each hit: see [`Bsdf8::sample8`].
    fn sample8(&self, xi: &[f32x8; 3]) -> Sample8;

    /// Returns the directional albedos of the eight hits: see [`Bsdf8::albedo8`].
    fn albedo8(&self) -> PerLobe<[f32x8; 3]>;

    /// Restricts the BSDFs to some of their lobes: see [`Bsdf8::with_lobes`].
    fn set_lobes(&mut self, lobes: LobeMask);

    /// Scales the BSDFs so that they return no more light than arrives: see [`Bsdf8::conserving`].
    fn set_conserving(&mut self);

    /// Selects another instruction set: see [`Bsdf8::with_level`].
    fn set_level(&mut self, level: Level);
}

/// Methods of a trait that call the method of the same name of the handle.
macro_rules! forward {
    ($handle:ident: $($(#[$attribute:meta])* $method:ident($($arg:ident: $type:ty),*) $(-> $out:ty)?;)*) => { $(
        #[inline]
        fn $method(&self $(, $arg: $type)*) $(-> $out)? {
            $handle::$method(self $(, $arg)*)
        }
    )* };
}

/// Methods of a trait that change a handle like its `with_` methods do.
macro_rules! set {
    ($($method:ident($($arg:ident: $type:ty)?) = $with:ident;)*) => { $(
        #[inline]
        fn $method(&mut self $(, $arg: $type)?) {
            *self = self.$with($($arg)?);
        }
    )* };
}

impl<M: Model> DynBsdf for Bsdf<M> {
    // Not the handle's methods, which in debug builds reject a `wi` that is not of unit length: tests of totality call these
    // methods.
    #[inline]
    fn eval_pdf(&self, wi: Vec3) -> Eval {
        M::eval::<f32, f32>(&self.prepared, Vec3x::from(wi).alone())
    }

    #[inline]
    fn lobes(&self, wi: Vec3) -> PerLobe<LobeEval> {
        M::lobes::<f32, f32>(&self.prepared, Vec3x::from(wi).alone())
    }

    forward! { Bsdf:
        sample(xi: [f32; 3]) -> Option<Sample>;
        eval_pdf8(wi: &Vec3x8) -> Eval8;
        lobes8(wi: &Vec3x8) -> PerLobe<LobeEval8>;
        sample8(xi: &[f32x8; 3]) -> Sample8;
        eval_columns(wi: [&[f32]; 3], out: EvalColumns<'_>) -> Result<(), LengthError>;
        sample_columns(xi: [&[f32]; 3], out: SampleColumns<'_>) -> Result<(), LengthError>;
        albedo() -> PerLobe<[f32; 3]>;
        level() -> Level;
    }
    set! {
        set_lobes(lobes: LobeMask) = with_lobes;
        set_conserving() = conserving;
        set_level(level: Level) = with_level;
    }
}

impl<M: Model> DynBsdf8 for Bsdf8<M> {
    forward! { Bsdf8:
        eval_pdf8(wi: &Vec3x8) -> Eval8;
        lobes8(wi: &Vec3x8) -> PerLobe<LobeEval8>;
        sample8(xi: &[f32x8; 3]) -> Sample8;
        albedo8() -> PerLobe<[f32x8; 3]>;
    }
    set! {
        set_lobes(lobes: LobeMask) = with_lobes;
        set_conserving() = conserving;
        set_level(level: Level) = with_level;
    }
}
