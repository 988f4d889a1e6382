//! Conversion of the values of fields between Rust and Python, and of errors of the C interface.

use core::ffi::c_char;
use hairis_capi::layout::Error;
use hairis_variants::{Kind, Values};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// Returns the text of an array that ends in 0.
fn text(from: &[c_char]) -> String {
    let bytes = from
        .iter()
        .take_while(|c| **c != 0)
        .map(|c| c.to_ne_bytes()[0]);
    String::from_utf8_lossy(&bytes.collect::<Vec<u8>>()).into_owned()
}

/// Returns a double that rounds to the number in single precision and has its shortest digits.
pub(crate) fn double(x: f32) -> f64 {
    x.to_string().parse().unwrap_or_else(|_| f64::from(x))
}

/// Returns an empty error, for the C interface to fill.
pub(crate) const fn no_error() -> Error {
    Error {
        code: 0,
        number: -1,
        value: 0.0,
        field: [0; 32],
        message: [0; 212],
    }
}

/// Returns the exception for an error of the C interface, or nothing if the status is success.
pub(crate) fn check(status: i32, error: &Error) -> Result<(), PyErr> {
    if status == 0 {
        Ok(())
    } else {
        Err(PyValueError::new_err(text(&error.message)))
    }
}

/// Value of a field.
pub(crate) enum Value {
    Number(f64),
    Numbers(Vec<f64>),
    Word(&'static str),
}

/// Returns the fields that have a value, as Python presents them.
pub(crate) fn fields_of(values: &Values<f64>) -> Vec<(&'static str, Value)> {
    let fields = values.fields().iter().enumerate();
    fields
        .filter(|(index, _)| values.has_at(*index))
        .map(|(index, field)| {
            let value = match (field.kind, values.numbers_at(index)) {
                (Kind::Word(words), [place]) => Value::Word(words[*place as usize]),
                (Kind::Number, [x]) => Value::Number(*x),
                (_, numbers) => Value::Numbers(numbers.to_vec()),
            };
            (field.name, value)
        })
        .collect()
}

/// Makes a dict of values by name, each a float, a tuple of floats or a word.
pub(crate) fn dict_of(
    py: Python<'_>,
    values: impl IntoIterator<Item = (&'static str, Value)>,
) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    for (name, value) in values {
        match value {
            Value::Number(x) => dict.set_item(name, x)?,
            Value::Numbers(numbers) => dict.set_item(name, PyTuple::new(py, numbers)?)?,
            Value::Word(word) => dict.set_item(name, word)?,
        }
    }
    Ok(dict)
}
