//! Public handles of a model that is chosen at run time.
//!
//! Each handle is an enum, so that it stays plain data. BSDFs dereference to the object-safe traits of `hairis::model`, which provide
//! their calls. Each model is compiled once, in this crate, and the choice costs one jump. Handles have the types of [`Conserving`],
//! whether they conserve energy or not, because a second type would have to be compiled as well.

/// Calls a method of the handle, whichever its model. The last argument, if given, names the enum that the result goes into.
macro_rules! each {
    ([$($variant:ident: $model:ty;)*] $this:expr, $one:ident => $call:expr) => {
        match $this {
            $(Self::$variant($one) => $call),*
        }
    };
    ([$($variant:ident: $model:ty;)*] $this:expr, $one:ident => $call:expr, $Out:ident) => {
        match $this {
            $(Self::$variant($one) => $Out::$variant($call)),*
        }
    };
}
pub(super) use each;

/// Declares the enum of a handle and its conversions.
macro_rules! handle {
    ($(#[$doc:meta])* $any:ident $handle:ident [$($variant:ident: $model:ty;)*]) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum $any {
            $(
                #[allow(missing_docs, reason = "named as the model")]
                $variant($handle<Conserving<$model>>)
            ),*
        }

        $(
        impl From<$handle<$model>> for $any {
            #[inline]
            fn from(handle: $handle<$model>) -> Self {
                Self::$variant(handle.into())
            }
        }

        impl From<$handle<Conserving<$model>>> for $any {
            #[inline]
            fn from(handle: $handle<Conserving<$model>>) -> Self {
                Self::$variant(handle)
            }
        }
        )*

        impl $any {
            /// Returns the model that this handle was made of.
            #[inline]
            #[must_use]
            pub const fn model(&self) -> ModelId {
                match self {
                    $(Self::$variant(_) => ModelId::$variant),*
                }
            }

            /// Selects another instruction set, which handles made from this one inherit.
            #[inline]
            #[must_use]
            pub const fn with_level(self, level: Level) -> Self {
                match self {
                    $(Self::$variant(one) => Self::$variant(one.with_level(level))),*
                }
            }
        }
    };
}
pub(super) use handle;

/// Lets a handle dereference to a trait object.
macro_rules! object {
    ($any:ident $object:ident [$($variant:ident: $model:ty;)*]) => {
        impl Deref for $any {
            type Target = dyn $object;
            // Inlined, it would compile every model anew in each crate that calls a handle.
            #[inline(never)]
            fn deref(&self) -> &Self::Target {
                match self {
                    $(Self::$variant(one) => one),*
                }
            }
        }

        impl DerefMut for $any {
            #[inline(never)]
            fn deref_mut(&mut self) -> &mut Self::Target {
                match self {
                    $(Self::$variant(one) => one),*
                }
            }
        }
    };
}
pub(super) use object;

/// Adds the calls that restrict a BSDF to some lobes or conserve its energy.
macro_rules! restricted {
    ($($any:ident)*) => { $(
        impl $any {
            /// Keeps only the lobes of the mask; the others neither scatter nor are sampled.
            #[inline]
            #[must_use]
            pub fn with_lobes(mut self, lobes: LobeMask) -> Self {
                self.set_lobes(lobes);
                self
            }

            /// Limits the scattered light to the light that arrives, by integrals of the lobes: see [`Bsdf::conserving`].
            /// [`AnyMaterial::conserving`] does so for a whole material, at next to no cost per hit.
            #[inline]
            #[must_use]
            pub fn conserving(mut self) -> Self {
                self.set_conserving();
                self
            }
        }
    )* };
}
pub(super) use restricted;

/// Declares the run-time handles, each with a variant per model of the list.
macro_rules! handles {
    ($models:tt) => {
        any::handle! {
            /// Material of any model of the registry, chosen at run time: see [`Material`].
            ///
            /// ```
            /// use hairis::{HairParams, Material};
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
            /// BSDF of any model of the registry: see [`Bsdf`]. It dereferences to [`DynBsdf`], which has its calls.
            AnyBsdf Bsdf $models
        }
        any::handle! {
            /// Eight BSDFs of one model, one per lane: see [`Bsdf8`]. They dereference to [`DynBsdf8`], which has their calls.
            AnyBsdf8 Bsdf8 $models
        }
        any::object! { AnyBsdf DynBsdf $models }
        any::object! { AnyBsdf8 DynBsdf8 $models }
        any::restricted! { AnyBsdf AnyBsdf8 }

        impl AnyMaterial {
            /// Prepares the BSDF at a hit, which is given as a [`Hit`] or as `wo` alone.
            #[inline]
            #[must_use]
            pub fn prepare(&self, hit: impl Into<Hit>) -> AnyBsdf {
                let hit = hit.into();
                self.prepare_hit(hit.wo.into(), hit.h)
            }

            /// Takes scalars, because a vector that is passed by value would go through memory.
            #[inline(never)]
            fn prepare_hit(&self, wo: Vec3, h: f32) -> AnyBsdf {
                let hit = Hit { wo: wo.into(), h };
                any::each!($models self, material => material.prepare(hit), AnyBsdf)
            }

            /// Prepares the BSDFs at eight hits on this material, one per lane, which are given as a [`Hit8`] or as eight `wo`.
            #[inline]
            #[must_use]
            pub fn prepare8(&self, hits: impl Into<Hit8>) -> AnyBsdf8 {
                self.prepare_hits(&hits.into())
            }

            #[inline(never)]
            fn prepare_hits(&self, hits: &Hit8) -> AnyBsdf8 {
                any::each!($models self, material => material.prepare8(hits), AnyBsdf8)
            }

            /// Returns the material with energy conservation: see [`Conserving`]. Making it takes about as long as a hundred hits.
            ///
            /// ```
            /// use hairis::PerLobe;
            /// use hairis_variants::ModelId;
            /// let (_, white) = ModelId::Gaussian.presets().find(|(name, _)| *name == "white").expect("a preset");
            /// let grazing = glam::Vec3::new(0.99, 0.14, 0.0).normalize();
            /// let raw = ModelId::Gaussian.material(&white)?;
            /// let PerLobe(lobes) = raw.conserving().prepare(grazing).albedo();
            /// assert!(lobes.iter().map(|lobe| lobe[0]).sum::<f32>() < 1.001);
            /// # Ok::<(), hairis::ParamError>(())
            /// ```
            #[inline(never)]
            #[must_use]
            pub fn conserving(&self) -> Self {
                any::each!($models self, material => material.conserving(), Self)
            }

            /// Returns true if each hit integrates the lobes: see [`Material::integrates`].
            #[inline(never)]
            #[must_use]
            pub fn integrates(&self) -> bool {
                any::each!($models self, material => material.integrates())
            }

            /// Returns the largest directional albedo of the material: see [`Material::max_albedo`].
            #[inline(never)]
            #[must_use]
            pub fn max_albedo(&self) -> f32 {
                any::each!($models self, material => material.max_albedo())
            }

            /// Returns the factor that keeps the directional albedo at most 1: see [`Material::conserving_scale`].
            #[inline(never)]
            #[must_use]
            pub fn conserving_scale(&self) -> f32 {
                any::each!($models self, material => material.conserving_scale())
            }
        }

        impl AnyMaterial8 {
            any::pack! { $models }

            /// Prepares the BSDFs at eight hits, lane by lane, which are given as a [`Hit8`] or as eight `wo`.
            #[inline]
            #[must_use]
            pub fn prepare8(&self, hits: impl Into<Hit8>) -> AnyBsdf8 {
                self.prepare_hits(&hits.into())
            }

            #[inline(never)]
            fn prepare_hits(&self, hits: &Hit8) -> AnyBsdf8 {
                any::each!($models self, material => material.prepare8(hits), AnyBsdf8)
            }
        }

        impl AnyBsdf8 {
            /// Returns the BSDF of one of the eight lanes as a scalar handle.
            ///
            /// # Panics
            ///
            /// Panics if `lane` is above 7.
            #[inline(never)]
            #[must_use]
            pub fn lane(&self, lane: usize) -> AnyBsdf {
                any::each!($models self, bsdf => bsdf.lane(lane), AnyBsdf)
            }
        }
    };
}
pub(super) use handles;

/// Declares the constructor of [`AnyMaterial8`](super::AnyMaterial8) from eight materials.
macro_rules! pack {
    ([$($variant:ident: $model:ty;)*]) => {
        /// Packs eight materials, one per lane. Returns `None` unless all of them have the same model.
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
pub(super) use pack;
