//! JSON values, and refusals that name the path of the field at fault.

use core::fmt;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::de::StrRead;
use serde_path_to_error::{Segment, Track};
use std::collections::BTreeMap;

/// Tolerance of the length of a direction, which is then normalised.
const LENGTH_TOLERANCE: f64 = 1e-3;
/// Tolerance of the length of a unit vector in single precision. Such a vector is not normalised, so that all paths answer
/// for the same direction.
const ROUNDED: f64 = 2e-7;

/// Deserializer of the text that is being read.
type Input<'a> = serde_json::Deserializer<StrRead<'a>>;

/// JSON value that keeps repeated fields of objects, so that they can be rejected.
#[derive(Clone, Debug, PartialEq, serde::Deserialize)]
#[serde(untagged)]
pub enum Json {
    /// `null`.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// Number, in double precision.
    Number(f64),
    /// String.
    Text(String),
    /// Array of values.
    Array(Vec<Json>),
    /// Object with named fields.
    Object(Entries),
}

/// Fields of an object in the order of the input, each as often as the input gives it.
#[derive(Clone, Debug, PartialEq)]
pub struct Entries(Vec<(String, Json)>);

impl<'de> Deserialize<'de> for Entries {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_map(EntriesVisitor)
    }
}

struct EntriesVisitor;

impl<'de> Visitor<'de> for EntriesVisitor {
    type Value = Entries;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entries, A::Error> {
        let mut entries = Vec::new();
        while let Some(entry) = map.next_entry()? {
            entries.push(entry);
        }
        Ok(Entries(entries))
    }
}

impl Json {
    /// Parses a line that holds exactly one value. An error names the innermost field that was being read.
    ///
    /// # Errors
    ///
    /// Returns an error if the line is blank or not JSON.
    pub fn parse(line: &str) -> Result<Self, String> {
        if line.trim_ascii().is_empty() {
            return Err(refusal("line", "blank"));
        }
        let mut input = serde_json::Deserializer::from_str(line);
        Self::next(&mut input, |json, input| input.end().map(|()| json)).map_err(
            |(field, problem, error)| {
                refusal(&field, format!("{problem} (column {})", error.column()))
            },
        )
    }

    /// Parses all values of a text, which may but need not be separated by white space.
    ///
    /// # Errors
    ///
    /// Returns an error if a value of the text is not JSON.
    pub fn parse_all(text: &str) -> Result<Vec<Self>, String> {
        let mut input = serde_json::Deserializer::from_str(text);
        let mut values = Vec::new();
        while input.end().is_err() {
            let value = Self::next(&mut input, |json, _| Ok(json));
            values.push(value.map_err(|(field, problem, error)| {
                let place = format!("line {}, column {}", error.line(), error.column());
                refusal(&field, format!("{problem} ({place})"))
            })?);
        }
        Ok(values)
    }

    /// Parses the next value and passes it to `then`. An error consists of the field that was being read, the problem and the
    /// underlying error.
    fn next<'a>(
        input: &mut Input<'a>,
        then: impl FnOnce(Self, &mut Input<'a>) -> serde_json::Result<Self>,
    ) -> Result<Self, (String, String, serde_json::Error)> {
        let mut track = Track::new();
        let tracked = serde_path_to_error::Deserializer::new(&mut *input, &mut track);
        let parsed = Self::deserialize(tracked).and_then(|json| then(json, input));
        parsed.map_err(|error| {
            let text = error.to_string();
            let problem = text
                .rsplit_once(" at line ")
                .map_or(&*text, |(problem, _)| problem);
            let path = track
                .path()
                .iter()
                .fold(String::new(), |path, segment| match segment {
                    Segment::Map { key } => join(&path, key),
                    Segment::Seq { index } => format!("{path}[{index}]"),
                    _ => path,
                });
            if path.is_empty() {
                ("line".to_owned(), format!("not JSON: {problem}"), error)
            } else {
                (path, problem.to_owned(), error)
            }
        })
    }

    /// Returns the first string in fields called `name`; `None` if there is none or the value is not an object.
    #[must_use]
    pub fn peek(&self, name: &str) -> Option<&str> {
        let Self::Object(Entries(entries)) = self else {
            return None;
        };
        entries.iter().find_map(|(field, value)| match value {
            Self::Text(text) if field == name => Some(&**text),
            _ => None,
        })
    }

    /// Returns the fields of the object at `path`, after checking that all of them are `known` and none is given twice. The path of the
    /// object that a line holds is empty.
    ///
    /// # Errors
    ///
    /// Returns an error if the value is not an object, has an unknown field, or has a field twice.
    pub fn fields(self, path: &str, known: &[&str]) -> Result<BTreeMap<String, Self>, String> {
        let Self::Object(Entries(entries)) = self else {
            let field = if path.is_empty() { "line" } else { path };
            return Err(refusal(field, format!("must be an object, got {self}")));
        };
        let mut fields = BTreeMap::new();
        for (name, value) in entries {
            let at = join(path, &name);
            if !known.contains(&&*name) {
                return Err(refusal(
                    &at,
                    format!("unknown field, expected one of {}", known.join(", ")),
                ));
            }
            if fields.insert(name, value).is_some() {
                return Err(refusal(&at, "given twice"));
            }
        }
        Ok(fields)
    }
}

impl fmt::Display for Json {
    /// Writes the value as error messages show it, shortened.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Null => f.write_str("null"),
            Self::Bool(value) => write!(f, "{value}"),
            Self::Number(value) => write!(f, "{value}"),
            Self::Text(text) => write!(f, "\"{}\"", shortened(text)),
            Self::Array(items) => write!(f, "an array of {}", items.len()),
            Self::Object(_) => f.write_str("an object"),
        }
    }
}

/// Returns the path of the field `name` of the object at `path`.
#[must_use]
pub fn join(path: &str, name: &str) -> String {
    let name = shortened(name);
    if path.is_empty() {
        name
    } else {
        format!("{path}.{name}")
    }
}

/// Returns enough of a text to recognise it.
fn shortened(text: &str) -> String {
    cut(text, 40)
}

/// Formats the refusal of a line: the path of the field at fault, and the problem. Both are cut, so that at most a part of the line is
/// echoed.
#[must_use]
pub fn refusal(field: &str, problem: impl Into<String>) -> String {
    format!("{}: {}", cut(field, 80), cut(&problem.into(), 240))
}

/// Returns a text, cut after the first `longest` characters.
fn cut(text: &str, longest: usize) -> String {
    match text.char_indices().nth(longest) {
        Some((at, _)) => format!("{}...", &text[..at]),
        None => text.to_owned(),
    }
}

/// Returns the index of a string among `words`; `path` names the string in errors.
///
/// # Errors
///
/// Returns an error if the value is not a string, or is none of `words`.
pub fn word(path: &str, json: &Json, words: &[&str]) -> Result<usize, String> {
    let Json::Text(text) = json else {
        return Err(refusal(path, format!("must be a string, got {json}")));
    };
    words.iter().position(|word| word == text).ok_or_else(|| {
        let words: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
        refusal(path, format!("must be {}, got {json}", words.join(" or ")))
    })
}

/// Returns the number that a value holds; `path` names the value in errors.
///
/// # Errors
///
/// Returns an error if the value is not a number.
pub fn number(path: &str, json: &Json) -> Result<f64, String> {
    match json {
        Json::Number(number) => Ok(*number),
        other => Err(refusal(path, format!("must be a number, got {other}"))),
    }
}

/// Returns the `len` numbers that an array holds; `path` names the array in errors.
///
/// # Errors
///
/// Returns an error if the value is not an array of exactly `len` numbers.
pub fn numbers(path: &str, json: &Json, len: usize) -> Result<Vec<f64>, String> {
    match json {
        Json::Array(items) if items.len() == len => items
            .iter()
            .zip(0..)
            .map(|(json, i)| number(&format!("{path}[{i}]"), json))
            .collect(),
        Json::Array(items) => Err(refusal(
            path,
            format!("must have {len} numbers, got {}", items.len()),
        )),
        other => Err(refusal(
            path,
            format!("must be an array of {len} numbers, got {other}"),
        )),
    }
}

/// Returns the offset across the fibre in the field `h`.
///
/// # Errors
///
/// Returns an error if it is not a number in `[-1, 1]`.
pub fn offset(json: &Json) -> Result<f64, String> {
    let h = number("h", json)?;
    if (-1.0..=1.0).contains(&h) {
        Ok(h)
    } else {
        Err(refusal("h", format!("must be in [-1, 1], got {h}")))
    }
}

/// Returns the direction at `path`, normalised unless its length is that of a unit vector in single precision.
///
/// # Errors
///
/// Returns an error if it is not three numbers, or if its length is not 1 to within 1e-3.
pub fn direction(path: &str, json: &Json) -> Result<[f64; 3], String> {
    let numbers = numbers(path, json, 3)?;
    let length = numbers[0].hypot(numbers[1]).hypot(numbers[2]);
    if (length - 1.0).abs() > LENGTH_TOLERANCE {
        return Err(refusal(
            path,
            format!("must be a unit vector (to {LENGTH_TOLERANCE}), got length {length}"),
        ));
    }
    let divisor = if (length - 1.0).abs() <= ROUNDED {
        1.0
    } else {
        length
    };
    Ok([0, 1, 2].map(|row| numbers[row] / divisor))
}

/// Returns the nearest number of single precision, or an infinity if `x` is too large for it.
#[expect(
    clippy::cast_possible_truncation,
    reason = "single precision is what is asked for"
)]
#[must_use]
pub fn single(x: f64) -> f32 {
    x as f32
}
