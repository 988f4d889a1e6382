//! Conversion of parameters and their values from Python to the C interface.

use crate::fields::{check, no_error};
use core::ffi::CStr;
use core::fmt::Display;
use hairis_capi::layout::{ENERGY_CONSERVING, ENERGY_RAW, ENERGY_SCALED, NUMBERS, Params};
use hairis_capi::setup;
use hairis_variants::chiang::Likeness;
use hairis_variants::{Field, Kind, ModelId};
use numpy::{PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyString};
use std::ffi::CString;

/// Energy of materials by default, with its code.
pub(crate) const CONSERVING: (&str, u32) = ("conserving", ENERGY_CONSERVING);

const ENERGIES: [(&str, u32); 3] = [("raw", ENERGY_RAW), CONSERVING, ("scaled", ENERGY_SCALED)];

fn c_string(name: &str, text: &str) -> PyResult<CString> {
    CString::new(text)
        .map_err(|_| PyValueError::new_err(format!("{name} must have no NUL, got {text:?}")))
}

/// Reads an energy by name; returns it with its code.
pub(crate) fn energy_of(value: &Bound<'_, PyAny>) -> PyResult<(&'static str, u32)> {
    let name = word(&"energy", value)?;
    let found = ENERGIES.iter().find(|(one, _)| *one == name).copied();
    found.ok_or_else(|| {
        PyValueError::new_err(format!(
            "energy must be one of raw, conserving, scaled, got {name:?}"
        ))
    })
}

/// Takes the field "color" from the fields of a call, which is the caller's own dict; returns the colour with the word of its subject.
pub(crate) fn take_color(
    of: &Bound<'_, PyAny>,
    fields: Option<&Bound<'_, PyDict>>,
) -> PyResult<([f32; 3], CString)> {
    let of = c_string("color_of", &word(&"color_of", of)?)?;
    let given = |name| fields.map_or(Ok(None), |fields| fields.get_item(name));
    for name in ["sigma_a", "melanin", "melanin_amount"] {
        if given(name)?.is_some() {
            return Err(PyValueError::new_err(format!(
                "{name} and color exclude each other; give one"
            )));
        }
    }
    let (Some(color), Some(fields)) = (given("color")?, fields) else {
        return Err(PyValueError::new_err(
            "color must be given where color_of is, got None",
        ));
    };
    fields.del_item("color")?;
    Ok((vector("color", &color)?, of))
}

/// Sets what decides the colour of hair.
pub(crate) fn set_color(params: &mut Params, (color, of): &([f32; 3], CString)) -> PyResult<()> {
    let mut error = no_error();
    // SAFETY: the arguments are of this call.
    let status = unsafe {
        hairis_capi::color::hairis_params_set_color(params, color, of.as_ptr(), &raw mut error)
    };
    check(status, &error)
}

/// Makes parameters of Chiang's fibre in the terms of another renderer, with the values of `fields` in place of its defaults.
pub(crate) fn params_like(
    model: &str,
    preset: Option<&str>,
    renderer: &str,
    fields: Option<&Bound<'_, PyDict>>,
) -> PyResult<Params> {
    if model != "chiang" {
        return Err(PyValueError::new_err(format!(
            "model must be \"chiang\" where like is given, got {model:?}"
        )));
    }
    if let Some(preset) = preset {
        return Err(PyValueError::new_err(format!(
            "preset must be None where like is given, got {preset:?}"
        )));
    }
    let found = Likeness::find(renderer).zip(setup::params_like(renderer));
    let Some((like, mut params)) = found else {
        let names: Vec<_> = Likeness::ALL.iter().map(|like| like.name).collect();
        let names = names.join(", ");
        return Err(PyValueError::new_err(format!(
            "like must be one of {names}, got {renderer:?}"
        )));
    };
    set_all(&mut params, like.fields, None, fields)?;
    Ok(params)
}

/// Makes the parameters of a model or of its preset, with the values of `fields` in place of their own.
pub(crate) fn params_of(
    model: &str,
    preset: Option<&str>,
    fields: Option<&Bound<'_, PyDict>>,
) -> PyResult<Params> {
    let choice = ModelId::find(model, None).and_then(ModelId::choice);
    let choice = choice.map(|(field, _)| field);
    let chosen = match (choice, fields) {
        (Some(choice), Some(fields)) => fields.get_item(choice)?.map(|value| {
            let word = word(&choice, &value)?;
            c_string(choice, &word)
        }),
        _ => None,
    };
    let chosen = chosen.transpose()?;
    let preset = preset.map(|preset| c_string("preset", preset));
    let (model, preset) = (c_string("model", model)?, preset.transpose()?);
    let pointer = |text: &Option<CString>| text.as_deref().map_or(core::ptr::null(), CStr::as_ptr);
    let mut error = no_error();
    let mut params = Params {
        model: 0,
        given: 0,
        numbers: [0.0; NUMBERS],
    };
    // SAFETY: the arguments are of this call.
    let status = unsafe {
        let names = (model.as_ptr(), pointer(&chosen), pointer(&preset));
        setup::hairis_params_init(&raw mut params, names.0, names.1, names.2, &raw mut error)
    };
    check(status, &error)?;
    let known = ModelId::ALL[params.model as usize].fields();
    set_all(&mut params, known, choice, fields)?;
    Ok(params)
}

/// Sets fields to values from Python; the field of the model's choice has been read before.
fn set_all(
    params: &mut Params,
    known: &[Field],
    choice: Option<&str>,
    fields: Option<&Bound<'_, PyDict>>,
) -> PyResult<()> {
    let mut heads = Vec::new();
    for (name, value) in fields.into_iter().flatten() {
        let name = word(&"field", &name)?;
        if Some(&*name) == choice {
            continue;
        }
        let Some(field) = known.iter().find(|field| field.name == name) else {
            let known = known.iter().map(|field| field.name);
            let names: Vec<_> = choice.into_iter().chain(known).collect();
            let names = names.join(", ");
            return Err(PyValueError::new_err(format!(
                "field must be one of {names}, got {name:?}"
            )));
        };
        let head = field.instead_of.unwrap_or(field.name);
        if let Some((_, other)) = heads.iter().find(|(one, _)| *one == head) {
            return Err(PyValueError::new_err(format!(
                "{other} and {name} exclude each other; give one"
            )));
        }
        heads.push((head, name));
        set(params, field, &value)?;
    }
    Ok(())
}

/// Describes a value in exceptions: an array by its numbers, anything else by its type.
pub(crate) fn description(of: &Bound<'_, PyAny>) -> String {
    let Ok(array) = of.cast::<PyUntypedArray>() else {
        return of.get_type().to_string();
    };
    let (dtype, rank) = (array.dtype(), array.ndim());
    let lengths: Vec<_> = array.shape().iter().map(usize::to_string).collect();
    let comma = if rank == 1 { "," } else { "" };
    format!("{dtype} of shape ({}{comma})", lengths.join(", "))
}

/// Makes the exception for a value of another type than its argument or field.
pub(crate) fn wrong(name: &dyn Display, what: &str, value: &Bound<'_, PyAny>) -> PyErr {
    let got = description(value);
    PyTypeError::new_err(format!("{name} must be {what}, got {got}"))
}

/// Converts an exception that says that a value has another type; others, such as an interrupt, stay as they are.
fn if_type(error: PyErr, py: Python<'_>, convert: impl FnOnce() -> PyErr) -> PyErr {
    if error.is_instance_of::<PyTypeError>(py) || error.is_instance_of::<PyValueError>(py) {
        convert()
    } else {
        error
    }
}

/// Reads a word. Surrogates, which are in no name, become replacement characters.
pub(crate) fn word(name: &dyn Display, value: &Bound<'_, PyAny>) -> PyResult<String> {
    let word = value.cast::<PyString>();
    let word = word.map_err(|_| wrong(name, "a word", value))?;
    Ok(word.to_string_lossy().into_owned())
}

/// Reads a number. NaN and infinity are numbers; a finite one beyond single precision is refused.
pub(crate) fn number(name: &dyn Display, value: &Bound<'_, PyAny>) -> PyResult<f32> {
    let too_large = |got: &dyn Display| {
        let most = f32::MAX;
        PyValueError::new_err(format!(
            "{name} must be at most {most:e} in magnitude, got {got}"
        ))
    };
    // NumPy before 2.4 converts an array of one number.
    let array = value.cast::<PyUntypedArray>();
    if array.is_ok_and(|array| array.ndim() > 0) {
        return Err(wrong(name, "a number", value));
    }
    match value.extract::<f64>() {
        Ok(x) if x.is_finite() && (x as f32).is_infinite() => {
            Err(too_large(&format_args!("{x:e}")))
        }
        Ok(x) => Ok(x as f32),
        Err(error) if error.is_instance_of::<PyOverflowError>(value.py()) => {
            Err(too_large(&"a larger integer"))
        }
        Err(error) => Err(if_type(error, value.py(), || {
            wrong(name, "a number", value)
        })),
    }
}

/// Reads the items of a sequence that is neither a string nor bytes.
pub(crate) fn items<'py>(
    name: &str,
    what: &str,
    value: &Bound<'py, PyAny>,
) -> PyResult<Vec<Bound<'py, PyAny>>> {
    if value.is_instance_of::<PyBytes>() {
        return Err(wrong(&name, what, value));
    }
    let items = value.extract();
    items.map_err(|error: PyErr| if_type(error, value.py(), || wrong(&name, what, value)))
}

/// Reads a sequence of so many numbers.
pub(crate) fn numbers(name: &str, width: usize, value: &Bound<'_, PyAny>) -> PyResult<Vec<f32>> {
    let what = format!("{width} numbers");
    let items = items(name, &what, value)?;
    if items.len() != width {
        let got = items.len();
        return Err(PyValueError::new_err(format!(
            "{name} must be {what}, got {got}"
        )));
    }
    let items = items.iter().enumerate();
    items
        .map(|(i, item)| number(&format_args!("{name}[{i}]"), item))
        .collect()
}

/// Reads a vector of three numbers.
pub(crate) fn vector(name: &str, value: &Bound<'_, PyAny>) -> PyResult<[f32; 3]> {
    let numbers = numbers(name, 3, value)?;
    Ok([numbers[0], numbers[1], numbers[2]])
}

/// Sets a field to a value from Python.
fn set(params: &mut Params, field: &Field, value: &Bound<'_, PyAny>) -> PyResult<()> {
    let name = field.name;
    let (c_name, mut error) = (c_string(name, name)?, no_error());
    let is_named = !field.names.is_empty() && value.is_instance_of::<PyString>();
    if is_named || matches!(field.kind, Kind::Word(_)) {
        let word = c_string(name, &word(&name, value)?)?;
        // SAFETY: the arguments are of this call.
        let status = unsafe {
            setup::hairis_params_set_word(params, c_name.as_ptr(), word.as_ptr(), &raw mut error)
        };
        return check(status, &error);
    }
    let numbers = if field.kind == Kind::Number {
        vec![number(&name, value)?]
    } else {
        numbers(name, field.kind.width(), value)?
    };
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
