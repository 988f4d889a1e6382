//! Models and fields as the C interface describes them.

use core::ffi::c_char;
use hairis_capi::layout::{
    Error, FieldInfo, KIND_NUMBER, KIND_NUMBERS, KIND_RGB, KIND_WORD, ModelInfo, Params,
};
use hairis_capi::setup;
use pyo3::PyErr;
use pyo3::exceptions::PyValueError;

/// The text of an array that ends in 0.
pub(crate) fn text(from: &[c_char]) -> String {
    let bytes = from
        .iter()
        .take_while(|c| **c != 0)
        .map(|c| c.to_ne_bytes()[0]);
    String::from_utf8_lossy(&bytes.collect::<Vec<u8>>()).into_owned()
}

/// Text, or nothing where it is empty.
fn some(from: &[c_char]) -> Option<String> {
    Some(text(from)).filter(|text| !text.is_empty())
}

/// A double that rounds to the number of single precision, and has its shortest digits.
pub(crate) fn double(x: f32) -> f64 {
    x.to_string().parse().unwrap_or_else(|_| f64::from(x))
}

/// A refusal that is not made yet.
pub(crate) const fn no_error() -> Error {
    Error {
        code: 0,
        number: -1,
        value: 0.0,
        field: [0; 32],
        message: [0; 212],
    }
}

/// The exception of a refusal; nothing where the status is success.
pub(crate) fn check(status: i32, error: &Error) -> Result<(), PyErr> {
    if status == 0 {
        Ok(())
    } else {
        Err(PyValueError::new_err(text(&error.message)))
    }
}

/// A model of the library.
pub(crate) struct Model {
    index: u32,
    info: ModelInfo,
}

/// Every model of the library.
pub(crate) fn models_of_library() -> impl Iterator<Item = Model> {
    (0..setup::hairis_model_count()).map(Model::at)
}

impl Model {
    pub(crate) fn at(index: u32) -> Self {
        let mut info = ModelInfo {
            name: [0; 32],
            choice: [0; 32],
            word: [0; 32],
            lobe_names: [[0; 16]; 4],
            lobes: 0,
            fields: 0,
            presets: 0,
            near_field: 0,
            is_default: 0,
        };
        // SAFETY: the struct is of this call.
        unsafe { setup::hairis_model_describe(index, &raw mut info) };
        Self { index, info }
    }

    pub(crate) fn name(&self) -> String {
        text(&self.info.name)
    }

    /// The field that selects among the entries of one name.
    pub(crate) fn choice(&self) -> Option<String> {
        some(&self.info.choice)
    }

    /// This entry's word of that field.
    pub(crate) fn word(&self) -> String {
        text(&self.info.word)
    }

    pub(crate) fn lobes(&self) -> Vec<String> {
        let count = usize::try_from(self.info.lobes).unwrap_or(0);
        self.info
            .lobe_names
            .iter()
            .take(count)
            .map(|name| text(name))
            .collect()
    }

    pub(crate) fn is_near_field(&self) -> bool {
        self.info.near_field != 0
    }

    pub(crate) fn presets(&self) -> Vec<String> {
        let name = |preset| {
            let mut to = [0; 32];
            // SAFETY: the array has this size.
            unsafe { setup::hairis_preset_name(self.index, preset, to.as_mut_ptr(), to.len()) };
            text(&to)
        };
        (0..self.info.presets).map(name).collect()
    }

    pub(crate) fn fields(&self) -> Vec<Field> {
        let field = |field| {
            let mut info = FieldInfo {
                name: [0; 32],
                instead_of: [0; 32],
                kind: 0,
                width: 0,
                first: 0,
                optional: 0,
                least: 0.0,
                most: 0.0,
                labels: 0,
                label: [[0; 16]; 4],
                unit: [0; 8],
                doc: [0; 128],
            };
            // SAFETY: the struct is of this call.
            unsafe { setup::hairis_field_describe(self.index, field, &raw mut info) };
            Field { index: field, info }
        };
        (0..self.info.fields).map(field).collect()
    }
}

/// A field of a model.
pub(crate) struct Field {
    index: u32,
    info: FieldInfo,
}

/// The value of a field.
pub(crate) enum Value {
    Number(f64),
    Numbers(Vec<f64>),
    Word(String),
}

impl Field {
    pub(crate) fn name(&self) -> String {
        text(&self.info.name)
    }

    pub(crate) fn instead_of(&self) -> Option<String> {
        some(&self.info.instead_of)
    }

    /// The first field of those that stand for one another.
    pub(crate) fn head(&self) -> String {
        self.instead_of().unwrap_or_else(|| self.name())
    }

    pub(crate) const fn kind(&self) -> u32 {
        self.info.kind
    }

    pub(crate) const fn kind_name(&self) -> &'static str {
        match self.info.kind {
            KIND_NUMBER => "number",
            KIND_NUMBERS => "numbers",
            KIND_RGB => "rgb",
            _ => "word",
        }
    }

    pub(crate) fn width(&self) -> usize {
        usize::try_from(self.info.width).unwrap_or(0)
    }

    pub(crate) fn labels(&self) -> Vec<String> {
        let count = usize::try_from(self.info.labels).unwrap_or(0);
        self.info
            .label
            .iter()
            .take(count)
            .map(|label| text(label))
            .collect()
    }

    pub(crate) fn range(&self) -> Option<(f64, f64)> {
        (self.info.kind != KIND_WORD).then(|| (double(self.info.least), double(self.info.most)))
    }

    pub(crate) fn unit(&self) -> String {
        text(&self.info.unit)
    }

    pub(crate) const fn is_optional(&self) -> bool {
        self.info.optional != 0
    }

    pub(crate) fn doc(&self) -> String {
        text(&self.info.doc)
    }

    /// The value that parameters have; `None` if it is not given.
    pub(crate) fn value(&self, params: &Params) -> Option<Value> {
        if params.given >> self.index & 1 == 0 {
            return None;
        }
        let first = usize::try_from(self.info.first).ok()?;
        let numbers = params.numbers.get(first..first + self.width())?;
        Some(match self.info.kind {
            KIND_NUMBER => Value::Number(double(numbers[0])),
            KIND_WORD => {
                let place = (0_u8..4).position(|place| f32::from(place) == numbers[0]);
                Value::Word(self.labels().get(place?)?.clone())
            }
            _ => Value::Numbers(numbers.iter().map(|x| double(*x)).collect()),
        })
    }
}
