//! Parameters of a model with a diffuse part: the description, its checks, its fields and the presets.

use crate::parameters::appended;
use crate::{ChiangParams, Field, Kind, Parameters, Values};
use hairis::params::Rule;
use hairis::{HairParams, ParamError};

/// Range of the share of the diffuse part, and of its colour.
const SHARE: Rule = Rule::Range([0.0, 1.0]);

/// Unchecked diffuse part, and the checked parameters of the model that it is added to. Set the fields that differ from the default, and
/// pass the description to [`WithDiffuseParams::new`].
///
/// - Default: the model's default parameters, no diffuse part, and white as its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct WithDiffuseDesc<P> {
    /// Parameters of the model.
    pub fiber: P,
    /// Share of the light that the diffuse part takes from the model, in `[0, 1]`.
    pub diffuse: f32,
    /// Colour of the diffuse part, linear RGB in `[0, 1]`.
    pub diffuse_color: [f32; 3],
}

impl<P: Default> Default for WithDiffuseDesc<P> {
    #[inline]
    fn default() -> Self {
        Self {
            fiber: P::default(),
            diffuse: 0.0,
            diffuse_color: [1.0; 3],
        }
    }
}

/// Parameters of a model with a diffuse part that have passed all checks.
///
/// ```
/// use hairis::HairParams;
/// use hairis_variants::{WithDiffuseDesc, WithDiffuseParams};
/// let desc = WithDiffuseDesc { fiber: HairParams::brown(), diffuse: 1.5, ..WithDiffuseDesc::default() };
/// let refused = WithDiffuseParams::new(&desc).unwrap_err();
/// assert_eq!(refused.to_string(), "diffuse must be in [0, 1], got 1.5");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        try_from = "WithDiffuseDesc<P>",
        into = "WithDiffuseDesc<P>",
        bound(
            serialize = "P: Copy + serde::Serialize",
            deserialize = "P: Copy + serde::Deserialize<'de>"
        )
    )
)]
pub struct WithDiffuseParams<P>(WithDiffuseDesc<P>);

impl<P: Copy> WithDiffuseParams<P> {
    /// Checks `desc` and makes parameters from it.
    ///
    /// # Errors
    ///
    /// Returns an error for the first field outside its range (see [`WithDiffuseDesc`]), with its value; NaN and infinities are always
    /// rejected.
    #[inline]
    pub fn new(desc: &WithDiffuseDesc<P>) -> Result<Self, ParamError> {
        check_diffuse(desc.diffuse, &desc.diffuse_color)?;
        Ok(Self(*desc))
    }
}

impl<P> WithDiffuseParams<P> {
    /// Returns the description with the values that were checked.
    #[inline]
    #[must_use]
    pub const fn desc(&self) -> &WithDiffuseDesc<P> {
        &self.0
    }
}

#[cfg(feature = "serde")]
impl<P: Copy> TryFrom<WithDiffuseDesc<P>> for WithDiffuseParams<P> {
    type Error = ParamError;

    #[inline]
    fn try_from(desc: WithDiffuseDesc<P>) -> Result<Self, ParamError> {
        Self::new(&desc)
    }
}

#[cfg(feature = "serde")]
impl<P> From<WithDiffuseParams<P>> for WithDiffuseDesc<P> {
    #[inline]
    fn from(params: WithDiffuseParams<P>) -> Self {
        params.0
    }
}

/// Checks the share and the colour of a diffuse part.
pub(crate) fn check_diffuse(diffuse: f32, color: &[f32; 3]) -> Result<(), ParamError> {
    SHARE.check("diffuse", &[diffuse])?;
    SHARE.check("diffuse_color", color)
}

/// Fields of a diffuse part, which follow those of the model, and which d'Eon's far field has of its own.
pub(crate) const OWN: [Field; 2] = [
    Field::new(
        "diffuse",
        Kind::Number,
        SHARE,
        "Share of the diffuse lobe in the light.",
    )
    .uniform(0.0, 0.4)
    .optional(),
    Field::new(
        "diffuse_color",
        Kind::Rgb,
        SHARE,
        "Colour of the diffuse lobe.",
    )
    .uniform(0.1, 0.9)
    .optional(),
];

/// Largest number of presets.
const PRESETS: usize = 16;

impl<P: Parameters> WithDiffuseParams<P> {
    const ALL_FIELDS: [Field; Values::<f32>::MOST] = {
        let mut place = 0;
        while place < P::FIELDS.len() {
            let name = P::FIELDS[place].name;
            assert!(
                name.len() < 7 || !matches!(name.as_bytes().split_at(7).0, b"diffuse"),
                "the model has a diffuse part of its own"
            );
            place += 1;
        }
        appended(P::FIELDS, &OWN)
    };

    /// Presets of the model, each with a fifth of the light in a diffuse part, and the first of them again.
    const ALL_PRESETS: [(&'static str, Self); PRESETS] = {
        let mut all = [Self::preset(0); PRESETS];
        let mut place = 0;
        while place < P::PRESETS.len() {
            all[place] = Self::preset(place);
            place += 1;
        }
        all
    };

    const fn preset(place: usize) -> (&'static str, Self) {
        let (name, fiber) = P::PRESETS[place];
        let desc = WithDiffuseDesc {
            fiber,
            diffuse: 0.2,
            diffuse_color: [0.5, 0.35, 0.25],
        };
        (name, Self(desc))
    }
}

/// Parameters of models that the registry may have with a diffuse part.
///
/// A model outside this crate implements the trait by a list of [`WithDiffuseParams`] of its own, in the order of its presets.
pub trait DiffusePresets: Parameters {
    /// Presets of the model with a diffuse part.
    const WITH_DIFFUSE: &'static [(&'static str, WithDiffuseParams<Self>)];
}

/// Implements [`DiffusePresets`] by the presets of the parameters, where the type is known: a generic type might hold cells, of which no
/// constant may keep a reference.
macro_rules! with_presets {
    ($($Params:ty)*) => { $(
        impl DiffusePresets for $Params {
            const WITH_DIFFUSE: &'static [(&'static str, WithDiffuseParams<Self>)] =
                WithDiffuseParams::<Self>::ALL_PRESETS.split_at(<Self as Parameters>::PRESETS.len()).0;
        }
    )* };
}
with_presets! { HairParams ChiangParams }

impl<P: DiffusePresets> Parameters for WithDiffuseParams<P> {
    const FIELDS: &'static [Field] = Self::ALL_FIELDS.split_at(P::FIELDS.len() + OWN.len()).0;
    const PRESETS: &'static [(&'static str, Self)] = P::WITH_DIFFUSE;

    #[inline]
    fn values(&self) -> Values {
        let d = self.desc();
        d.fiber
            .values()
            .of_fields(Self::FIELDS)
            .with("diffuse", &[d.diffuse])
            .with("diffuse_color", &d.diffuse_color)
    }

    #[inline]
    fn from_values(values: &Values) -> Result<Self, ParamError> {
        Self::new(&WithDiffuseDesc {
            fiber: P::from_values(&values.of_fields(P::FIELDS))?,
            diffuse: values.number_at(P::FIELDS.len()),
            diffuse_color: values.get_at(P::FIELDS.len() + 1),
        })
    }

    #[inline]
    fn chain(values: &Values, by_kept: &Values<f64>) -> Values<f64> {
        let of_fiber = P::chain(&values.of_fields(P::FIELDS), &by_kept.of_fields(P::FIELDS));
        let mut by = of_fiber.of_fields(Self::FIELDS);
        for own in OWN {
            if by_kept.has(own.name) {
                by = by.with(own.name, by_kept.numbers(own.name));
            }
        }
        by
    }

    /// Scales the model as its own parameters do, and the colour of the diffuse part.
    #[inline]
    fn scaled(&self, factor: f32) -> Result<Self, ParamError> {
        let d = self.desc();
        Self::new(&WithDiffuseDesc {
            fiber: d.fiber.scaled(factor)?,
            diffuse_color: d.diffuse_color.map(|color| color * factor),
            ..*d
        })
    }
}
