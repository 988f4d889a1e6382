//! Conversion of parameters and their values from Python to the C interface.

use crate::fields::{Value, check, no_error};
use core::ffi::CStr;
use hairis_capi::layout::{ENERGY_CONSERVING, ENERGY_RAW, ENERGY_SCALED, Params};
use hairis_capi::setup;
use hairis_variants::{Field, Kind, ModelId};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ffi::CString;

const ENERGIES: [(&str, u32); 3] = [
    ("raw", ENERGY_RAW),
    ("conserving", ENERGY_CONSERVING),
    ("scaled", ENERGY_SCALED),
];

fn c_string(text: &str) -> PyResult<CString> {
    CString::new(text)
        .map_err(|_| PyValueError::new_err(format!("names must have no NUL, got {text:?}")))
}

/// Returns an energy by name, with its code.
pub(crate) fn energy_of(name: &str) -> PyResult<(&'static str, u32)> {
    let found = ENERGIES.iter().find(|(one, _)| *one == name).copied();
    found.ok_or_else(|| {
        PyValueError::new_err(format!(
            "energy must be one of raw, conserving, scaled, got \"{name}\""
        ))
    })
}

/// Makes the parameters of a model or of its preset, with the values of `fields` in place of their own.
pub(crate) fn params_of(
    model: &str,
    preset: Option<&str>,
    fields: Option<&Bound<'_, PyDict>>,
) -> PyResult<Params> {
    let choice = ModelId::find(model, None).and_then(ModelId::choice);
    let choice = choice.map(|(field, _)| field);
    let word = match (choice, fields) {
        (Some(choice), Some(fields)) => fields.get_item(choice)?.map(|word| word_of(choice, &word)),
        _ => None,
    };
    let word = word.transpose()?;
    let (model, preset) = (c_string(model)?, preset.map(c_string).transpose()?);
    let pointer = |text: &Option<CString>| text.as_deref().map_or(core::ptr::null(), CStr::as_ptr);
    let mut error = no_error();
    let mut params = Params {
        model: 0,
        given: 0,
        numbers: [0.0; 32],
    };
    // SAFETY: the arguments are of this call.
    let status = unsafe {
        let names = (model.as_ptr(), pointer(&word), pointer(&preset));
        setup::hairis_params_init(&raw mut params, names.0, names.1, names.2, &raw mut error)
    };
    check(status, &error)?;
    let known = ModelId::ALL[params.model as usize].fields();
    let mut heads = Vec::new();
    for (name, value) in fields.into_iter().flatten() {
        let name: String = name.extract()?;
        if Some(&*name) == choice {
            continue;
        }
        let Some(field) = known.iter().find(|field| field.name == name) else {
            let known = known.iter().map(|field| field.name);
            let names: Vec<_> = choice.into_iter().chain(known).collect();
            let names = names.join(", ");
            return Err(PyValueError::new_err(format!(
                "field must be one of {names}, got \"{name}\""
            )));
        };
        let head = field.instead_of.unwrap_or(field.name);
        if let Some((_, other)) = heads.iter().find(|(one, _)| *one == head) {
            return Err(PyValueError::new_err(format!(
                "{other} and {name} exclude each other; give one"
            )));
        }
        heads.push((head, name));
        set(&mut params, field, &value)?;
    }
    Ok(params)
}

/// Makes the exception for a value of another type than its field.
fn wrong(name: &str, what: &str, value: &Bound<'_, PyAny>) -> PyErr {
    PyTypeError::new_err(format!("{name} must be {what}, got {}", value.get_type()))
}

/// Reads the word that a field is given.
fn word_of(name: &str, value: &Bound<'_, PyAny>) -> PyResult<CString> {
    let word: String = value.extract().map_err(|_| wrong(name, "a word", value))?;
    c_string(&word)
}

/// Sets a field to a value from Python.
fn set(params: &mut Params, field: &Field, value: &Bound<'_, PyAny>) -> PyResult<()> {
    let name = field.name;
    let (c_name, mut error) = (c_string(name)?, no_error());
    if let Kind::Word(_) = field.kind {
        let word = word_of(name, value)?;
        // SAFETY: the arguments are of this call.
        let status = unsafe {
            setup::hairis_params_set_word(params, c_name.as_ptr(), word.as_ptr(), &raw mut error)
        };
        return check(status, &error);
    }
    let numbers: Vec<f64> = if field.kind == Kind::Number {
        let number = value.extract();
        vec![number.map_err(|_| wrong(name, "a number", value))?]
    } else {
        let what = format!("{} numbers", field.kind.width());
        value.extract().map_err(|_| wrong(name, &what, value))?
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

/// Writes a value as Python does, or as JSON does.
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
