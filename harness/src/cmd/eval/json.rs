//! JSON with the path of an error.

use super::request::{cut, refusal};
use core::fmt;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_path_to_error::{Segment, Track};
use std::collections::BTreeMap;

/// A JSON value.
#[derive(Clone, Debug, PartialEq, serde::Deserialize)]
#[serde(untagged)]
pub(super) enum Json {
    Null,
    Bool(bool),
    Number(f64),
    Text(String),
    Array(Vec<Json>),
    Object(Entries),
}

/// The fields of an object, in the order of the input and as often as they are given.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entries(Vec<(String, Json)>);

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
    /// Parses a line; a refusal names the innermost field that was being read.
    pub(super) fn parse(line: &str) -> Result<Self, String> {
        if line.trim_ascii().is_empty() {
            return Err(refusal("line", "blank"));
        }
        let mut track = Track::new();
        let mut input = serde_json::Deserializer::from_str(line);
        let tracked = serde_path_to_error::Deserializer::new(&mut input, &mut track);
        let parsed = Self::deserialize(tracked).and_then(|json| input.end().map(|()| json));
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
            let [field, intro] = if path.is_empty() {
                ["line", "not JSON: "]
            } else {
                [&*path, ""]
            };
            refusal(
                field,
                format!("{intro}{problem} (column {})", error.column()),
            )
        })
    }

    /// The text of the object's field `name`, if there is one.
    pub(super) fn peek(&self, name: &str) -> Option<&str> {
        let Self::Object(Entries(entries)) = self else {
            return None;
        };
        entries.iter().find_map(|(field, value)| match value {
            Self::Text(text) if field == name => Some(&**text),
            _ => None,
        })
    }

    /// The fields of an object at `path`, empty for that of the line: all of them `known`, and none given twice.
    pub(super) fn fields(
        self,
        path: &str,
        known: &[&str],
    ) -> Result<BTreeMap<String, Self>, String> {
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
    /// The value as refusals show it, shortened.
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

/// The path of a field of the object at `path`.
pub(super) fn join(path: &str, name: &str) -> String {
    let name = shortened(name);
    if path.is_empty() {
        name
    } else {
        format!("{path}.{name}")
    }
}

/// Enough of a text to recognise it.
pub(super) fn shortened(text: &str) -> String {
    cut(text, 40)
}
