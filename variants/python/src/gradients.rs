//! Derivatives of values by the fields of a material, by directions and by offsets across the fibre.

use crate::arrays::{Columns, Input};
use hairis::columns::HitColumns;
use hairis::model::Model;
use hairis::{Gaussian, Matched, ParamError, Published};
use hairis_gradients::{GradColumns, GradError, Gradients, Weights};
use hairis_variants::{AllCauchy, Cauchy, Chiang, KajiyaKay, ModelId, Values};
use pyo3::PyErr;
use pyo3::exceptions::PyValueError;

/// Columns of derivatives.
pub(crate) static GRADIENTS: Columns<4> =
    Columns::new([("value", 3), ("d_wo", 3), ("d_wi", 3), ("d_h", 1)]);

/// Reasons for which a call has no derivatives.
pub(crate) enum Refusal {
    Energy,
    Param(ParamError),
    Columns(GradError),
}

impl Refusal {
    pub(crate) fn raise(self, energy: &str) -> PyErr {
        PyValueError::new_err(match self {
            Self::Energy => {
                format!("energy must be \"raw\" for derivatives, got \"{energy}\"")
            }
            Self::Param(error) => error.to_string(),
            Self::Columns(error) => error.to_string(),
        })
    }
}

/// Columns that a call reads: hits, directions, and derivatives of a loss by each value.
pub(crate) struct Inputs<'a, 'py> {
    pub(crate) wo: &'a Input<'py>,
    pub(crate) h: Option<&'a Input<'py>>,
    pub(crate) wi: &'a Input<'py>,
    pub(crate) d_value: &'a Input<'py>,
}

/// Writes the columns, and returns the derivatives by the fields.
///
/// # Safety
///
/// The outputs must have as many numbers in each row as the inputs.
pub(crate) unsafe fn eval_grad(
    id: ModelId,
    values: &Values,
    is_raw: bool,
    inputs: &Inputs<'_, '_>,
    outputs: &[[*mut f32; 3]],
) -> Result<Values<f64>, Refusal> {
    let [value, d_wo, d_wi, d_h] = *outputs else {
        unreachable!("four columns")
    };
    let n = inputs.wo.n;
    // SAFETY: the caller's promise; a column that is left out is null.
    let row =
        |to: *mut f32| (!to.is_null()).then(|| unsafe { core::slice::from_raw_parts_mut(to, n) });
    let three = |rows: [*mut f32; 3]| {
        let [a, b, c] = rows.map(row);
        Some([a?, b?, c?])
    };
    let mut d_material = [0.0; 128];
    let hits = HitColumns {
        wo: inputs.wo.slices(),
        h: inputs.h.map(|h| h.slices()[0]),
    };
    let weights = Weights {
        value: Some(inputs.d_value.slices()),
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
                        .eval_grad(hits, inputs.wi.slices(), weights, out)
                        .map_err(Refusal::Columns)?;
                    Ok(gradients.by_parameters(&d_material))
                })*
                _ => unreachable!("every model of the list has derivatives"),
            }
        };
    }
    hairis_variants::for_each_model!(each)
}
