//! Tables by columns, written as CSV and, with feature `parquet`, as Apache Parquet. Both have the same content, and the same bytes
//! each time.

#[cfg(feature = "parquet")]
mod parquet;

use crate::stats::Estimate;
use std::borrow::Cow;
use std::io::{self, Write};

/// Values of a column.
#[derive(Clone, Debug, PartialEq)]
enum ColumnValues {
    /// Words, as UTF-8.
    Text(Vec<Cow<'static, str>>),
    /// Counts, as 32-bit integers.
    Whole(Vec<i32>),
    /// Numbers in double precision; a number that is not finite is missing, as an empty field in CSV and a null in Parquet.
    Number(Vec<f64>),
}

impl ColumnValues {
    fn len(&self) -> usize {
        match self {
            Self::Text(values) => values.len(),
            Self::Whole(values) => values.len(),
            Self::Number(values) => values.len(),
        }
    }

    /// Returns the value at `row` as a field of CSV.
    fn field(&self, row: usize) -> Cow<'_, str> {
        match self {
            Self::Text(values) => field_of(&values[row]),
            Self::Whole(values) => values[row].to_string().into(),
            // Shortest digits that read back as the same number, with an exponent for numbers far from 1.
            Self::Number(values) if values[row].is_finite() => format!("{:?}", values[row]).into(),
            Self::Number(_) => "".into(),
        }
    }
}

/// Returns a text as a field of CSV.
fn field_of(text: &str) -> Cow<'_, str> {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\"")).into()
    } else {
        text.into()
    }
}

/// Table of named columns, all of which have the same length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns(Vec<(Cow<'static, str>, ColumnValues)>);

impl Columns {
    fn with(mut self, name: impl Into<Cow<'static, str>>, values: ColumnValues) -> Self {
        let name = name.into();
        debug_assert!(
            self.0.iter().all(|(_, first)| first.len() == values.len()),
            "{name} has another length"
        );
        self.0.push((name, values));
        self
    }

    /// Adds a column of numbers, of which those that are not finite count as missing.
    #[must_use]
    pub fn number(
        self,
        name: impl Into<Cow<'static, str>>,
        values: impl IntoIterator<Item = f64>,
    ) -> Self {
        self.with(name, ColumnValues::Number(values.into_iter().collect()))
    }

    /// Adds a column of figures, and a second one of their standard errors with `_se` appended to its name.
    #[must_use]
    pub fn estimate(self, name: &str, values: impl IntoIterator<Item = Estimate>) -> Self {
        let (figures, errors): (Vec<f64>, Vec<f64>) = values
            .into_iter()
            .map(|of| (of.value, of.standard_error))
            .unzip();
        self.number(name.to_owned(), figures)
            .number(format!("{name}_se"), errors)
    }

    /// Adds a column of counts, written as 32-bit integers; larger counts are clamped to the largest.
    #[must_use]
    pub fn whole(self, name: &'static str, values: impl IntoIterator<Item = usize>) -> Self {
        let count = |value: usize| i32::try_from(value).unwrap_or(i32::MAX);
        self.with(
            name,
            ColumnValues::Whole(values.into_iter().map(count).collect()),
        )
    }

    /// Adds a column of words, which are quoted in CSV where necessary.
    #[must_use]
    pub fn text<S: Into<Cow<'static, str>>>(
        self,
        name: &'static str,
        values: impl IntoIterator<Item = S>,
    ) -> Self {
        self.with(
            name,
            ColumnValues::Text(values.into_iter().map(Into::into).collect()),
        )
    }

    /// Writes the table as CSV (RFC 4180, but with line ends as on Unix), with the names of the columns first.
    ///
    /// # Errors
    ///
    /// Returns the errors of `out`.
    pub fn write_csv(&self, out: &mut impl Write) -> io::Result<()> {
        let names: Vec<_> = self.0.iter().map(|(name, _)| field_of(name)).collect();
        writeln!(out, "{}", names.join(","))?;
        for row in 0..self.0.first().map_or(0, |(_, values)| values.len()) {
            let fields: Vec<Cow<'_, str>> =
                self.0.iter().map(|(_, values)| values.field(row)).collect();
            writeln!(out, "{}", fields.join(","))?;
        }
        Ok(())
    }
}
