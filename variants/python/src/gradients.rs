//! Derivatives of values by the fields of a material, by directions and by offsets across the fibre.

use crate::arrays::{Columns as Names, Detached, Input, Outputs};
use crate::hits::{Columns, all};
use hairis::columns::HitColumns;
use hairis::model::Model;
use hairis::{Gaussian, Matched, ParamError, Published};
use hairis_gradients::{GradColumns, GradError, Gradients, Weights};
use hairis_variants::{AllCauchy, Cauchy, Chiang, DEon, KajiyaKay, ModelId, Values};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Columns of derivatives.
static GRADIENTS: Names<4> = Names::new([("value", 3), ("d_wo", 3), ("d_wi", 3), ("d_h", 1)]);

/// Reasons for which a call has no derivatives.
enum Refusal {
    Energy,
    Param(ParamError),
    Columns(GradError),
}

impl Refusal {
    fn raise(self, energy: &str) -> PyErr {
        PyValueError::new_err(match self {
            Self::Energy => {
                format!("energy must be \"raw\" for derivatives, got \"{energy}\"")
            }
            Self::Param(error) => error.to_string(),
            Self::Columns(error) => error.to_string(),
        })
    }
}

/// Writes columns of values and derivatives at hits, and returns them with the derivatives by the fields of a material, which is given by
/// its model, its values and its energy.
pub(crate) fn call<'py>(
    py: Python<'py>,
    (id, values, energy): (ModelId, &Values, &str),
    hits: &Columns<'py>,
    d_value: &Bound<'py, PyAny>,
    out: Option<&Bound<'py, PyAny>>,
) -> PyResult<(Bound<'py, PyDict>, Values<f64>)> {
    let d_value = Input::new("d_value", d_value, 3, Some(hits.0.n))?;
    let read = [&all(hits)[..], &[&d_value]].concat();
    let outputs = Outputs::new(py, out, &GRADIENTS, &read)?;
    let (rows, mut done) = (&outputs.rows[..], None);
    let to = &mut done;
    Detached(move || {
        // SAFETY: the arrays have n numbers in each row, and are borrowed.
        *to = Some(unsafe { eval_grad(id, values, energy == "raw", hits, &d_value, rows) });
        0
    })
    .run(py)?;
    match done {
        Some(Ok(derivatives)) => Ok((outputs.dict, derivatives)),
        Some(Err(refusal)) => Err(refusal.raise(energy)),
        None => unreachable!("the call ran"),
    }
}

/// Writes the columns, and returns the derivatives by the fields.
///
/// # Safety
///
/// The outputs must have as many numbers in each row as the inputs.
unsafe fn eval_grad(
    id: ModelId,
    values: &Values,
    is_raw: bool,
    (wo, wi, h): &Columns<'_>,
    d_value: &Input<'_>,
    outputs: &[[*mut f32; 3]],
) -> Result<Values<f64>, Refusal> {
    let [value, d_wo, d_wi, d_h] = *outputs else {
        unreachable!("four columns")
    };
    let n = wo.n;
    // SAFETY: the caller's promise; a column that is left out is null.
    let row =
        |to: *mut f32| (!to.is_null()).then(|| unsafe { core::slice::from_raw_parts_mut(to, n) });
    let three = |rows: [*mut f32; 3]| {
        let [a, b, c] = rows.map(row);
        Some([a?, b?, c?])
    };
    let mut d_material = [0.0; 128];
    let hits = HitColumns {
        wo: wo.slices(),
        h: h.as_ref().map(|h| h.slices()[0]),
    };
    let weights = Weights {
        value: Some(d_value.slices()),
        pdf: None,
    };
    let mut out = GradColumns {
        value: three(value),
        d_wo: three(d_wo),
        d_wi: three(d_wi),
        d_h: row(d_h[0]),
        ..GradColumns::default()
    };
    macro_rules! each {
        ($($(#[$doc:meta])* $variant:ident: $model:ty;)*) => {
            match id {
                $(ModelId::$variant => {
                    if !is_raw && !<$model as Model>::CONSERVES {
                        return Err(Refusal::Energy);
                    }
                    let gradients = Gradients::<$model>::from_values(values).map_err(Refusal::Param)?;
                    let sums = &mut d_material[..Gradients::<$model>::NUMBERS];
                    out.d_material = Some(sums);
                    gradients
                        .eval_grad(hits, wi.slices(), weights, out)
                        .map_err(Refusal::Columns)?;
                    Ok(gradients.by_parameters(&d_material))
                })*
                _ => unreachable!("every model of the list has derivatives"),
            }
        };
    }
    hairis_variants::for_each_model!(each)
}
