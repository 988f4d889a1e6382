//! Programs of the models over arrays, in Python.

use crate::fields::double;
use crate::hair::Material;
use hairis_capi::dual::hairis_dual_init;
use hairis_capi::layout::DualScattering;
use hairis_variants::{ModelId, Parameters, Registered, Values, Visitor};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Visitor that reads the numbers of parameters: those of an absorption, also where a colour is given in its place.
struct Numbers<'a>(&'a Values);

impl Visitor for Numbers<'_> {
    type Output = PyResult<Vec<f64>>;

    fn visit<M: Registered>(self) -> Self::Output {
        let params = M::Params::from_values(self.0);
        let params = params.map_err(|error| PyValueError::new_err(error.to_string()))?;
        let values = params.values();
        let places = (0..values.fields().len()).filter(|place| values.has_at(*place));
        let numbers = places.flat_map(|place| values.numbers_at(place).to_vec());
        Ok(numbers.map(double).collect())
    }
}

/// Returns the model of a material as functions over arrays, and the numbers of its parameters in their order. The functions are what
/// `hairis shader --target python` prints for calls on hits.
#[pyfunction]
pub(crate) fn program(material: &Bound<'_, Material>) -> PyResult<(&'static str, Vec<f64>)> {
    let (id, values) = material.get().model_and_values();
    macro_rules! each {
        ($($(#[$doc:meta])* $variant:ident: $model:ty;)*) => {
            match id {
                $(ModelId::$variant => include_str!(concat!(env!("OUT_DIR"), "/", stringify!($variant), ".py")),)*
                _ => unreachable!("every model of the list has a program"),
            }
        };
    }
    Ok((
        hairis_variants::for_each_model!(each),
        id.visit(Numbers(values))?,
    ))
}

/// Returns dual scattering as functions over arrays, which `hairis shader --model dual-scattering --target python` prints, and the averages of a
/// material in their order.
#[pyfunction]
pub(crate) fn dual_program(material: &Bound<'_, Material>) -> (&'static str, Vec<f64>) {
    let mut dual = DualScattering {
        coefficients: [[[0.0; 10]; 3]; 8],
    };
    // SAFETY: both live as long as the call, and the material is initialised.
    unsafe { hairis_dual_init(&raw mut dual, &raw const material.get().raw) };
    let numbers = dual.coefficients.as_flattened().as_flattened();
    (
        include_str!(concat!(env!("OUT_DIR"), "/dual_scattering.py")),
        numbers.iter().copied().map(double).collect(),
    )
}
