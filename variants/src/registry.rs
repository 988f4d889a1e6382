//! Registry of models: the only list of models in the project.
//!
//! To add a model, implement [`Registered`] beside its [`Model`] and [`Parameters`] for its parameters, and add a line to
//! [`for_each_model!`] below. Run-time handles, the harness and the benches then include the model. Models that few programs need are
//! lines of [`with_every_sampler!`], which only the feature `every-sampler` adds because they treble the time to compile.

#[cfg(feature = "any")]
mod any;

use crate::{AllCauchy, Cauchy, Chiang, DEon, Field, KajiyaKay, Parameters, Values};
use hairis::model::{Model, Precision};
use hairis::{Gaussian, Matched, Published};

#[cfg(feature = "any")]
use hairis::ParamError;
#[cfg(feature = "any")]
use {
    core::ops::{Deref, DerefMut},
    glam::Vec3,
    hairis::columns::SampleColumns,
    hairis::dual_scattering::{Averages, DualScattering, albedo_and_forward},
    hairis::model::{DynBsdf, DynBsdf8},
    hairis::simd::Level,
    hairis::{Bsdf, Bsdf8, Conserving, Hit, Hit8, Lobe, LobeMask, Material, Material8},
};

/// Model of the registry, with the names under which hosts find it.
///
/// Types of one model that differ in their sampler share a [`NAME`](Self::NAME), and each has its own [`CHOICE`](Self::CHOICE).
pub trait Registered: Model<Params: Parameters> + Send + Sync + 'static {
    /// Name of the model, which types with different samplers share.
    const NAME: &'static str;
    /// Field and word that select this entry among the entries of its name; the first entry of a name is its default.
    const CHOICE: Option<(&'static str, &'static str)> = None;
    /// Value of the model that the registry uses.
    const MODEL: Self;
    /// True if the model reads [`Hit::h`](hairis::Hit::h), the offset of a hit across the fibre.
    const NEAR_FIELD: bool = false;
    /// Name of the lobes' colours in reports; `None` if reports leave them out.
    const COLORS: Option<&'static str> = None;

    /// Computes the constants of a material in any [`Precision`], from values that are not checked. `values` must have the fields that
    /// [`Parameters::values`] gives; a word is given as its place in the list of words.
    fn constants<W: Precision>(values: &Values<W::Lane>) -> Self::Material<W::Lane>;
}

/// Operation that is generic over the type of a model: see [`ModelId::visit`].
pub trait Visitor {
    /// Result of the operation.
    type Output;

    /// Performs the operation on the model `M`, whose identifier is [`ModelId::of::<M>()`](ModelId::of).
    fn visit<M: Registered>(self) -> Self::Output;
}

macro_rules! models {
    ($($(#[$doc:meta])* $variant:ident: $model:ty;)*) => {
        /// Identifier of a model of the registry, by which hosts choose the model at run time.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum ModelId {
            $($(#[$doc])* $variant),*
        }

        impl ModelId {
            /// Every model of the registry, in the order of reports.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];

            /// Calls `visitor` with the type of this model, and returns its result.
            #[inline]
            pub fn visit<V: Visitor>(self, visitor: V) -> V::Output {
                match self {
                    $(Self::$variant => visitor.visit::<$model>()),*
                }
            }

            /// Returns the name of the model, which entries that differ in their sampler alone share.
            #[inline]
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => <$model as Registered>::NAME),*
                }
            }

            /// Returns the field and the word that select this entry among the entries of its name, or `None` if it has no such field.
            #[inline]
            #[must_use]
            pub const fn choice(self) -> Option<(&'static str, &'static str)> {
                match self {
                    $(Self::$variant => <$model as Registered>::CHOICE),*
                }
            }

            /// Returns the names of the model's lobes, in the order of their slots.
            #[inline]
            #[must_use]
            pub const fn lobes(self) -> &'static [&'static str] {
                match self {
                    $(Self::$variant => <$model as Model>::LOBES),*
                }
            }

            /// Returns true if the model reads [`Hit::h`](hairis::Hit::h), the offset of a hit across the fibre.
            #[inline]
            #[must_use]
            pub const fn is_near_field(self) -> bool {
                match self {
                    $(Self::$variant => <$model as Registered>::NEAR_FIELD),*
                }
            }

            /// Returns the name of the lobes' colours in reports, or `None` if reports leave them out.
            #[inline]
            #[must_use]
            pub const fn colors(self) -> Option<&'static str> {
                match self {
                    $(Self::$variant => <$model as Registered>::COLORS),*
                }
            }

            /// Returns the fields of the model's parameters, in the order of files.
            #[inline]
            #[must_use]
            pub const fn fields(self) -> &'static [Field] {
                match self {
                    $(Self::$variant => <<$model as Model>::Params as Parameters>::FIELDS),*
                }
            }

            /// Returns the values of the model's default parameters.
            #[inline]
            #[must_use]
            pub fn defaults(self) -> Values {
                match self {
                    $(Self::$variant => <$model as Model>::Params::default().values()),*
                }
            }

            /// Returns the values of the first of the [`presets`](Self::presets), which is the material of this project's figures.
            #[inline]
            #[must_use]
            pub fn measured(self) -> Values {
                match self {
                    $(Self::$variant => <<$model as Model>::Params as Parameters>::PRESETS[0].1.values()),*
                }
            }

            /// Returns the name and the values of each preset of the model.
            #[inline]
            pub fn presets(self) -> impl Iterator<Item = (&'static str, Values)> + Clone {
                let preset = move |index: usize| match self {
                    $(Self::$variant => <<$model as Model>::Params as Parameters>::PRESETS
                        .get(index)
                        .map(|(name, params)| (*name, params.values()))),*
                };
                (0..).map_while(preset)
            }
        }

        #[cfg(feature = "any")]
        impl ModelId {
            /// Makes the material of these values as it is; [`AnyMaterial::conserving`] limits the light that a material returns.
            ///
            /// # Errors
            ///
            /// Returns an error that names the field if a value is out of its range.
            ///
            /// ```
            /// use hairis_variants::ModelId;
            /// let id = ModelId::find("gaussian", Some("matched")).expect("a model of the list");
            /// let (_, red) = id.presets().find(|(name, _)| *name == "red").expect("a preset");
            /// let bsdf = id.material(&red)?.prepare(glam::Vec3::new(0.6, 0.0, 0.8));
            /// let sample = bsdf.sample([0.3, 0.6, 0.9]).expect("not along the fibre");
            /// assert!(sample.weight[0] > 0.0 && sample.lobe.index() < id.lobes().len());
            /// # Ok::<(), hairis::ParamError>(())
            /// ```
            #[inline(never)]
            pub fn material(self, values: &Values) -> Result<AnyMaterial, ParamError> {
                Ok(match self {
                    $(Self::$variant => {
                        AnyMaterial::from(Material::new(&<$model>::MODEL, &Parameters::from_values(values)?))
                    }),*
                })
            }
        }

        #[cfg(feature = "any")]
        any::handles! { [$($variant: $model;)*] }

    };
}

/// Calls `$callback!` with the list, which has a line `Variant: Type;` per model. The caller imports the types under these names.
#[doc(hidden)]
#[macro_export]
macro_rules! for_each_model {
    ($callback:ident) => {
        $crate::chosen_models! { $callback }
    };
    // Adds the models of the first name to those so far.
    (@ $callback:ident [gaussian $($names:tt)*] $($models:tt)*) => {
        $crate::for_each_model! { @ $callback [$($names)*] $($models)*
            /// The published model with the published sampler.
            Gaussian: Published<Gaussian>;
            /// The published model with the matched sampler of nine bands.
            GaussianMatched: Matched<Gaussian>;
        }
    };
    (@ $callback:ident [cauchy $($names:tt)*] $($models:tt)*) => {
        $crate::for_each_model! { @ $callback [$($names)*] $($models)*
            /// The all-Cauchy variant with the published sampler.
            Cauchy: AllCauchy;
            /// The all-Cauchy variant with the matched sampler of nine bands.
            CauchyMatched: Matched<Cauchy>;
        }
    };
    (@ $callback:ident [kajiya_kay $($names:tt)*] $($models:tt)*) => {
        $crate::for_each_model! { @ $callback [$($names)*] $($models)*
            /// Kajiya and Kay's model.
            KajiyaKay: KajiyaKay;
        }
    };
    (@ $callback:ident [chiang $($names:tt)*] $($models:tt)*) => {
        $crate::for_each_model! { @ $callback [$($names)*] $($models)*
            /// The energy-conserving fibre, whose lobes are chosen by their mean attenuation over the channels.
            Chiang: Chiang;
        }
    };
    (@ $callback:ident [d_eon $($names:tt)*] $($models:tt)*) => {
        $crate::for_each_model! { @ $callback [$($names)*] $($models)*
            /// D'Eon's far field.
            DEon: DEon;
        }
    };
    (@ $callback:ident [] $($models:tt)*) => {
        $crate::with_every_sampler! { $callback $($models)* }
    };
}

/// Calls `$callback!` with the whole list.
#[cfg(not(hairis_one))]
#[doc(hidden)]
#[macro_export]
macro_rules! chosen_models {
    ($callback:ident) => {
        $crate::for_each_model! { @ $callback [gaussian cauchy kajiya_kay chiang d_eon] }
    };
}

// One model alone, for developers: see CONTRIBUTING.md.
#[cfg(hairis_one = "gaussian")]
#[doc(hidden)]
#[macro_export]
macro_rules! chosen_models {
    ($callback:ident) => {
        $crate::for_each_model! { @ $callback [gaussian] }
    };
}

#[cfg(hairis_one = "cauchy")]
#[doc(hidden)]
#[macro_export]
macro_rules! chosen_models {
    ($callback:ident) => {
        $crate::for_each_model! { @ $callback [cauchy] }
    };
}

#[cfg(hairis_one = "kajiya-kay")]
#[doc(hidden)]
#[macro_export]
macro_rules! chosen_models {
    ($callback:ident) => {
        $crate::for_each_model! { @ $callback [kajiya_kay] }
    };
}

#[cfg(hairis_one = "chiang")]
#[doc(hidden)]
#[macro_export]
macro_rules! chosen_models {
    ($callback:ident) => {
        $crate::for_each_model! { @ $callback [chiang] }
    };
}

#[cfg(hairis_one = "d-eon")]
#[doc(hidden)]
#[macro_export]
macro_rules! chosen_models {
    ($callback:ident) => {
        $crate::for_each_model! { @ $callback [d_eon] }
    };
}

/// Calls `$callback!` with these models, followed by the models that few programs need.
#[cfg(feature = "every-sampler")]
#[doc(hidden)]
#[macro_export]
macro_rules! with_every_sampler {
    ($callback:ident $($models:tt)*) => {
        $callback! {
            $($models)*
            /// The published model with the matched sampler of five bands.
            GaussianMatched5: Matched<Gaussian, 5>;
            /// The published model with the matched sampler of twenty-five bands.
            GaussianMatched25: Matched<Gaussian, 25>;
            /// The all-Cauchy variant with the matched sampler of five bands.
            CauchyMatched5: Matched<Cauchy, 5>;
            /// The all-Cauchy variant with the matched sampler of twenty-five bands.
            CauchyMatched25: Matched<Cauchy, 25>;
            /// The energy-conserving fibre, whose lobes are chosen by their share of the attenuation in each channel.
            ChiangByChannel: Chiang<true>;
            /// The published model with a diffuse part, and the published sampler.
            GaussianDiffuse: $crate::WithDiffuse<Published<Gaussian>>;
            /// The published model with a diffuse part, and the matched sampler of nine bands.
            GaussianDiffuseMatched: $crate::WithDiffuse<Matched<Gaussian>>;
            /// The all-Cauchy variant with a diffuse part, and the published sampler.
            CauchyDiffuse: $crate::WithDiffuse<AllCauchy>;
            /// The energy-conserving fibre with a diffuse part.
            ChiangDiffuse: $crate::WithDiffuse<Chiang>;
            /// The energy-conserving fibre with a fake medulla.
            ChiangScattering: $crate::chiang::ScatteringChiang;
        }
    };
}

#[cfg(not(feature = "every-sampler"))]
#[doc(hidden)]
#[macro_export]
macro_rules! with_every_sampler {
    ($callback:ident $($models:tt)*) => {
        $callback! { $($models)* }
    };
}
for_each_model! { models }

impl ModelId {
    /// Returns the first entry of each name, in the order of [`ALL`](Self::ALL).
    #[inline]
    pub fn defaults_of_names() -> impl Iterator<Item = Self> + Clone {
        Self::ALL.iter().copied().filter(|id| id.is_default())
    }

    /// Returns true if this is the first entry of its name, which is the default.
    #[inline]
    #[must_use]
    pub const fn is_default(self) -> bool {
        matches!(Self::find(self.name(), None), Some(first) if first as usize == self as usize)
    }

    /// Finds the entry with this name and with this word of its [`choice`](Self::choice). Without a word, returns the first entry of the
    /// name. The word `ou` is accepted for `published`.
    ///
    /// ```
    /// use hairis_variants::ModelId;
    /// assert_eq!(ModelId::find("cauchy", None), Some(ModelId::Cauchy));
    /// assert_eq!(ModelId::find("cauchy", Some("matched")), Some(ModelId::CauchyMatched));
    /// ```
    #[inline]
    #[must_use]
    pub const fn find(name: &str, word: Option<&str>) -> Option<Self> {
        let word = match word {
            Some(word) if same(word, "ou") => Some("published"),
            word => word,
        };
        let mut place = 0;
        while place < Self::ALL.len() {
            let id = Self::ALL[place];
            let is_chosen = match (word, id.choice()) {
                (None, _) => true,
                (Some(word), Some((_, one))) => same(word, one),
                (Some(_), None) => false,
            };
            if is_chosen && same(name, id.name()) {
                return Some(id);
            }
            place += 1;
        }
        None
    }

    /// Returns the entry of a type, at compile time: `if const { ModelId::of::<M>().is_default() }` leaves no code of other models.
    ///
    /// # Panics
    ///
    /// Panics if the registry has no entry for the type.
    #[inline]
    #[must_use]
    pub const fn of<M: Registered>() -> Self {
        let word = match M::CHOICE {
            Some((_, word)) => Some(word),
            None => None,
        };
        Self::find(M::NAME, word).expect("a model of the list")
    }
}

#[cfg(feature = "any")]
impl AnyMaterial {
    /// Measures the averages of dual scattering: see [`DualScattering::new`].
    ///
    /// ```
    /// use hairis_variants::ModelId;
    /// let hair = ModelId::Chiang.material(&ModelId::Chiang.measured())?;
    /// let normal = hair.dual_scattering().averages(0.0);
    /// assert!(normal.forward.albedo[0] > normal.backward.albedo[0]);
    /// # Ok::<(), hairis::ParamError>(())
    /// ```
    #[inline]
    #[must_use]
    pub fn dual_scattering(&self) -> DualScattering<f32> {
        DualScattering::measured(self.model().lobes().len(), &mut self.draw())
    }

    /// Measures the albedo at an inclination of the light, rad, and its share that goes straight on: see [`albedo_and_forward`].
    #[inline]
    #[must_use]
    pub fn albedo_and_forward(&self, theta: f32) -> [[f32; 3]; 2] {
        albedo_and_forward(theta, self.model().lobes().len(), &mut self.draw())
    }

    /// Returns the largest errors of the polynomials: see [`DualScattering::errors`].
    #[inline]
    #[must_use]
    pub fn dual_scattering_errors(&self, dual: &DualScattering<f32>) -> Averages<f32> {
        dual.errors(self.model().lobes().len(), &mut self.draw())
    }

    /// Returns a function that draws samples of one lobe at a hit.
    fn draw(&self) -> impl FnMut(Hit, Lobe, [&[f32]; 3], SampleColumns<'_>) {
        |hit, lobe, xi, out| {
            let mut bsdf = self.prepare(hit);
            bsdf.set_lobes(LobeMask::of(&[lobe]));
            let drawn = bsdf.sample_columns(xi, out);
            debug_assert!(drawn.is_ok(), "columns of one length");
        }
    }
}

/// Returns true if two names are equal; unlike `==`, this works at compile time too.
#[inline]
const fn same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut place = 0;
    while place < a.len() && place < b.len() && a[place] == b[place] {
        place += 1;
    }
    place == a.len() && place == b.len()
}
