//! Text of materials: expressions of Python, and JSON.

use crate::fields::Value;
use core::fmt::Write;
use hairis_variants::ModelId;

/// Writes a number as an expression of Python, which has no literal of infinity and NaN.
pub(crate) fn literal(x: f64) -> String {
    if x.is_finite() {
        format!("{x:?}")
    } else {
        format!("float(\"{x}\")")
    }
}

/// Writes a value as Python does, or as JSON does.
fn written(value: &Value, is_json: bool) -> String {
    let (open, close) = if is_json { ('[', ']') } else { ('(', ')') };
    match value {
        Value::Number(x) => literal(*x),
        Value::Word(word) => format!("\"{word}\""),
        Value::Numbers(numbers) => {
            let numbers: Vec<_> = numbers.iter().map(|x| literal(*x)).collect();
            format!("{open}{}{close}", numbers.join(", "))
        }
    }
}

/// Writes the call that makes the material of these values.
pub(crate) fn call(id: ModelId, energy: &str, given: &[(&str, Value)]) -> String {
    let mut text = format!("hairis.Material(\"{}\", energy=\"{energy}\"", id.name());
    if let Some((field, word)) = id.choice() {
        let _ = write!(text, ", {field}=\"{word}\"");
    }
    for (name, value) in given {
        let _ = write!(text, ", {name}={}", written(value, false));
    }
    text + ")"
}

/// Writes the JSON object of `hairis eval` in one line.
pub(crate) fn json(id: ModelId, given: &[(&str, Value)]) -> String {
    let choice = id.choice().map_or_else(String::new, |(field, word)| {
        format!(" \"{field}\": \"{word}\",")
    });
    let params = given.iter();
    let params: Vec<_> = params
        .map(|(name, value)| format!("\"{name}\": {}", written(value, true)))
        .collect();
    format!(
        "{{\"model\": \"{}\",{choice} \"params\": {{{}}}}}",
        id.name(),
        params.join(", ")
    )
}
