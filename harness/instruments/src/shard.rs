//! Shards: parts of a study, each of which one of several processes computes.

use core::fmt;
use core::str::FromStr;

/// Part `index` of `of` parts, counted from 1. A part consists of every `of`-th cell, so that all parts take about the same time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    of: usize,
}

impl Shard {
    /// Whole study as its only part.
    pub const WHOLE: Self = Self { index: 1, of: 1 };

    /// Returns all parts of a study that is divided into `of` parts, in order.
    pub fn all(of: usize) -> impl Iterator<Item = Self> {
        (1..=of).map(move |index| Self { index, of })
    }

    /// Returns the number of the part, counted from 1.
    #[must_use]
    pub const fn index(self) -> usize {
        self.index
    }

    /// Returns the number of parts into which the study is divided.
    #[must_use]
    pub const fn of(self) -> usize {
        self.of
    }

    /// Returns true if the cell at `index`, counted from 0, belongs to this part.
    #[must_use]
    pub const fn owns(self, index: usize) -> bool {
        index % self.of == self.index - 1
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.of)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let shape = || format!("must be I/N with whole numbers, such as 2/8, got \"{text}\"");
        let (index, of) = text.split_once('/').ok_or_else(shape)?;
        let digits = |part: &str| {
            part.bytes()
                .all(|b| b.is_ascii_digit())
                .then(|| part.parse().ok())
                .flatten()
        };
        let (index, of): (usize, usize) = digits(index).zip(digits(of)).ok_or_else(shape)?;
        if index == 0 || index > of {
            return Err(format!("I must be from 1 to N, got \"{text}\""));
        }
        Ok(Self { index, of })
    }
}
