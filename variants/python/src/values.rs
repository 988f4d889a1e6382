//! Values between Python and the C interface.

use crate::fields::{Field, Value, check, no_error};
use hairis_capi::layout::{
    ENERGY_CONSERVING, ENERGY_RAW, ENERGY_SCALED, KIND_NUMBER, KIND_WORD, Params,
};
use hairis_capi::setup;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::ffi::CString;

const ENERGIES: [(&str, u32); 3] = [
    ("raw", ENERGY_RAW),
    ("conserving", ENERGY_CONSERVING),
    ("scaled", ENERGY_SCALED),
];

pub(crate) fn c_string(text: &str) -> PyResult<CString> {
    CString::new(text)
        .map_err(|_| PyValueError::new_err(format!("names must have no NUL, got {text:?}")))
}

/// The code of an energy's name.
pub(crate) fn energy_of(name: &str) -> PyResult<(&'static str, u32)> {
    let found = ENERGIES.iter().find(|(one, _)| *one == name).copied();
    found.ok_or_else(|| {
        PyValueError::new_err(format!(
            "energy must be one of raw, conserving, scaled, got \"{name}\""
        ))
    })
}

/// Sets a field to a value of Python.
pub(crate) fn set(params: &mut Params, field: &Field, value: &Bound<'_, PyAny>) -> PyResult<()> {
    let name = field.name();
    let (c_name, mut error) = (c_string(&name)?, no_error());
    let wrong = |what: String| {
        PyTypeError::new_err(format!("{name} must be {what}, got {}", value.get_type()))
    };
    if field.kind() == KIND_WORD {
        let word: String = value.extract().map_err(|_| wrong("a word".to_owned()))?;
        let word = c_string(&word)?;
        // SAFETY: the arguments are of this call.
        let status = unsafe {
            setup::hairis_params_set_word(params, c_name.as_ptr(), word.as_ptr(), &raw mut error)
        };
        return check(status, &error);
    }
    let numbers: Vec<f64> = if field.kind() == KIND_NUMBER {
        vec![value.extract().map_err(|_| wrong("a number".to_owned()))?]
    } else {
        value
            .extract()
            .map_err(|_| wrong(format!("{} numbers", field.width())))?
    };
    let numbers: Vec<f32> = numbers.iter().map(|x| *x as f32).collect();
    // SAFETY: the arguments are of this call.
    let status = unsafe {
        let numbers = (numbers.as_ptr(), numbers.len());
        setup::hairis_params_set(
            params,
            c_name.as_ptr(),
            numbers.0,
            numbers.1,
            &raw mut error,
        )
    };
    check(status, &error)
}

/// A value as Python writes it, or as JSON has it.
pub(crate) fn written(value: &Value, is_json: bool) -> String {
    let (open, close) = if is_json { ('[', ']') } else { ('(', ')') };
    match value {
        Value::Number(x) => format!("{x:?}"),
        Value::Word(word) => format!("\"{word}\""),
        Value::Numbers(numbers) => {
            let numbers: Vec<_> = numbers.iter().map(|x| format!("{x:?}")).collect();
            format!("{open}{}{close}", numbers.join(", "))
        }
    }
}
