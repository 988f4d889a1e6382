//! Values between Python and the C interface.

use crate::fields::{Field, Model, Value, check, models_of_library, no_error};
use core::ffi::CStr;
use hairis_capi::layout::{
    ENERGY_CONSERVING, ENERGY_RAW, ENERGY_SCALED, KIND_NUMBER, KIND_WORD, Params,
};
use hairis_capi::setup;
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

/// The code of an energy's name.
pub(crate) fn energy_of(name: &str) -> PyResult<(&'static str, u32)> {
    let found = ENERGIES.iter().find(|(one, _)| *one == name).copied();
    found.ok_or_else(|| {
        PyValueError::new_err(format!(
            "energy must be one of raw, conserving, scaled, got \"{name}\""
        ))
    })
}

/// The parameters of a model, or of a preset, with fields in place of its own.
pub(crate) fn params_of(
    model: &str,
    preset: Option<&str>,
    fields: Option<&Bound<'_, PyDict>>,
) -> PyResult<Params> {
    let choice = models_of_library()
        .find(|one| one.name() == model)
        .and_then(|one| one.choice());
    let given = |name: &str| fields.map_or(Ok(None), |fields| fields.get_item(name));
    let word: Option<String> = match &choice {
        Some(choice) => given(choice)?.map(|word| word.extract()).transpose()?,
        None => None,
    };
    let word = word.map(|word| c_string(&word)).transpose()?;
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
    let known = Model::at(params.model).fields();
    let mut heads: Vec<(String, String)> = Vec::new();
    for (name, value) in fields.into_iter().flatten() {
        let name: String = name.extract()?;
        if Some(&name) == choice.as_ref() {
            continue;
        }
        let Some(field) = known.iter().find(|field| field.name() == name) else {
            let names: Vec<_> = choice
                .iter()
                .cloned()
                .chain(known.iter().map(Field::name))
                .collect();
            let names = names.join(", ");
            return Err(PyValueError::new_err(format!(
                "field must be one of {names}, got \"{name}\""
            )));
        };
        if let Some((_, other)) = heads.iter().find(|(head, _)| *head == field.head()) {
            return Err(PyValueError::new_err(format!(
                "{other} and {name} exclude each other; give one"
            )));
        }
        heads.push((field.head(), name));
        set(&mut params, field, &value)?;
    }
    Ok(params)
}

/// Sets a field to a value of Python.
fn set(params: &mut Params, field: &Field, value: &Bound<'_, PyAny>) -> PyResult<()> {
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
