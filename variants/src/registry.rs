//! The only list of models.
//!
//! A new model is a line of [`for_each_model!`] below, and beside its [`Model`] an implementation of [`Registered`], with
//! [`Parameters`] for its parameters. Run-time handles, the harness and the benches then include it. Models that few programs need are
//! lines of [`with_every_sampler!`], which the feature `every-sampler` adds, as they double the code.

#[cfg(feature = "any")]
mod any;

use crate::{AllCauchy, Cauchy, Chiang, Field, KajiyaKay, Parameters, Values};
use hairis::model::{Model, Precision};
use hairis::{Gaussian, Matched, Published};

#[cfg(feature = "any")]
use hairis::ParamError;
#[cfg(feature = "any")]
use {
    core::ops::{Deref, DerefMut},
    glam::Vec3,
    hairis::model::{DynBsdf, DynBsdf8},
    hairis::simd::Level,
    hairis::{Bsdf, Bsdf8, Conserving, Hit, Hit8, LobeMask, Material, Material8},
};

/// A model of the list: its names.
///
/// Types of one model with different samplers share a [`NAME`](Self::NAME); each has its own [`CHOICE`](Self::CHOICE).
pub trait Registered: Model<Params: Parameters> + Send + Sync + 'static {
    /// Name of the model.
    const NAME: &'static str;
    /// Field and word that select this among the entries of one name; the first entry of a name is its default.
    const CHOICE: Option<(&'static str, &'static str)> = None;
    /// The model as it is registered.
    const MODEL: Self;
    /// Whether it reads [`Hit::h`](hairis::Hit::h).
    const NEAR_FIELD: bool = false;
    /// Name of the lobes' colours in reports; `None` if they are not reported.
    const COLORS: Option<&'static str> = None;

    /// The constants of a material in any [`Precision`], from values that are not checked: those of the fields that
    /// [`Parameters::values`] gives. A word is its place in the list.
    fn constants<W: Precision>(values: &Values<W::Lane>) -> Self::Material<W::Lane>;
}

/// Work on a model of the list as a type: see [`ModelId::visit`].
pub trait Visitor {
    /// Result of the work.
    type Output;

    /// Does the work on the model `M`, which is [`ModelId::of::<M>()`](ModelId::of).
    fn visit<M: Registered>(self) -> Self::Output;
}

macro_rules! models {
    ($($(#[$doc:meta])* $variant:ident: $model:ty;)*) => {
        /// A model of the list.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum ModelId {
            $($(#[$doc])* $variant),*
        }

        impl ModelId {
            /// Every model, in the order of reports.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];

            /// Calls `visitor` with the model's type.
            #[inline]
            pub fn visit<V: Visitor>(self, visitor: V) -> V::Output {
                match self {
                    $(Self::$variant => visitor.visit::<$model>()),*
                }
            }

            /// Name of the model; entries that differ in their sampler alone share it.
            #[inline]
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => <$model as Registered>::NAME),*
                }
            }

            /// Field and word that select this among the entries of its name, if it has several.
            #[inline]
            #[must_use]
            pub const fn choice(self) -> Option<(&'static str, &'static str)> {
                match self {
                    $(Self::$variant => <$model as Registered>::CHOICE),*
                }
            }

            /// Names of the lobes, in slot order.
            #[inline]
            #[must_use]
            pub const fn lobes(self) -> &'static [&'static str] {
                match self {
                    $(Self::$variant => <$model as Model>::LOBES),*
                }
            }

            /// Whether it reads [`Hit::h`](hairis::Hit::h).
            #[inline]
            #[must_use]
            pub const fn is_near_field(self) -> bool {
                match self {
                    $(Self::$variant => <$model as Registered>::NEAR_FIELD),*
                }
            }

            /// Name of the lobes' colours in reports, if they are reported.
            #[inline]
            #[must_use]
            pub const fn colors(self) -> Option<&'static str> {
                match self {
                    $(Self::$variant => <$model as Registered>::COLORS),*
                }
            }

            /// Fields of the parameters.
            #[inline]
            #[must_use]
            pub const fn fields(self) -> &'static [Field] {
                match self {
                    $(Self::$variant => <<$model as Model>::Params as Parameters>::FIELDS),*
                }
            }

            /// Values of the default parameters.
            #[inline]
            #[must_use]
            pub fn defaults(self) -> Values {
                match self {
                    $(Self::$variant => <$model as Model>::Params::default().values()),*
                }
            }

            /// Values of the first of the [`presets`](Self::presets): the material that this project's figures are of.
            #[inline]
            #[must_use]
            pub fn measured(self) -> Values {
                match self {
                    $(Self::$variant => <<$model as Model>::Params as Parameters>::PRESETS[0].1.values()),*
                }
            }

            /// Named parameters.
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
            /// The material of these values, as it is; [`AnyMaterial::conserving`] limits the light that it returns.
            ///
            /// # Errors
            ///
            /// If a value is out of its range.
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

/// Calls `$callback!` with the list, a line `Variant: Type;` per model. Types are named as here: the caller imports them.
#[doc(hidden)]
#[macro_export]
macro_rules! for_each_model {
    ($callback:ident) => {
        $crate::with_every_sampler! { $callback
            /// The published model with the published sampler.
            Gaussian: Published<Gaussian>;
            /// The published model, sampler matched with nine bands.
            GaussianMatched: Matched<Gaussian>;
            /// The all-Cauchy variant with the published sampler.
            Cauchy: AllCauchy;
            /// The all-Cauchy variant, sampler matched with nine bands.
            CauchyMatched: Matched<Cauchy>;
            /// Kajiya and Kay's model.
            KajiyaKay: KajiyaKay;
            /// The energy-conserving fibre, lobes chosen by their mean over the channels.
            Chiang: Chiang;
        }
    };
}

/// Calls `$callback!` with these models and those that few programs need.
#[cfg(feature = "every-sampler")]
#[doc(hidden)]
#[macro_export]
macro_rules! with_every_sampler {
    ($callback:ident $($models:tt)*) => {
        $callback! {
            $($models)*
            /// The published model, sampler matched with five bands.
            GaussianMatched5: Matched<Gaussian, 5>;
            /// The published model, sampler matched with twenty-five bands.
            GaussianMatched25: Matched<Gaussian, 25>;
            /// The all-Cauchy variant, sampler matched with five bands.
            CauchyMatched5: Matched<Cauchy, 5>;
            /// The all-Cauchy variant, sampler matched with twenty-five bands.
            CauchyMatched25: Matched<Cauchy, 25>;
            /// The energy-conserving fibre, lobes chosen by their share in each channel.
            ChiangByChannel: Chiang<true>;
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
    /// The first entry of each name.
    #[inline]
    pub fn defaults_of_names() -> impl Iterator<Item = Self> + Clone {
        Self::ALL.iter().copied().filter(|id| id.is_default())
    }

    /// Whether this is the first entry of its name.
    #[inline]
    #[must_use]
    pub const fn is_default(self) -> bool {
        matches!(Self::find(self.name(), None), Some(first) if first as usize == self as usize)
    }

    /// The entry of this name, with this word of its [`choice`](Self::choice); without a word, the first of the name. `ou` is
    /// accepted for `published`.
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

    /// The entry of a type, at compile time: `if const { ModelId::of::<M>().is_default() }` leaves no code of other models.
    ///
    /// # Panics
    ///
    /// If the type is none of the list.
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

/// Whether two names are equal, at compile time too.
#[inline]
const fn same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut place = 0;
    while place < a.len() && place < b.len() && a[place] == b[place] {
        place += 1;
    }
    place == a.len() && place == b.len()
}
