//! Parameters as data: the fields of a model by name, for files, command lines, random materials and reports.

mod values;

pub use values::{FieldError, Values};

use core::f32::consts::PI;
use core::fmt;
use hairis::ParamError;
use hairis::params::Rule;

/// Shape of a field's value: one number, several numbers, a colour or a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One number.
    Number,
    /// Several numbers, each with a label.
    Numbers(&'static [&'static str]),
    /// Linear RGB colour, as three numbers.
    Rgb,
    /// One of these words; among the numbers, a word is stored as its place in the list.
    Word(&'static [&'static str]),
}

impl Kind {
    /// Returns the count of numbers that a value of this shape has.
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

/// Range from which random materials draw the numbers of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Draw {
    /// Smallest number, in multiples of `unit`.
    pub least: f32,
    /// Largest number, in multiples of `unit`.
    pub most: f32,
    /// Unit of the range: 1, or a degree in radians.
    pub unit: f32,
    /// True if the logarithm is uniform rather than the number.
    pub log: bool,
}

/// Field of a model's parameters, as files, command lines and hosts present it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field {
    /// Name of the field in files, in a [`ParamError`] and in the description of the model.
    pub name: &'static str,
    /// Shape of the value.
    pub kind: Kind,
    /// Rule that every number of the field obeys; `None` for words.
    pub rule: Option<Rule>,
    /// Unit of the numbers: "rad", or an empty string.
    pub unit: &'static str,
    /// Sentence that describes the field in interfaces and documentation.
    pub doc: &'static str,
    /// True if the field may be left out, and then has the default of the parameters.
    pub optional: bool,
    /// Field that this one may take the place of; exactly one field of such a group is given.
    pub instead_of: Option<&'static str>,
    /// Range of the numbers in random materials; without a range they are not drawn.
    pub draw: Option<Draw>,
    /// True if random materials draw the field after all fields that are not late.
    pub late: bool,
    /// Names of the values in `named`, by which hosts may set a field of numbers.
    pub names: &'static [&'static str],
    /// Values that have a name.
    pub named: &'static [&'static [f32]],
    /// Value of each number in a material whose lobes are so narrow that most directions lie in their tails.
    pub narrow: Option<f32>,
}

impl Field {
    /// Makes a field of numbers that obey `rule`. The field is required, has no unit, and is not drawn in random materials.
    #[inline]
    #[must_use]
    pub const fn new(name: &'static str, kind: Kind, rule: Rule, doc: &'static str) -> Self {
        Self {
            rule: Some(rule),
            ..Self::word(name, kind, doc)
        }
    }

    /// Makes a field of words. The field is required, and random materials draw one of its words.
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
            names: &[],
            named: &[],
            narrow: None,
        }
    }

    /// Declares that the numbers of the field are angles in radians.
    #[inline]
    #[must_use]
    pub const fn radians(self) -> Self {
        Self {
            unit: "rad",
            ..self
        }
    }

    /// Returns the range of accepted numbers, for instance for a slider of an interface, or `None` for words.
    #[inline]
    #[must_use]
    pub const fn range(&self) -> Option<[f32; 2]> {
        match self.rule {
            Some(rule) => Some(rule.range()),
            None => None,
        }
    }

    /// Declares that the field may be left out, in which case it has its default.
    #[inline]
    #[must_use]
    pub const fn optional(self) -> Self {
        Self {
            optional: true,
            ..self
        }
    }

    /// Returns true if the field may be left out and random materials leave it as it is: a tint, a factor or a word that everyday hair does
    /// not need. Fits and controls leave it alone as well.
    #[inline]
    #[must_use]
    pub const fn is_extra(&self) -> bool {
        self.optional && self.draw.is_none()
    }

    /// Declares that this field may take the place of `field`, so that exactly one of them is given.
    #[inline]
    #[must_use]
    pub const fn instead_of(self, field: &'static str) -> Self {
        Self {
            instead_of: Some(field),
            ..self
        }
    }

    /// Sets the range of random materials to `[least, most]`, over which each number is uniform.
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

    /// Sets the range of random materials to `[least, most]`, over which the logarithm of each number is uniform.
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

    /// Declares that the range of random materials is in degrees; the values themselves stay in radians.
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

    /// Declares that random materials draw this field after the fields that are not late.
    #[inline]
    #[must_use]
    pub const fn late(self) -> Self {
        Self { late: true, ..self }
    }

    /// Gives names to values of the field, each with as many numbers as the field has.
    #[inline]
    #[must_use]
    pub const fn named(
        self,
        names: &'static [&'static str],
        named: &'static [&'static [f32]],
    ) -> Self {
        Self {
            names,
            named,
            ..self
        }
    }

    /// Sets the value that every number of the field has where lobes are to be narrow.
    #[inline]
    #[must_use]
    pub const fn narrow(self, narrow: f32) -> Self {
        Self {
            narrow: Some(narrow),
            ..self
        }
    }

    /// Finds the field that `error` refers to, and which of its numbers is at fault if the field has several. Returns `None` if no field
    /// has the name in the error.
    #[inline]
    #[must_use]
    pub fn refused<'a>(
        fields: &'a [Self],
        error: &ParamError,
    ) -> Option<(&'a Self, Option<usize>)> {
        let field = fields.iter().find(|field| field.name == error.field())?;
        Some((field, error.number()))
    }

    /// Returns true if the two fields may only be given in place of each other.
    #[inline]
    fn excludes(&self, other: &Self) -> bool {
        let head = |field: &Self| field.instead_of.unwrap_or(field.name);
        self.name != other.name && head(self) == head(other)
    }
}

/// Returns the fields of a model followed by the fields of what is added to it, and then the first of these again.
pub(crate) const fn appended(fields: &[Field], own: &[Field]) -> [Field; Values::<f32>::MOST] {
    let mut all = [own[0]; Values::<f32>::MOST];
    let mut place = 0;
    while place < fields.len() + own.len() {
        all[place] = if place < fields.len() {
            fields[place]
        } else {
            own[place - fields.len()]
        };
        place += 1;
    }
    all
}

/// Checked parameters of a model, with the fields that they are made of.
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
    /// Fields of the parameters, in the order of files: at most [`Values::MOST`] of them, with at most as many numbers in all.
    const FIELDS: &'static [Field];
    /// Parameters by name. The first of them are the material of this project's figures.
    const PRESETS: &'static [(&'static str, Self)];

    /// Returns the values of the fields. Of fields that replace each other, only the one that the parameters store has a value.
    fn values(&self) -> Values;

    /// Makes parameters from the values of all fields after checking them. Of fields that replace each other, one value is enough.
    ///
    /// # Errors
    ///
    /// Returns an error for the first value out of its range; [`Field::refused`] finds the field that the error refers to.
    fn from_values(values: &Values) -> Result<Self, ParamError>;

    /// Turns derivatives by the fields that the parameters keep into derivatives by the fields of `values`, by the chain rule.
    ///
    /// If `values` has a field in place of one that the parameters keep, the result has the derivatives by that field. Fields on which
    /// the replaced one then depends get the rest: the absorption of a colour depends on the roughness. Provided: `by_kept` as it is,
    /// for parameters without such fields.
    ///
    /// ```
    /// use hairis_variants::{ChiangParams, Parameters, Values};
    /// let values = ChiangParams::default().values().with("melanin", &[1.0, 0.2]);
    /// let by_kept = Values::none(ChiangParams::FIELDS).with("beta_n", &[0.5]).with("sigma_a", &[1.0, 0.0, 0.0]);
    /// let by_fields = ChiangParams::chain(&values, &by_kept);
    /// assert!(by_fields.has("melanin") && !by_fields.has("sigma_a"));
    /// assert!((by_fields.numbers("melanin")[0] - 0.419).abs() < 1e-6); // absorption of red by eumelanin
    /// ```
    #[inline]
    #[must_use]
    fn chain(values: &Values, by_kept: &Values<f64>) -> Values<f64> {
        let _ = values;
        *by_kept
    }

    /// Multiplies every colour that scatters by `factor`; the energy-conserving fibre stays as it is.
    ///
    /// # Errors
    ///
    /// Returns an error if `factor` is negative or not finite, or if a product overflows.
    fn scaled(&self, factor: f32) -> Result<Self, ParamError>;
}
