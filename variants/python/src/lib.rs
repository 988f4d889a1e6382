//! Python module over the calls of the C interface: NumPy in, NumPy out.
//!
//! Columns are float32 of shape (3, N) or (N,), C-contiguous: nothing is converted or copied, anything else is refused.
#![allow(unsafe_code, reason = "calls of the C interface on arrays of NumPy")]

mod arrays;
mod bsdf;
mod fields;
mod gradients;
mod material;
mod values;

use bsdf::Bsdf;
use fields::{Model, models_of_library};
use material::Material;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Name of the instruction set that calls run on: "avx512", "avx2+fma", or what the module was compiled for.
///
/// Examples
/// --------
/// >>> isinstance(hairis.level(), str)
/// True
#[pyfunction]
fn level() -> String {
    let mut text = [0; 32];
    // SAFETY: the array has this size.
    unsafe { hairis_capi::setup::hairis_level_name(text.as_mut_ptr(), text.len()) };
    fields::text(&text)
}

/// Models by name: their choices, presets, lobes and fields.
///
/// Returns
/// -------
/// dict
///     For each model a dict with "choice" (the field that selects its entries, or None) and "choices" (the words of that field),
///     "presets", "lobes", "near_field" (whether it reads `h`), and "fields": by name a dict with "kind" ("number", "numbers",
///     "rgb" or "word"), "labels", "range" (least and largest number, or None), "unit", "optional", "instead_of" and "doc".
///
/// Examples
/// --------
/// >>> sorted(hairis.models())
/// ['cauchy', 'chiang', 'gaussian', 'kajiya-kay']
/// >>> hairis.models()["gaussian"]["choices"][:2]
/// ['published', 'matched']
#[pyfunction]
fn models(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    for model in models_of_library() {
        let name = model.name();
        if let Some(first) = all.get_item(&name)? {
            let choices = first.cast_into::<PyDict>()?.get_item("choices")?;
            choices
                .map(|list| list.call_method1("append", (model.word(),)))
                .transpose()?;
            continue;
        }
        let one = PyDict::new(py);
        one.set_item("choice", model.choice())?;
        one.set_item(
            "choices",
            model
                .choice()
                .map(|_| vec![model.word()])
                .unwrap_or_default(),
        )?;
        one.set_item("presets", model.presets())?;
        one.set_item("lobes", model.lobes())?;
        one.set_item("near_field", model.is_near_field())?;
        one.set_item("fields", described(py, &model)?)?;
        all.set_item(name, one)?;
    }
    Ok(all)
}

/// The fields of a model, by name.
fn described<'py>(py: Python<'py>, model: &Model) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    for field in model.fields() {
        let one = PyDict::new(py);
        one.set_item("kind", field.kind_name())?;
        one.set_item("labels", field.labels())?;
        one.set_item("range", field.range())?;
        one.set_item("unit", field.unit())?;
        one.set_item("optional", field.is_optional())?;
        one.set_item("instead_of", field.instead_of())?;
        one.set_item("doc", field.doc())?;
        all.set_item(field.name(), one)?;
    }
    Ok(all)
}

#[pymodule]
fn _hairis(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Material>()?;
    module.add_class::<Bsdf>()?;
    module.add_function(wrap_pyfunction!(level, module)?)?;
    module.add_function(wrap_pyfunction!(models, module)?)
}
