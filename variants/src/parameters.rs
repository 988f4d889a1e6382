//! Parameters as data: the fields of a model by name, for files, command lines, random materials and reports.

mod values;

pub use values::{FieldError, Values};

use core::f32::consts::PI;
use core::fmt;
use hairis::ParamError;
use hairis::params::Rule;

/// Shape of a field's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Number,
    /// Numbers, each with a label.
    Numbers(&'static [&'static str]),
    /// Linear red, green and blue.
    Rgb,
    /// One of these words; among numbers, its place in the list.
    Word(&'static [&'static str]),
}

impl Kind {
    /// Count of numbers.
    #[inline]
    #[must_use]
    pub const fn width(self) -> usize {
        match self {
            Self::Number | Self::Word(_) => 1,
            Self::Numbers(names) => names.len(),
            Self::Rgb => 3,
        }
    }
}

/// Range of a field's numbers in random materials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Draw {
    /// Smallest number, in units.
    pub least: f32,
    /// Largest number, in units.
    pub most: f32,
    /// Unit: 1, or a degree in radians.
    pub unit: f32,
    /// Whether the logarithm is uniform, and not the number.
    pub log: bool,
}

/// A field of a model's parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field {
    /// Name in files, in a [`ParamError`], and of the field of the description.
    pub name: &'static str,
    /// Shape of the value.
    pub kind: Kind,
    /// The rule that every number obeys; `None` for words.
    pub rule: Option<Rule>,
    /// Unit of the numbers: "rad", or nothing.
    pub unit: &'static str,
    /// A sentence for interfaces and documentation.
    pub doc: &'static str,
    /// Whether it may be left out; its default is that of the parameters.
    pub optional: bool,
    /// The field it may take the place of: exactly one of such a group is given.
    pub instead_of: Option<&'static str>,
    /// Range in random materials, which otherwise have the default.
    pub draw: Option<Draw>,
    /// Whether random materials draw it after all other fields.
    pub late: bool,
    /// Every number of it in a material whose lobes are so narrow that most directions lie in their tails.
    pub narrow: Option<f32>,
}

impl Field {
    /// A field of numbers that obey `rule`: required, without a unit, and not drawn.
    #[inline]
    #[must_use]
    pub const fn new(name: &'static str, kind: Kind, rule: Rule, doc: &'static str) -> Self {
        Self {
            rule: Some(rule),
            ..Self::word(name, kind, doc)
        }
    }

    /// A field of words: required, and drawn as any other.
    #[inline]
    #[must_use]
    pub const fn word(name: &'static str, kind: Kind, doc: &'static str) -> Self {
        Self {
            name,
            kind,
            rule: None,
            unit: "",
            doc,
            optional: false,
            instead_of: None,
            draw: None,
            late: false,
            narrow: None,
        }
    }

    /// With numbers in radians.
    #[inline]
    #[must_use]
    pub const fn radians(self) -> Self {
        Self {
            unit: "rad",
            ..self
        }
    }

    /// The range of the numbers that are accepted: an interface's slider. `None` for words.
    #[inline]
    #[must_use]
    pub const fn range(&self) -> Option<[f32; 2]> {
        match self.rule {
            Some(rule) => Some(rule.range()),
            None => None,
        }
    }

    /// May be left out.
    #[inline]
    #[must_use]
    pub const fn optional(self) -> Self {
        Self {
            optional: true,
            ..self
        }
    }

    /// May take the place of `field`.
    #[inline]
    #[must_use]
    pub const fn instead_of(self, field: &'static str) -> Self {
        Self {
            instead_of: Some(field),
            ..self
        }
    }

    /// Uniform over `[least, most]` in random materials.
    #[inline]
    #[must_use]
    pub const fn uniform(self, least: f32, most: f32) -> Self {
        Self {
            draw: Some(Draw {
                least,
                most,
                unit: 1.0,
                log: false,
            }),
            ..self
        }
    }

    /// Uniform in its logarithm over `[least, most]` in random materials.
    #[inline]
    #[must_use]
    pub const fn log_uniform(self, least: f32, most: f32) -> Self {
        Self {
            draw: Some(Draw {
                least,
                most,
                unit: 1.0,
                log: true,
            }),
            ..self
        }
    }

    /// With the range of random materials in degrees; the value stays in radians.
    #[inline]
    #[must_use]
    pub const fn degrees(self) -> Self {
        let draw = match self.draw {
            Some(draw) => Some(Draw {
                unit: PI / 180.0,
                ..draw
            }),
            None => None,
        };
        Self { draw, ..self }
    }

    /// In random materials, drawn after the fields that are not late.
    #[inline]
    #[must_use]
    pub const fn late(self) -> Self {
        Self { late: true, ..self }
    }

    /// With `narrow` for every number where lobes are to be narrow.
    #[inline]
    #[must_use]
    pub const fn narrow(self, narrow: f32) -> Self {
        Self {
            narrow: Some(narrow),
            ..self
        }
    }

    /// The place that `error` refuses: the field, and which of its numbers if it has several.
    #[inline]
    #[must_use]
    pub fn refused<'a>(
        fields: &'a [Self],
        error: &ParamError,
    ) -> Option<(&'a Self, Option<usize>)> {
        let field = fields.iter().find(|field| field.name == error.field())?;
        Some((field, error.number()))
    }

    /// Whether both may be given only in place of each other.
    #[inline]
    fn excludes(&self, other: &Self) -> bool {
        let head = |field: &Self| field.instead_of.unwrap_or(field.name);
        self.name != other.name && head(self) == head(other)
    }
}

/// Checked parameters of a model, with the fields they are made of.
///
/// ```
/// use hairis::HairParams;
/// use hairis_variants::{Field, Parameters};
/// let values = HairParams::red().values().with("beta", &[0.1, 0.0, 0.2]);
/// let error = HairParams::from_values(&values).expect_err("a width of 0");
/// assert_eq!(error.to_string(), "beta[1] must be a width in [1e-4, pi] rad, got 0");
/// let (field, number) = Field::refused(HairParams::FIELDS, &error).expect("a field of the model");
/// assert_eq!((field.name, number), ("beta", Some(1)));
/// ```
pub trait Parameters: Copy + fmt::Debug + Default + PartialEq + Send + Sync + 'static {
    /// Every field, in the order of files: at most [`Values::MOST`] fields, and numbers in all.
    const FIELDS: &'static [Field];
    /// Named parameters. The figures of this project are those of the first.
    const PRESETS: &'static [(&'static str, Self)];

    /// The values. Of fields that stand for one another, only the one the parameters keep.
    fn values(&self) -> Values;

    /// Checks values of every field, but for those that others stand for.
    ///
    /// # Errors
    ///
    /// The first value out of its range; [`Field::refused`] finds its place.
    fn from_values(values: &Values) -> Result<Self, ParamError>;

    /// Multiplies every colour that scatters by `factor`; the energy-conserving fibre stays as it is.
    ///
    /// # Errors
    ///
    /// If `factor` is negative or not finite, or a product overflows.
    fn scaled(&self, factor: f32) -> Result<Self, ParamError>;
}
