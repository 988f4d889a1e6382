//! Calls on arrays of any shape, by a module of Python that makes columns of them.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// Results of calls, by their names.
pub(crate) const EVAL: [&str; 1] = ["value"];
pub(crate) const PDF: [&str; 1] = ["pdf"];
pub(crate) const SAMPLE: [&str; 5] = ["wi", "value", "pdf", "weight", "lobe"];

/// Calls a method of `of` that takes columns with these vectors and offsets. Returns the results by name, in the shape that the arguments
/// broadcast to.
pub(crate) fn any_shape<'py, const N: usize>(
    of: &Bound<'py, PyAny>,
    method: &str,
    results: &[&str; N],
    vectors: &[(&str, &Bound<'py, PyAny>)],
    h: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let by_name = PyDict::new(of.py());
    for (name, vector) in vectors {
        by_name.set_item(name, vector)?;
    }
    let results = PyTuple::new(of.py(), results)?;
    let arguments = (of.getattr(method)?, results, by_name, h);
    let module = of.py().import("hairis._shapes")?;
    Ok(module.call_method1("call", arguments)?.cast_into()?)
}

/// Returns the result of this name.
pub(crate) fn one<'py>(results: &Bound<'py, PyDict>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    results.as_any().get_item(name)
}

/// Returns value and density.
pub(crate) fn pair<'py>(results: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyTuple>> {
    PyTuple::new(
        results.py(),
        [one(results, EVAL[0])?, one(results, PDF[0])?],
    )
}
