//! Colours that materials are asked to show.

use crate::json::{Json, numbers, refusal, single, word};
use hairis_variants::color::ColorOf;
use hairis_variants::{ModelId, Values};
use std::collections::BTreeMap;

/// Reads the fields `color` and `color_of`, which are given together.
pub(crate) fn read(object: &BTreeMap<String, Json>) -> Result<Option<([f32; 3], ColorOf)>, String> {
    let (color, of) = match (object.get("color"), object.get("color_of")) {
        (None, None) => return Ok(None),
        (Some(color), Some(of)) => (color, of),
        (None, _) => return Err(refusal("color", "missing")),
        (_, None) => return Err(refusal("color_of", "missing")),
    };
    let words = ColorOf::ALL.map(ColorOf::word);
    let of = ColorOf::ALL[word("color_of", of, &words)?];
    let [r, g, b] = numbers("color", color, 3)?[..] else {
        return Err(refusal("color", "must be 3 numbers"));
    };
    Ok(Some(([r, g, b].map(single), of)))
}

/// Returns values with the absorption or the intensities with which hair shows a colour.
#[cfg(feature = "any")]
pub(crate) fn shown(
    model: ModelId,
    values: &Values,
    (color, of): ([f32; 3], ColorOf),
) -> Result<Values, String> {
    use hairis_variants::color::ColorError;
    model
        .with_color(values, color, of)
        .map_err(|error| match error {
            ColorError::Param(error) => {
                let number = error.number().map(|number| format!("[{number}]"));
                let name = error.field().to_owned() + &number.unwrap_or_default();
                let (rule, value) = (error.rule(), error.value());
                refusal(&name, format!("must be {rule}, got {value}"))
            }
            error => error.to_string().replacen("color_of", "color_of:", 1),
        })
}

#[cfg(not(feature = "any"))]
pub(crate) fn shown(_: ModelId, _: &Values, _: ([f32; 3], ColorOf)) -> Result<Values, String> {
    Err(refusal(
        "color",
        "must be left out, as this program measures no colours",
    ))
}
