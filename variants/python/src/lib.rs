//! Python module over the calls of the C interface: NumPy in, NumPy out.
//!
//! Columns are float32 of shape (3, N) or (N,), C-contiguous and aligned. Nothing is converted or copied, and any other array is
//! rejected.
#![allow(unsafe_code, reason = "calls of the C interface on arrays of NumPy")]

mod arrays;
mod bsdf;
mod fields;
mod gradients;
mod hair;
mod hits;
mod material;
mod program;
mod shapes;
mod text;
mod values;

use bsdf::Bsdf;
use fields::double;
use hair::Material;
use hairis::simd::Level;
use hairis_variants::{Kind, ModelId};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Returns the name of the instruction set that calls run on: "avx512", "avx2+fma", or the one that the module was compiled for.
///
/// Examples
/// --------
/// >>> isinstance(hairis.level(), str)
/// True
#[pyfunction]
fn level() -> &'static str {
    Level::detect().name()
}

/// Describes the models by name, with their choices, presets, lobes and fields.
///
/// Returns
/// -------
/// dict
///     For each model, a dict with "choice" (the field that selects its entries, or None), "choices" (the words of that field),
///     "presets", "lobes", "near_field" (True if the model reads `h`), and "fields". For each field by name, "fields" has a dict with
///     "kind" ("number", "numbers", "rgb" or "word"), "labels", "range" (smallest and largest number, or None), "unit", "optional",
///     "instead_of" and "doc".
///
/// Examples
/// --------
/// >>> sorted(hairis.models())
/// ['cauchy', 'chiang', 'd-eon', 'gaussian', 'kajiya-kay']
/// >>> hairis.models()["gaussian"]["choices"][:2]
/// ['published', 'matched']
#[pyfunction]
fn models(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    for model in ModelId::defaults_of_names() {
        let of_name = ModelId::ALL.iter().filter(|id| id.name() == model.name());
        let choices: Vec<_> = of_name.filter_map(|id| Some(id.choice()?.1)).collect();
        let presets: Vec<_> = model.presets().map(|(name, _)| name).collect();
        let one = PyDict::new(py);
        one.set_item("choice", model.choice().map(|(field, _)| field))?;
        one.set_item("choices", choices)?;
        one.set_item("presets", presets)?;
        one.set_item("lobes", model.lobes())?;
        one.set_item("near_field", model.is_near_field())?;
        one.set_item("fields", described(py, model)?)?;
        all.set_item(model.name(), one)?;
    }
    Ok(all)
}

/// Describes the fields of a model, by name.
fn described(py: Python<'_>, model: ModelId) -> PyResult<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    for field in model.fields() {
        let (kind, labels) = match field.kind {
            Kind::Number => ("number", &[][..]),
            Kind::Numbers(labels) => ("numbers", labels),
            Kind::Rgb => ("rgb", &[][..]),
            Kind::Word(words) => ("word", words),
        };
        let range = field
            .range()
            .map(|range| <(f64, f64)>::from(range.map(double)));
        let one = PyDict::new(py);
        one.set_item("kind", kind)?;
        one.set_item("labels", labels)?;
        one.set_item("range", range)?;
        one.set_item("unit", field.unit)?;
        one.set_item("optional", field.optional)?;
        one.set_item("instead_of", field.instead_of)?;
        one.set_item("doc", field.doc)?;
        all.set_item(field.name, one)?;
    }
    Ok(all)
}

#[pymodule]
fn _hairis(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Material>()?;
    module.add_class::<Bsdf>()?;
    module.add_function(wrap_pyfunction!(level, module)?)?;
    module.add_function(wrap_pyfunction!(program::program, module)?)?;
    module.add_function(wrap_pyfunction!(program::dual_program, module)?)?;
    module.add_function(wrap_pyfunction!(models, module)?)
}
