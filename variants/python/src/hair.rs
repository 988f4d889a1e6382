//! Hair of Python: a model with checked parameters.

use crate::fields::{Value, check, double, fields_of, no_error};
use crate::text;
use hairis_capi::layout::{MATERIAL_SIZE, Params, RawMaterial};
use hairis_capi::setup;
use hairis_variants::{ModelId, Values};
use pyo3::prelude::*;

/// Hair: a model with checked parameters.
///
/// Parameters
/// ----------
/// model : str
///     "gaussian", "cauchy", "kajiya-kay", "chiang" or "d-eon"; `hairis.models()` lists them with their fields.
/// preset : str, optional
///     Name of values for all fields: "brown", "blond" and so on. Without a preset, fields have the model's defaults.
/// energy : {"conserving", "raw", "scaled"}
///     With "conserving", no direction returns more light than arrives. With "raw", the model stays as it is. With "scaled", the
///     model is darker but stays reciprocal.
/// like : {"cycles", "materialx", "osl", "pbrt", "mitsuba", "rtxcr"}, optional
///     Renderer whose names and defaults the fields of "chiang" have; the material has our fields.
/// color_of : {"mass", "fibre", "chiang"}, optional
///     Subject that shows the field `color`, linear RGB, under uniform light: a head of such hair, one fibre from its side, or a mass by the
///     published fit of "chiang". It decides the absorption, or the intensities of TT and TRT; a colour out of reach becomes the nearest.
/// **fields
///     Values in place of the preset's values: numbers, sequences of numbers, or words. Angles are in radians, colours in linear RGB.
///     The field "sampler" of "gaussian" and "cauchy" and the field "select" of "chiang" choose how directions are sampled.
///
/// Raises
/// ------
/// ValueError
///     If a name does not exist or a value is out of its range. The message lists the valid names, or states the rule.
///
/// Examples
/// --------
/// >>> hair = hairis.Material("gaussian", "brown", sampler="matched", i_g=0.5)
/// >>> hair.fields["i_g"]
/// 0.5
/// >>> eval(repr(hair)) == hair
/// True
/// >>> hairis.Material("chiang", like="cycles", roughness=0.2, coat=0.5).fields["beta_m"]
/// 0.2
/// >>> hair = hairis.Material("d-eon", roughness=0.3, color=(0.5, 0.3, 0.1), color_of="fibre")
/// >>> [round(absorption, 2) for absorption in hair.fields["sigma_a"]]
/// [0.4, 0.73, 1.83]
/// >>> hairis.Material("gaussian", beta=(0.1, 0.0, 0.2))
/// Traceback (most recent call last):
/// ValueError: beta[1] must be a width in [1e-4, pi] rad, got 0
#[pyclass(frozen, module = "hairis")]
pub(crate) struct Material {
    pub(crate) raw: RawMaterial,
    pub(crate) id: ModelId,
    pub(crate) values: Values,
    pub(crate) energy: &'static str,
}

impl Material {
    /// Makes a material from parameters, and from an energy with its code.
    pub(crate) fn of(params: &Params, (energy, code): (&'static str, u32)) -> PyResult<Self> {
        let mut error = no_error();
        let mut raw = RawMaterial {
            head: [0; 4],
            body: [0; MATERIAL_SIZE - 16],
        };
        // SAFETY: the arguments are of this call.
        let (status, read) = unsafe {
            let status = setup::hairis_material_init(&raw mut raw, params, code, &raw mut error);
            (status, setup::values_of(params, core::ptr::null_mut()))
        };
        check(status, &error)?;
        let Ok((id, values)) = read else {
            unreachable!("the material is made of them")
        };
        Ok(Self {
            raw,
            id,
            values,
            energy,
        })
    }

    /// Returns the model and the values of its fields.
    pub(crate) const fn model_and_values(&self) -> (ModelId, &Values) {
        (self.id, &self.values)
    }

    /// Returns the fields that have a value.
    pub(crate) fn given(&self) -> Vec<(&'static str, Value)> {
        fields_of(&self.values.map(double))
    }

    /// Returns the expression of Python that makes the material.
    pub(crate) fn expression(&self) -> String {
        text::call(self.id, self.energy, &self.given())
    }
}
