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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_read_as_they_are_written() {
        for text in ["1/1", "3/8", "8/8"] {
            assert_eq!(
                text.parse::<Shard>().map(|shard| shard.to_string()),
                Ok(text.to_owned())
            );
        }
        for text in [
            "5/4",
            "0/4",
            "0/0",
            "x",
            "1",
            "/",
            "1/",
            "/2",
            "-1/2",
            "+1/2",
            "1/2/3",
            "1.0/2",
            " 1/2",
            "99999999999999999999/2",
        ] {
            assert!(text.parse::<Shard>().is_err(), "{text} is no shard");
        }
    }

    #[test]
    fn every_cell_belongs_to_one_shard() {
        for of in [1, 3, 7, 60] {
            for cell in 0..48 {
                assert_eq!(
                    Shard::all(of).filter(|shard| shard.owns(cell)).count(),
                    1,
                    "cell {cell} of {of} shards"
                );
            }
        }
    }
}
