//! Parameters as data: the fields of a model by name, for files, command lines, random materials and reports.

use core::f32::consts::PI;
use core::fmt::Debug;
use hairis::ParamError;

/// Shape of a field's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Number,
    /// Numbers, each with the name that a [`ParamError`] gives it.
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
    /// Name in files.
    pub name: &'static str,
    /// Name in a [`ParamError`], unless [`Kind::Numbers`] gives one for each number.
    pub alias: &'static str,
    /// Shape of the value.
    pub kind: Kind,
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
    /// A field that is required, not drawn, and of one name everywhere.
    #[inline]
    #[must_use]
    pub const fn new(name: &'static str, kind: Kind) -> Self {
        Self {
            name,
            alias: name,
            kind,
            optional: false,
            instead_of: None,
            draw: None,
            late: false,
            narrow: None,
        }
    }

    /// With another name in a [`ParamError`].
    #[inline]
    #[must_use]
    pub const fn alias(self, alias: &'static str) -> Self {
        Self { alias, ..self }
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

    /// The place that `error` refuses: the field, and which of its numbers if the error names one.
    #[inline]
    #[must_use]
    pub fn refused<'a>(
        fields: &'a [Self],
        error: &ParamError,
    ) -> Option<(&'a Self, Option<usize>)> {
        let name = error.field();
        fields.iter().find_map(|field| match field.kind {
            Kind::Numbers(names) if field.alias != name => {
                Some((field, Some(names.iter().position(|n| *n == name)?)))
            }
            _ if field.alias != name => None,
            _ => Some((field, channel(error))),
        })
    }
}

/// The channel of a colour that `error` refuses.
#[inline]
fn channel(error: &ParamError) -> Option<usize> {
    match error {
        ParamError::Intensity(_, channel, _) | ParamError::Overflow(_, channel, _) => {
            Some(*channel)
        }
        _ => None,
    }
}

/// Values of fields: plain data, whatever the model. Parameters are made of single precision; the formulas take any.
#[derive(Clone, Copy, Debug)]
pub struct Values<T = f32> {
    fields: &'static [Field],
    numbers: [T; MOST],
    given: u32,
}

const MOST: usize = 32;

impl<T: Copy + Default> Values<T> {
    /// No value yet.
    #[inline]
    #[must_use]
    pub fn none(fields: &'static [Field]) -> Self {
        Self {
            fields,
            numbers: [T::default(); MOST],
            given: 0,
        }
    }

    /// The same fields with every number converted.
    #[inline]
    #[must_use]
    pub fn map<U>(&self, convert: impl FnMut(T) -> U) -> Values<U> {
        Values {
            fields: self.fields,
            numbers: self.numbers.map(convert),
            given: self.given,
        }
    }

    /// The fields.
    #[inline]
    #[must_use]
    pub const fn fields(&self) -> &'static [Field] {
        self.fields
    }

    /// With a value for the field `name`: as many numbers as it has.
    ///
    /// # Panics
    ///
    /// If there is no such field, or it has another count of numbers.
    #[inline]
    #[must_use]
    pub fn with(mut self, name: &str, numbers: &[T]) -> Self {
        let (index, at) = self.place(name);
        assert!(
            self.fields[index].kind.width() == numbers.len(),
            "the field has another count of numbers"
        );
        self.numbers[at..at + numbers.len()].copy_from_slice(numbers);
        self.given |= 1 << index;
        self
    }

    /// Without a value for the field `name`.
    ///
    /// # Panics
    ///
    /// If there is no such field.
    #[inline]
    #[must_use]
    pub fn without(mut self, name: &str) -> Self {
        self.given &= !(1 << self.place(name).0);
        self
    }

    /// Whether the field `name` has a value.
    ///
    /// # Panics
    ///
    /// If there is no such field.
    #[inline]
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.given >> self.place(name).0 & 1 == 1
    }

    /// The numbers of the field `name`, 0 if it has no value.
    ///
    /// # Panics
    ///
    /// If there is no such field.
    #[inline]
    #[must_use]
    pub fn numbers(&self, name: &str) -> &[T] {
        let (index, at) = self.place(name);
        &self.numbers[at..at + self.fields[index].kind.width()]
    }

    /// The `N` numbers of the field `name`: see [`numbers`](Self::numbers).
    ///
    /// # Panics
    ///
    /// If there is no such field, or it has another count of numbers.
    #[inline]
    #[must_use]
    pub fn get<const N: usize>(&self, name: &str) -> [T; N] {
        let Ok(numbers) = self.numbers(name).try_into() else {
            panic!("the field has another count of numbers")
        };
        numbers
    }

    /// Index of the field `name`, and where its numbers begin.
    #[inline]
    fn place(&self, name: &str) -> (usize, usize) {
        let index = self
            .fields
            .iter()
            .position(|field| field.name == name)
            .expect("a field of the model");
        (
            index,
            self.fields[..index]
                .iter()
                .map(|field| field.kind.width())
                .sum(),
        )
    }
}

impl Values {
    /// Largest count of numbers of a model, and of its fields.
    pub const MOST: usize = MOST;

    /// With a word for the field `name`.
    ///
    /// # Panics
    ///
    /// If there is no such field, or it has no such word.
    #[inline]
    #[must_use]
    pub fn with_word(self, name: &str, word: &str) -> Self {
        let (index, _) = self.place(name);
        let Kind::Word(words) = self.fields[index].kind else {
            panic!("not a field of words")
        };
        let place = words
            .iter()
            .zip(0_u8..)
            .find(|(one, _)| **one == word)
            .expect("a word of the field")
            .1;
        self.with(name, &[f32::from(place)])
    }

    /// The word of the field `name`, its first if it has no value.
    ///
    /// # Panics
    ///
    /// If there is no such field, or it has no words.
    #[inline]
    #[must_use]
    pub fn word(&self, name: &str) -> &'static str {
        let Kind::Word(words) = self.fields[self.place(name).0].kind else {
            panic!("not a field of words")
        };
        let [number] = self.get(name);
        words
            .iter()
            .zip(0_u8..)
            .find(|(_, place)| f32::from(*place) == number)
            .map_or(words[0], |(word, _)| word)
    }
}

impl<T: PartialEq> PartialEq for Values<T> {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        self.fields == other.fields && self.given == other.given && self.numbers == other.numbers
    }
}

/// Checked parameters of a model, with the fields they are made of.
///
/// ```
/// use hairis::{HairParams, ParamError};
/// use hairis_variants::{Field, Parameters};
/// let values = HairParams::red().values().with("beta", &[0.1, 0.0, 0.2]);
/// let error = HairParams::from_values(&values).expect_err("a width of 0");
/// assert_eq!(error, ParamError::Width("beta_tt", 0.0));
/// let (field, number) = Field::refused(HairParams::FIELDS, &error).expect("a field of the model");
/// assert_eq!((field.name, number), ("beta", Some(1)));
/// ```
pub trait Parameters: Copy + Debug + Default + PartialEq + Send + Sync + 'static {
    /// Every field, in the order of files: at most [`Values::MOST`] fields, and numbers in all.
    const FIELDS: &'static [Field];
    /// Named parameters.
    const PRESETS: &'static [(&'static str, Self)];

    /// The values. Of fields that stand for one another, only the one the parameters keep.
    fn values(&self) -> Values;

    /// Checks values of every field, but for those that others stand for.
    ///
    /// # Errors
    ///
    /// The first value out of its range; [`Field::refused`] finds its place.
    fn from_values(values: &Values) -> Result<Self, ParamError>;
}
