//! JSON with the path of an error.

use super::request::Refusal;
use core::fmt;
use serde::Deserializer;
use serde::de::{DeserializeSeed, Error, MapAccess, SeqAccess, Visitor};

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

/// The fields of an object, and its path; empty for the line itself.
#[derive(Debug)]
pub(super) struct Fields {
    path: String,
    entries: Vec<(String, Json)>,
}

impl Json {
    /// Parses a line; a refusal names the innermost field that was being read.
    pub(super) fn parse(line: &str) -> Result<Self, Refusal> {
        if line.trim_ascii().is_empty() {
            return Err(Refusal::at("line", "blank"));
        }
        let mut path = String::new();
        let mut input = serde_json::Deserializer::from_str(line);
        let parsed = Node(&mut path).deserialize(&mut input).and_then(|json| input.end().map(|()| json));
        parsed.map_err(|error| {
            let text = error.to_string();
            let problem = text.rsplit_once(" at line ").map_or(&*text, |(problem, _)| problem);
            let [field, intro] = if path.is_empty() { ["line", "not JSON: "] } else { [&*path, ""] };
            Refusal::at(field, format!("{intro}{problem} (column {})", error.column()))
        })
    }

    /// The fields of an object at `path`, empty for that of the line: all of them `known`, and none given twice.
    pub(super) fn fields(self, path: &str, known: &[&str]) -> Result<Fields, Refusal> {
        let Self::Object(entries) = self else {
            let field = if path.is_empty() { "line" } else { path };
            return Err(Refusal::at(field, format!("must be an object, got {self}")));
        };
        for (place, (name, _)) in entries.iter().enumerate() {
            let refuse = |problem: String| Err(Refusal::at(&join(path, name), problem));
            if !known.contains(&&**name) {
                return refuse(format!("unknown field, expected one of {}", known.join(", ")));
            }
            if entries[..place].iter().any(|(other, _)| other == name) {
                return refuse("given twice".to_owned());
            }
        }
        Ok(Fields { path: path.to_owned(), entries })
    }

    /// The text of the object's field `name`, if there is one.
    pub(super) fn peek(&self, name: &str) -> Option<&str> {
        let Self::Object(entries) = self else { return None };
        entries.iter().find_map(|(field, value)| match value {
            Self::Text(text) if field == name => Some(&**text),
            _ => None,
        })
    }
}

impl Fields {
    /// Whether there is such a field.
    pub(super) fn has(&self, name: &str) -> bool {
        self.entries.iter().any(|(field, _)| field == name)
    }

    /// The value of a field, once.
    pub(super) fn take(&mut self, name: &str) -> Result<Json, Refusal> {
        let place = self.entries.iter().position(|(field, _)| field == name);
        let place = place.ok_or_else(|| self.refuse(name, "missing"))?;
        Ok(self.entries.swap_remove(place).1)
    }

    /// A refusal of a field.
    pub(super) fn refuse(&self, name: &str, problem: impl Into<String>) -> Refusal {
        Refusal::at(&join(&self.path, name), problem)
    }

    /// The text of a field.
    pub(super) fn text(&mut self, name: &str) -> Result<String, Refusal> {
        match self.take(name)? {
            Json::Text(text) => Ok(text),
            other => Err(self.refuse(name, format!("must be a string, got {other}"))),
        }
    }

    /// The number of a field.
    pub(super) fn number(&mut self, name: &str) -> Result<f64, Refusal> {
        let json = self.take(name)?;
        self.number_at(name, &json)
    }

    fn number_at(&self, name: &str, json: &Json) -> Result<f64, Refusal> {
        match json {
            Json::Number(number) => Ok(*number),
            other => Err(self.refuse(name, format!("must be a number, got {other}"))),
        }
    }

    /// The `len` numbers of a field.
    pub(super) fn numbers(&mut self, name: &str, len: usize) -> Result<Vec<f64>, Refusal> {
        match self.take(name)? {
            Json::Array(items) if items.len() == len => {
                items.iter().zip(0..).map(|(json, i)| self.number_at(&format!("{name}[{i}]"), json)).collect()
            }
            Json::Array(items) => Err(self.refuse(name, format!("must have {len} numbers, got {}", items.len()))),
            other => Err(self.refuse(name, format!("must be an array of {len} numbers, got {other}"))),
        }
    }

    /// The three numbers of a field.
    pub(super) fn three(&mut self, name: &str) -> Result<[f64; 3], Refusal> {
        let numbers = self.numbers(name, 3)?;
        Ok([numbers[0], numbers[1], numbers[2]])
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

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<Json, D::Error> {
        from.deserialize_any(self)
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

    fn visit_f64<E: Error>(self, value: f64) -> Result<Json, E> {
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
