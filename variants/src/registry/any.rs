//! Public handles of a model that is chosen at run time.
//!
//! Methods that run a kernel are never inlined: each model is compiled once, here, and the choice costs one call and one
//! jump. Scalar methods take a `Vec3`; a `Vec3x` by value would cost 8 to 15 ns.

/// Methods that do the same with each model; after `=>`, the enum that the result goes into.
macro_rules! each {
    ($variants:tt $($(#[$attribute:meta])* $vis:vis fn $name:ident($($arg:ident: $type:ty),*) -> $out:ty $(=> $into:ident)?;)*) => {
        $(
            $(#[$attribute])*
            $vis fn $name(&self $(, $arg: $type)*) -> $out {
                any::each!(@match $variants self $name ($($arg),*) $($into)?)
            }
        )*
    };
    (@match [$($variant:ident)*] $self:ident $name:ident $args:tt) => {
        match $self {
            $(Self::$variant(one) => one.$name $args),*
        }
    };
    (@match [$($variant:ident)*] $self:ident $name:ident $args:tt $into:ident) => {
        match $self {
            $(Self::$variant(one) => $into::$variant(one.$name $args)),*
        }
    };
}
pub(super) use each;

/// Calls on slices of three columns, on the level found and on a given one.
#[cfg(feature = "any")]
macro_rules! slices {
    ($variants:tt $($doc:literal $name:ident, $at:ident: $input:ident, $output:ident: $Output:ty;)*) => { $(
        #[doc = $doc]
        ///
        /// # Errors
        ///
        /// If the slices differ in length; nothing is written then.
        #[inline]
        pub fn $name(&self, $input: [&[f32]; 3], $output: $Output) -> Result<(), LengthError> {
            self.$at(Level::detect(), $input, $output)
        }

        any::each! { $variants
            #[doc = concat!("As [`", stringify!($name), "`](Self::", stringify!($name), "), on a given instruction set.")]
            ///
            /// # Errors
            ///
            /// If the slices differ in length; nothing is written then.
            #[inline(never)]
            pub fn $at(level: Level, $input: [&[f32]; 3], $output: $Output) -> Result<(), LengthError>;
        }
    )* };
}
#[cfg(feature = "any")]
pub(super) use slices;

/// The enum of a handle, and its conversions.
#[cfg(feature = "any")]
macro_rules! handle {
    ($(#[$doc:meta])* $any:ident $handle:ident [$($variant:ident: $model:ty;)*]) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        #[non_exhaustive]
        pub enum $any {
            $(
                #[allow(missing_docs, reason = "named as the model")]
                $variant($handle<$model>)
            ),*
        }

        $(impl From<$handle<$model>> for $any {
            #[inline]
            fn from(handle: $handle<$model>) -> Self {
                Self::$variant(handle)
            }
        })*

        impl $any {
            /// The model.
            #[inline]
            #[must_use]
            pub const fn model(&self) -> ModelId {
                match self {
                    $(Self::$variant(_) => ModelId::$variant),*
                }
            }
        }
    };
}
#[cfg(feature = "any")]
pub(super) use handle;

/// The handles of all models.
#[cfg(feature = "any")]
macro_rules! handles {
    ($models:tt $variants:tt) => {
        any::handle! {
            /// A material of any model of the list: see [`Material`].
            ///
            /// ```
            /// use hairis::{HairParams, Material};
            /// use hairis::simd::Level;
            /// use hairis_variants::{AnyMaterial, Cauchy};
            /// let red: AnyMaterial = Material::new(&Cauchy::PAPER.matched(), &HairParams::red()).into();
            /// let sample = red.prepare(glam::Vec3::Y).sample([0.5, 0.25, 0.75]).expect("not along the fibre");
            /// assert!(sample.pdf > 0.0);
            /// ```
            AnyMaterial Material $models
        }
        any::handle! {
            /// Eight materials of one model, one per lane: see [`Material8`].
            AnyMaterial8 Material8 $models
        }
        any::handle! {
            /// A shading point of any model: see [`Bsdf`].
            AnyBsdf Bsdf $models
        }
        any::handle! {
            /// Eight shading points of one model, one per lane: see [`Bsdf8`].
            AnyBsdf8 Bsdf8 $models
        }

        impl AnyMaterial {
            /// The shading point of a hit: a [`Hit`], or `wo` alone.
            #[inline]
            #[must_use]
            pub fn prepare(&self, hit: impl Into<Hit>) -> AnyBsdf {
                let hit = hit.into();
                self.prepare_hit(hit.wo.into(), hit.h)
            }

            #[inline(never)]
            fn prepare_hit(&self, wo: Vec3, h: f32) -> AnyBsdf {
                let hit = Hit { wo: wo.into(), h };
                any::each!(@match $variants self prepare (hit) AnyBsdf)
            }

            /// Eight shading points on this material, one per lane: a [`Hit8`], or eight `wo`.
            #[inline]
            #[must_use]
            pub fn prepare8(&self, hits: impl Into<Hit8>) -> AnyBsdf8 {
                self.prepare8_at(Level::detect(), hits)
            }

            /// As [`prepare8`](Self::prepare8), on a given instruction set.
            #[inline]
            #[must_use]
            pub fn prepare8_at(&self, level: Level, hits: impl Into<Hit8>) -> AnyBsdf8 {
                self.prepare_hits(level, &hits.into())
            }

            any::each! { $variants
                /// The largest directional albedo: see [`Material::max_albedo`].
                #[inline(never)]
                #[must_use]
                pub fn max_albedo() -> f32;
                /// The factor that keeps the directional albedo at most 1: see [`Material::conserving_scale`].
                #[inline(never)]
                #[must_use]
                pub fn conserving_scale() -> f32;
            }

            #[inline(never)]
            fn prepare_hits(&self, level: Level, hits: &Hit8) -> AnyBsdf8 {
                any::each!(@match $variants self prepare8_at (level, *hits) AnyBsdf8)
            }
        }

        impl AnyMaterial8 {
            any::pack! { $variants }

            /// Eight shading points, lane by lane: a [`Hit8`], or eight `wo`.
            #[inline]
            #[must_use]
            pub fn prepare8(&self, hits: impl Into<Hit8>) -> AnyBsdf8 {
                self.prepare8_at(Level::detect(), hits)
            }

            /// As [`prepare8`](Self::prepare8), on a given instruction set.
            #[inline]
            #[must_use]
            pub fn prepare8_at(&self, level: Level, hits: impl Into<Hit8>) -> AnyBsdf8 {
                self.prepare_hits(level, &hits.into())
            }

            #[inline(never)]
            fn prepare_hits(&self, level: Level, hits: &Hit8) -> AnyBsdf8 {
                any::each!(@match $variants self prepare8_at (level, *hits) AnyBsdf8)
            }
        }

        impl AnyBsdf {
            /// S at `wi`, without the cosine: see [`Bsdf::eval`].
            #[inline]
            #[must_use]
            pub fn eval(&self, wi: Vec3) -> [f32; 3] {
                self.eval_pdf(wi).value
            }

            /// Density of sampling `wi`, per steradian.
            #[inline]
            #[must_use]
            pub fn pdf(&self, wi: Vec3) -> f32 {
                self.eval_pdf(wi).pdf
            }

            /// As [`eval_pdf`](Self::eval_pdf), for eight directions.
            #[inline]
            #[must_use]
            pub fn eval_pdf8(&self, wi: &Vec3x8) -> Eval8 {
                self.eval_pdf8_at(Level::detect(), wi)
            }

            /// As [`lobes`](Self::lobes), for eight directions.
            #[inline]
            #[must_use]
            pub fn lobes8(&self, wi: &Vec3x8) -> PerLobe<LobeEval8> {
                self.lobes8_at(Level::detect(), wi)
            }

            /// As [`sample`](Self::sample), for eight triples of numbers.
            #[inline]
            #[must_use]
            pub fn sample8(&self, xi: &[f32x8; 3]) -> Sample8 {
                self.sample8_at(Level::detect(), xi)
            }

            any::slices! { $variants
                "Value and density of many directions: see [`Bsdf::eval_pdf_batch`]."
                eval_pdf_batch, eval_pdf_batch_at: wi, out: EvalSlices<'_>;
                "Value of many directions: see [`Bsdf::eval_batch`]."
                eval_batch, eval_batch_at: wi, value: [&mut [f32]; 3];
                "Density of many directions: see [`Bsdf::pdf_batch`]."
                pdf_batch, pdf_batch_at: wi, pdf: &mut [f32];
                "Many samples: see [`Bsdf::sample_batch`]."
                sample_batch, sample_batch_at: xi, out: SampleSlices<'_>;
                "Direction, density and weight of many samples: see [`Bsdf::sample_weight_batch`]."
                sample_weight_batch, sample_weight_batch_at: xi, out: SampleWeightSlices<'_>;
            }

            any::each! { $variants
                /// Value and density at `wi`.
                #[inline(never)]
                #[must_use]
                pub fn eval_pdf(wi: Vec3) -> Eval;
                /// Each lobe's value, colour and own density.
                #[inline(never)]
                #[must_use]
                pub fn lobes(wi: Vec3) -> PerLobe<LobeEval>;
                /// A direction for three uniform numbers in `[0, 1)`; `None` if it is discarded: see [`Bsdf::sample`].
                #[inline(never)]
                #[must_use]
                pub fn sample(xi: [f32; 3]) -> Option<Sample>;
                /// As [`eval_pdf8`](Self::eval_pdf8), on a given instruction set.
                #[inline(never)]
                #[must_use]
                pub fn eval_pdf8_at(level: Level, wi: &Vec3x8) -> Eval8;
                /// As [`lobes8`](Self::lobes8), on a given instruction set.
                #[inline(never)]
                #[must_use]
                pub fn lobes8_at(level: Level, wi: &Vec3x8) -> PerLobe<LobeEval8>;
                /// As [`sample8`](Self::sample8), on a given instruction set.
                #[inline(never)]
                #[must_use]
                pub fn sample8_at(level: Level, xi: &[f32x8; 3]) -> Sample8;
                /// The shading point with only some of its lobes.
                #[inline(never)]
                #[must_use]
                pub fn with_lobes(lobes: LobeMask) -> Self => Self;
                /// The shading point, returning no more light than arrives: see [`Conserving`](hairis::Conserving).
                #[inline(never)]
                #[must_use]
                pub fn conserving() -> Self => Self;
                /// Directional albedo of each lobe, linear RGB.
                #[inline(never)]
                #[must_use]
                pub fn albedo() -> PerLobe<[f32; 3]>;
            }
        }

        impl AnyBsdf8 {
            /// Value and density at `wi`, each lane at its own shading point.
            #[inline]
            #[must_use]
            pub fn eval_pdf8(&self, wi: &Vec3x8) -> Eval8 {
                self.eval_pdf8_at(Level::detect(), wi)
            }

            /// Each lobe's value, colour and own density, each lane at its own shading point.
            #[inline]
            #[must_use]
            pub fn lobes8(&self, wi: &Vec3x8) -> PerLobe<LobeEval8> {
                self.lobes8_at(Level::detect(), wi)
            }

            /// Directional albedo of each lobe, linear RGB, each lane at its own shading point.
            #[inline]
            #[must_use]
            pub fn albedo8(&self) -> PerLobe<[f32x8; 3]> {
                self.albedo8_at(Level::detect())
            }

            /// One direction for each shading point.
            #[inline]
            #[must_use]
            pub fn sample8(&self, xi: &[f32x8; 3]) -> Sample8 {
                self.sample8_at(Level::detect(), xi)
            }

            any::each! { $variants
                /// As [`eval_pdf8`](Self::eval_pdf8), on a given instruction set.
                #[inline(never)]
                #[must_use]
                pub fn eval_pdf8_at(level: Level, wi: &Vec3x8) -> Eval8;
                /// As [`lobes8`](Self::lobes8), on a given instruction set.
                #[inline(never)]
                #[must_use]
                pub fn lobes8_at(level: Level, wi: &Vec3x8) -> PerLobe<LobeEval8>;
                /// As [`sample8`](Self::sample8), on a given instruction set.
                #[inline(never)]
                #[must_use]
                pub fn sample8_at(level: Level, xi: &[f32x8; 3]) -> Sample8;
                /// The shading points with only some of their lobes.
                #[inline(never)]
                #[must_use]
                pub fn with_lobes(lobes: LobeMask) -> Self => Self;
                /// The shading points, each returning no more light than arrives.
                #[inline(never)]
                #[must_use]
                pub fn conserving() -> Self => Self;
                /// As [`albedo8`](Self::albedo8), on a given instruction set.
                #[inline(never)]
                #[must_use]
                pub fn albedo8_at(level: Level) -> PerLobe<[f32x8; 3]>;
                /// The shading point of one lane.
                ///
                /// # Panics
                ///
                /// If `lane` is above 7.
                #[inline(never)]
                #[must_use]
                pub fn lane(lane: usize) -> AnyBsdf => AnyBsdf;
            }
        }
    };
}
#[cfg(feature = "any")]
pub(super) use handles;

/// [`AnyMaterial8`](super::AnyMaterial8) of eight materials.
#[cfg(feature = "any")]
macro_rules! pack {
    ([$($variant:ident)*]) => {
        /// Eight materials, one per lane; `None` unless all are of one model.
        #[inline(never)]
        #[must_use]
        pub fn pack(materials: [&AnyMaterial; 8]) -> Option<Self> {
            match materials[0] {
                $(AnyMaterial::$variant(first) => {
                    let mut same = [first; 8];
                    for (one, material) in same.iter_mut().zip(materials) {
                        let AnyMaterial::$variant(material) = material else { return None };
                        *one = material;
                    }
                    Some(Self::$variant(Material8::pack(same)))
                }),*
            }
        }
    };
}
#[cfg(feature = "any")]
pub(super) use pack;
