//! Values of fields as plain data, whatever the model.

use super::{Field, Kind};
use core::fmt;

/// Error of [`Values::set`] and [`Values::set_word`], which says what does not fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FieldError {
    /// The model has no field of this name.
    Name,
    /// The field has this count of numbers, and another count was given.
    Count(usize),
    /// The field has these words, and none of them was given; the list is empty for a field of numbers without named values.
    Word(&'static [&'static str]),
}

impl fmt::Display for FieldError {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Name => f.write_str("the model has no such field"),
            Self::Count(count) => write!(f, "the field must have {count} numbers"),
            Self::Word([]) => f.write_str("the field has numbers and no words"),
            Self::Word(words) => write!(f, "the field must be one of {words:?}"),
        }
    }
}

impl core::error::Error for FieldError {}

/// Values of a model's fields as plain data. Parameters are made from single precision, and the formulas accept any type of number.
#[derive(Clone, Copy, Debug)]
pub struct Values<T = f32> {
    fields: &'static [Field],
    numbers: [T; MOST],
    given: u32,
}

const MOST: usize = 48;

impl<T: Copy + Default> Values<T> {
    /// Returns values of which no field has been set yet.
    #[inline]
    #[must_use]
    pub fn none(fields: &'static [Field]) -> Self {
        Self {
            fields,
            numbers: [T::default(); MOST],
            given: 0,
        }
    }
}

impl<T: Copy> Values<T> {
    /// Converts the numbers of every field, for instance to another precision.
    #[inline]
    #[must_use]
    pub fn map<U>(&self, convert: impl FnMut(T) -> U) -> Values<U> {
        Values {
            fields: self.fields,
            numbers: self.numbers.map(convert),
            given: self.given,
        }
    }

    /// Returns the values as those of other fields: of the first fields alone, or of these fields and others after them.
    #[inline]
    pub(crate) const fn of_fields(&self, fields: &'static [Field]) -> Self {
        let most = (1 << fields.len()) - 1;
        Self {
            fields,
            given: self.given & most,
            ..*self
        }
    }

    /// Returns the fields that the values belong to.
    #[inline]
    #[must_use]
    pub const fn fields(&self) -> &'static [Field] {
        self.fields
    }

    /// Sets the numbers of the field `name`, and removes the values of the fields that it takes the place of.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no such field, or if it has another count of numbers.
    #[inline]
    pub fn set(&mut self, name: &str, numbers: &[T]) -> Result<(), FieldError> {
        let index = self.index(name).ok_or(FieldError::Name)?;
        self.set_at(index, numbers)
    }

    /// Sets the numbers of the field at `index`, as [`set`](Self::set) does by name.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no such field, or if it has another count of numbers.
    #[inline]
    pub fn set_at(&mut self, index: usize, numbers: &[T]) -> Result<(), FieldError> {
        let field = self.fields.get(index).ok_or(FieldError::Name)?;
        let count = field.kind.width();
        if numbers.len() != count {
            return Err(FieldError::Count(count));
        }
        let at = self.offset(index);
        self.numbers[at..at + count].copy_from_slice(numbers);
        for (other, of) in self.fields.iter().enumerate() {
            if field.excludes(of) {
                self.given &= !(1 << other);
            }
        }
        self.given |= 1 << index;
        Ok(())
    }

    /// Returns the values with these numbers for the field `name`: see [`set`](Self::set).
    ///
    /// # Panics
    ///
    /// Panics if there is no such field, or if it has another count of numbers.
    #[inline]
    #[must_use]
    pub fn with(mut self, name: &str, numbers: &[T]) -> Self {
        self.set(name, numbers)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        self
    }

    /// Returns the values with the value of the field `name` removed.
    ///
    /// # Panics
    ///
    /// Panics if there is no such field.
    #[inline]
    #[must_use]
    pub fn without(mut self, name: &str) -> Self {
        self.given &= !(1 << self.known(name));
        self
    }

    /// Returns true if the field `name` has a value.
    ///
    /// # Panics
    ///
    /// Panics if there is no such field.
    #[inline]
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.has_at(self.known(name))
    }

    /// Returns the numbers of the field `name`. They are 0 if the field was never set; a removed value leaves its numbers behind.
    ///
    /// # Panics
    ///
    /// Panics if there is no such field.
    #[inline]
    #[must_use]
    pub fn numbers(&self, name: &str) -> &[T] {
        self.numbers_at(self.known(name))
    }

    /// Returns true if the field at `index` has a value, and false if there is no such field.
    #[inline]
    #[must_use]
    pub const fn has_at(&self, index: usize) -> bool {
        index < MOST && self.given >> index & 1 == 1
    }

    /// Returns the numbers of the field at `index`, as [`numbers`](Self::numbers) does by name.
    ///
    /// # Panics
    ///
    /// Panics if there is no such field.
    #[inline]
    #[must_use]
    pub fn numbers_at(&self, index: usize) -> &[T] {
        let at = self.offset(index);
        &self.numbers[at..at + self.fields[index].kind.width()]
    }

    /// Returns the `N` numbers of the field `name` as an array: see [`numbers`](Self::numbers).
    ///
    /// # Panics
    ///
    /// Panics if there is no such field, or if it has another count of numbers.
    #[inline]
    #[must_use]
    pub fn get<const N: usize>(&self, name: &str) -> [T; N] {
        self.get_at(self.known(name))
    }

    /// Returns the `N` numbers of the field at `index` as an array: see [`numbers`](Self::numbers).
    ///
    /// # Panics
    ///
    /// Panics if there is no such field, or if it has another count of numbers.
    #[inline]
    #[must_use]
    pub fn get_at<const N: usize>(&self, index: usize) -> [T; N] {
        let Ok(numbers) = self.numbers_at(index).try_into() else {
            panic!("the field has another count of numbers")
        };
        numbers
    }

    /// Returns the only number of the field at `index`: see [`numbers`](Self::numbers).
    ///
    /// # Panics
    ///
    /// Panics if there is no such field, or if it has several numbers.
    #[inline]
    #[must_use]
    pub fn number_at(&self, index: usize) -> T {
        let [number] = self.get_at(index);
        number
    }

    /// Returns the index of the field `name`, or `None` if there is no such field.
    // Inlined at every field of every model, this and `offset` would be 30 kB of the C library with every sampler.
    #[inline(never)]
    #[must_use]
    pub fn index(&self, name: &str) -> Option<usize> {
        self.fields.iter().position(|field| field.name == name)
    }

    /// Returns the index of the field `name`, which must exist.
    #[inline]
    fn known(&self, name: &str) -> usize {
        self.index(name).expect("a field of the model")
    }

    /// Returns the place of the field's first number among all numbers.
    #[inline(never)]
    fn offset(&self, index: usize) -> usize {
        let before = &self.fields[..index];
        before.iter().map(|field| field.kind.width()).sum()
    }
}

impl Values {
    /// Largest count of numbers that a model may have, and of fields.
    pub const MOST: usize = MOST;

    /// Sets the word of the field `name`, or the numbers that a field of numbers has by this name, and removes the values of the fields
    /// that it takes the place of.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no such field, or if it has no such word.
    #[inline]
    pub fn set_word(&mut self, name: &str, word: &str) -> Result<(), FieldError> {
        let index = self.index(name).ok_or(FieldError::Name)?;
        let field = &self.fields[index];
        let Kind::Word(words) = field.kind else {
            let mut named = field.names.iter().zip(field.named);
            let found = named.find(|(one, _)| **one == word);
            let (_, numbers) = found.ok_or(FieldError::Word(field.names))?;
            return self.set_at(index, numbers);
        };
        let mut places = words.iter().zip(0_u8..);
        let place = places.find(|(one, _)| **one == word);
        let (_, place) = place.ok_or(FieldError::Word(words))?;
        self.set_at(index, &[f32::from(place)])
    }

    /// Returns the values with this word for the field `name`: see [`set_word`](Self::set_word).
    ///
    /// # Panics
    ///
    /// Panics if there is no such field, or if it has no such word.
    #[inline]
    #[must_use]
    pub fn with_word(mut self, name: &str, word: &str) -> Self {
        self.set_word(name, word)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        self
    }

    /// Returns the word of the field `name`, or its first word if the field was never set.
    ///
    /// # Panics
    ///
    /// Panics if there is no such field, or if it has no words.
    #[inline]
    #[must_use]
    pub fn word(&self, name: &str) -> &'static str {
        let Kind::Word(words) = self.fields[self.known(name)].kind else {
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

/// Compares the fields that have a value: what a replaced field left behind does not count.
impl<T: Copy + PartialEq> PartialEq for Values<T> {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        let mut places = 0..self.fields.len();
        let is_same = |place| self.numbers_at(place) == other.numbers_at(place);
        self.fields == other.fields
            && self.given == other.given
            && places.all(|place| !self.has_at(place) || is_same(place))
    }
}
