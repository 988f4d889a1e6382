//! JSON with the path of an error.

use super::request::Refusal;
use core::fmt;
use serde::Deserializer as _;
use serde::de::{DeserializeSeed, MapAccess, SeqAccess, Visitor};

/// A JSON value. Objects keep the order and the repetitions of their fields, for [`Json::fields`] to check.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Json {
    Null,
    Bool(bool),
    Number(f64),
    Text(String),
    Array(Vec<Json>),
    Object(Vec<(String, Json)>),
}

impl Json {
    /// Parses a line; a refusal names the innermost field that was being read.
    pub(super) fn parse(line: &str) -> Result<Self, Refusal> {
        if line.trim_ascii().is_empty() {
            return Err(Refusal::at("line", "blank"));
        }
        let mut path = String::new();
        let mut input = serde_json::Deserializer::from_str(line);
        let parsed = input.deserialize_any(Node(&mut path)).and_then(|json| input.end().map(|()| json));
        parsed.map_err(|error| {
            let text = error.to_string();
            let problem = text.rsplit_once(" at line ").map_or(&*text, |(problem, _)| problem);
            let column = error.column();
            match &*path {
                "" => Refusal::at("line", format!("not JSON: {problem} (column {column})")),
                field => Refusal::at(field, format!("{problem} (column {column})")),
            }
        })
    }

    /// The fields of an object in the order of `known`, `None` for one that is not there.
    ///
    /// `path` is the object's own, empty for that of the line.
    pub(super) fn fields(self, path: &str, known: &[&str]) -> Result<Vec<Option<Self>>, Refusal> {
        let Self::Object(entries) = self else {
            let field = if path.is_empty() { "line" } else { path };
            return Err(Refusal::at(field, format!("must be an object, got {self}")));
        };
        let mut found = vec![None; known.len()];
        for (name, value) in entries {
            let Some(slot) = known.iter().position(|known| *known == name) else {
                let expected = known.join(", ");
                return Err(Refusal::at(&join(path, &name), format!("unknown field, expected one of {expected}")));
            };
            if found[slot].replace(value).is_some() {
                return Err(Refusal::at(&join(path, &name), "given twice"));
            }
        }
        Ok(found)
    }

    /// The text of the object's field `name`, if there is one.
    pub(super) fn peek(&self, name: &str) -> Option<&str> {
        let Self::Object(entries) = self else { return None };
        entries.iter().find_map(|(field, value)| match value {
            Self::Text(text) if field == name => Some(&**text),
            _ => None,
        })
    }

    /// The text of a field that may be missing.
    pub(super) fn text(json: Option<Self>, field: &str) -> Result<Option<String>, Refusal> {
        match json {
            None => Ok(None),
            Some(Self::Text(text)) => Ok(Some(text)),
            Some(other) => Err(Refusal::at(field, format!("must be a string, got {other}"))),
        }
    }

    /// The number of a field.
    pub(super) fn number(json: Option<Self>, field: &str) -> Result<f64, Refusal> {
        match json {
            None => Err(Refusal::at(field, "missing")),
            Some(Self::Number(number)) => Ok(number),
            Some(other) => Err(Refusal::at(field, format!("must be a number, got {other}"))),
        }
    }

    /// The three numbers of a field.
    pub(super) fn three(json: Option<Self>, field: &str) -> Result<[f64; 3], Refusal> {
        let numbers = Self::numbers(json, field, 3)?;
        Ok([numbers[0], numbers[1], numbers[2]])
    }

    /// The `len` numbers of a field.
    pub(super) fn numbers(json: Option<Self>, field: &str, len: usize) -> Result<Vec<f64>, Refusal> {
        let items = match json {
            None => return Err(Refusal::at(field, "missing")),
            Some(Self::Array(items)) => items,
            Some(other) => return Err(Refusal::at(field, format!("must be an array of {len} numbers, got {other}"))),
        };
        if items.len() != len {
            return Err(Refusal::at(field, format!("must have {len} numbers, got {}", items.len())));
        }
        items.into_iter().zip(0..).map(|(json, i)| Self::number(Some(json), &format!("{field}[{i}]"))).collect()
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
fn join(path: &str, name: &str) -> String {
    let name = shortened(name);
    if path.is_empty() { name } else { format!("{path}.{name}") }
}

/// Enough of a text to recognise it.
pub(super) fn shortened(text: &str) -> String {
    const LEN: usize = 40;
    match text.char_indices().nth(LEN) {
        Some((at, _)) => format!("{}...", &text[..at]),
        None => text.to_owned(),
    }
}

/// A value about to be read, with its path: on success the path is left as it was, on failure as it is.
struct Node<'p>(&'p mut String);

impl<'de> DeserializeSeed<'de> for Node<'_> {
    type Value = Json;

    fn deserialize<D: serde::Deserializer<'de>>(self, deserializer: D) -> Result<Json, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Node<'_> {
    type Value = Json;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("JSON")
    }

    fn visit_unit<E>(self) -> Result<Json, E> {
        Ok(Json::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Json, E> {
        Ok(Json::Bool(value))
    }

    fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<Json, E> {
        if value.is_finite() { Ok(Json::Number(value)) } else { Err(E::custom("not a finite number")) }
    }

    fn visit_u64<E>(self, value: u64) -> Result<Json, E> {
        Ok(Json::Number(value as f64))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Json, E> {
        Ok(Json::Number(value as f64))
    }

    fn visit_str<E>(self, value: &str) -> Result<Json, E> {
        Ok(Json::Text(value.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Json, A::Error> {
        let len = self.0.len();
        let mut items = Vec::new();
        loop {
            self.0.push_str(&format!("[{}]", items.len()));
            let item = seq.next_element_seed(Node(self.0))?;
            self.0.truncate(len);
            match item {
                Some(item) => items.push(item),
                None => return Ok(Json::Array(items)),
            }
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Json, A::Error> {
        let len = self.0.len();
        let mut entries = Vec::new();
        while let Some(name) = map.next_key::<String>()? {
            *self.0 = join(self.0, &name);
            let value = map.next_value_seed(Node(self.0))?;
            self.0.truncate(len);
            entries.push((name, value));
        }
        Ok(Json::Object(entries))
    }
}
