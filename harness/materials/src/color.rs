//! Colours that materials are asked to show.

use crate::json::{numbers, refusal, word};
use crate::material::{Fields, MaterialSpec, single};
use hairis_variants::color::ColorOf;

/// Reads the fields `color` and `color_of`, which are given together.
pub(crate) fn read(object: &Fields) -> Result<Option<([f32; 3], ColorOf)>, String> {
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

impl MaterialSpec {
    /// Returns a copy with the absorption or the intensities with which hair shows a colour. They are found in single precision.
    #[cfg(feature = "any")]
    pub(crate) fn colored(&self, (color, of): ([f32; 3], ColorOf)) -> Result<Self, String> {
        use hairis_variants::color::ColorError;
        let values =
            self.model
                .with_color(&self.values, color, of)
                .map_err(|error| match error {
                    ColorError::Param(error) => {
                        let number = error.number().map(|number| format!("[{number}]"));
                        let name = error.field().to_owned() + &number.unwrap_or_default();
                        let (rule, value) = (error.rule(), error.value());
                        refusal(&name, format!("must be {rule}, got {value}"))
                    }
                    error => error.to_string().replacen("color_of", "color_of:", 1),
                })?;
        let changed = values
            .fields()
            .iter()
            .filter(|field| values.has(field.name))
            .filter(|field| values.numbers(field.name) != self.values.numbers(field.name));
        let exact = changed.fold(self.exact, |exact, field| {
            let numbers: Vec<f64> = values
                .numbers(field.name)
                .iter()
                .map(|x| (*x).into())
                .collect();
            exact.with(field.name, &numbers)
        });
        let colored = Self::new(self.model, values).map_err(|error| error.to_string())?;
        Ok(Self {
            is_chosen: self.is_chosen,
            exact,
            ..colored
        })
    }

    #[cfg(not(feature = "any"))]
    pub(crate) fn colored(&self, _: ([f32; 3], ColorOf)) -> Result<Self, String> {
        Err(refusal(
            "color",
            "must be left out, as this program measures no colours",
        ))
    }
}
