//! Materials of Python: a model with checked parameters, and its calls on many hits.

use crate::arrays::{Detached, EVALS, Input, Outputs, SAMPLES, evals, samples};
use crate::bsdf::Bsdf;
use crate::fields::{Value, check, double, fields_of, no_error};
use crate::gradients::{self, GRADIENTS, Inputs};
use crate::values::{CONSERVING, energy_of, number, params_of, vector, word, written};
use core::fmt::Write;
use hairis_capi::layout::{Hits, MATERIAL_SIZE, Params, RawMaterial};
use hairis_capi::{hits, setup};
use hairis_materials::MaterialSpec;
use hairis_variants::{ModelId, Values};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple};

/// Hair: a model with checked parameters.
///
/// Parameters
/// ----------
/// model : str
///     "gaussian", "cauchy", "kajiya-kay" or "chiang"; `hairis.models()` lists them with their fields.
/// preset : str, optional
///     Name of values for all fields: "brown", "blond" and so on. Without a preset, fields have the model's defaults.
/// energy : {"conserving", "raw", "scaled"}
///     With "conserving", no direction returns more light than arrives. With "raw", the model stays as it is. With "scaled", the
///     model is darker but stays reciprocal.
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
/// >>> hairis.Material("gaussian", beta=(0.1, 0.0, 0.2))
/// Traceback (most recent call last):
/// ValueError: beta[1] must be a width in [1e-4, pi] rad, got 0
#[pyclass(frozen, module = "hairis")]
pub(crate) struct Material {
    pub(crate) raw: RawMaterial,
    pub(crate) id: ModelId,
    values: Values,
    energy: &'static str,
}

/// Columns of hits that a call reads: `wo`, directions or uniform numbers, and `h`.
type Columns<'py> = (Input<'py>, Input<'py>, Option<Input<'py>>);

/// Returns all columns of hits.
fn all<'a, 'py>((wo, third, h): &'a Columns<'py>) -> Vec<&'a Input<'py>> {
    [wo, third].into_iter().chain(h).collect()
}

/// Function of the C interface on hits, which writes columns `T`.
type Call<T> = unsafe extern "C" fn(
    *const RawMaterial,
    usize,
    usize,
    *const Hits,
    *const [*const f32; 3],
    *const T,
) -> i32;

impl Material {
    /// Makes a material from parameters, and from an energy with its code.
    fn of(params: &Params, (energy, code): (&'static str, u32)) -> PyResult<Self> {
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

    /// Returns the fields that have a value.
    fn given(&self) -> Vec<(&'static str, Value)> {
        fields_of(&self.values.map(double))
    }

    /// Returns the call that makes the material of these values.
    fn call_of(&self, values: &Values) -> String {
        let (name, energy) = (self.id.name(), self.energy);
        let mut text = format!("hairis.Material(\"{name}\", energy=\"{energy}\"");
        if let Some((field, word)) = self.id.choice() {
            let _ = write!(text, ", {field}=\"{word}\"");
        }
        for (name, value) in fields_of(&values.map(double)) {
            let _ = write!(text, ", {name}={}", written(&value, false));
        }
        text + ")"
    }

    /// Calls the C interface on hits. The caller must hold a borrow of the arrays of `to`.
    fn call<T>(
        &self,
        py: Python<'_>,
        (wo, third, h): &Columns<'_>,
        to: &T,
        call: Call<T>,
    ) -> PyResult<()> {
        let hits = Hits {
            wo: wo.rows(),
            h: h.as_ref().map_or(core::ptr::null(), |h| h.rows()[0]),
            index: core::ptr::null(),
        };
        let (raw, n, rows) = (&raw const self.raw, wo.n, third.rows());
        // SAFETY: the arrays have n numbers in each row, and are borrowed.
        Detached(move || unsafe { call(raw, 1, n, &raw const hits, &raw const rows, to) }).run(py)
    }

    /// Reads the columns of hits: `wo`, `h` and the third, all of one length.
    fn inputs<'py>(
        wo: &Bound<'py, PyAny>,
        third: (&'static str, &Bound<'py, PyAny>),
        h: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Columns<'py>> {
        let wo = Input::new("wo", wo, 3, None)?;
        let n = Some(wo.n);
        let third = Input::new(third.0, third.1, 3, n)?;
        Ok((wo, third, h.map(|h| Input::new("h", h, 1, n)).transpose()?))
    }
}

/// Reads the argument `model`.
fn model_of(value: &Bound<'_, PyAny>) -> PyResult<String> {
    word(&"model", value)
}

/// Reads the argument `h`.
fn offset_of(value: &Bound<'_, PyAny>) -> PyResult<f32> {
    number(&"h", value)
}

/// Makes a dict of values by name, each a float, a tuple of floats or a word.
fn dict_of(
    py: Python<'_>,
    values: impl IntoIterator<Item = (&'static str, Value)>,
) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    for (name, value) in values {
        match value {
            Value::Number(x) => dict.set_item(name, x)?,
            Value::Numbers(numbers) => dict.set_item(name, PyTuple::new(py, numbers)?)?,
            Value::Word(word) => dict.set_item(name, word)?,
        }
    }
    Ok(dict)
}

#[pymethods]
impl Material {
    #[new]
    #[pyo3(
        signature = (model="gaussian".to_owned(), preset=None, *, energy=CONSERVING, **fields),
        text_signature = "(model='gaussian', preset=None, *, energy='conserving', **fields)"
    )]
    fn new(
        #[pyo3(from_py_with = model_of)] model: String,
        preset: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = energy_of)] energy: (&'static str, u32),
        fields: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let preset = preset.map(|preset| word(&"preset", preset)).transpose()?;
        Self::of(&params_of(&model, preset.as_deref(), fields)?, energy)
    }

    /// Makes a material from a JSON object of `hairis eval`, which has "model", "params", and the field of its choice. The fields of a
    /// query are ignored.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If `hairis eval` rejects the material: a field is missing, unknown, given twice or out of its range. The message names it.
    ///
    /// Examples
    /// --------
    /// >>> hair = hairis.Material("cauchy", "blond", sampler="matched")
    /// >>> hairis.Material.from_json(hair.to_json()) == hair
    /// True
    #[staticmethod]
    #[pyo3(signature = (text, *, energy=CONSERVING), text_signature = "(text, *, energy='conserving')")]
    fn from_json(
        text: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = energy_of)] energy: (&'static str, u32),
    ) -> PyResult<Self> {
        let text = word(&"text", text)?;
        let materials = MaterialSpec::parse_all(&text).map_err(PyValueError::new_err)?;
        let [material] = &materials[..] else {
            let count = materials.len();
            return Err(PyValueError::new_err(format!(
                "text must have one material, got {count}"
            )));
        };
        let params = setup::params_of(material.model, &material.values);
        Self::of(&params, energy)
    }

    /// Writes the material as a JSON object of `hairis eval`, in one line. The energy is not part of the object.
    ///
    /// Examples
    /// --------
    /// >>> hairis.Material("kajiya-kay", "brown").to_json()[:34]
    /// '{"model": "kajiya-kay", "params": '
    fn to_json(&self) -> String {
        let choice = self.id.choice().map_or_else(String::new, |(field, word)| {
            format!(" \"{field}\": \"{word}\",")
        });
        let given = self.given();
        let params: Vec<_> = given
            .iter()
            .map(|(name, value)| format!("\"{name}\": {}", written(value, true)))
            .collect();
        format!(
            "{{\"model\": \"{}\",{choice} \"params\": {{{}}}}}",
            self.id.name(),
            params.join(", ")
        )
    }

    /// Name of the model: "gaussian", "cauchy", "kajiya-kay" or "chiang".
    #[getter]
    fn model(&self) -> &'static str {
        self.id.name()
    }

    /// Word of "sampler" or "select", which decides how directions are sampled; None if the model has no choice.
    #[getter]
    fn choice(&self) -> Option<&'static str> {
        self.id.choice().map(|(_, word)| word)
    }

    /// Energy of the material: "raw", "conserving" or "scaled".
    #[getter]
    const fn energy(&self) -> &'static str {
        self.energy
    }

    /// Values of the fields by name, each a float, a tuple of floats or a word.
    #[getter]
    fn fields<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        dict_of(py, self.given())
    }

    /// Names of the lobes by slot, which is the number in the column "lobe" of samples.
    #[getter]
    fn lobe_names(&self) -> &'static [&'static str] {
        self.id.lobes()
    }

    /// True if the model reads `h`, the offset of a hit across the fibre.
    #[getter]
    fn near_field(&self) -> bool {
        self.id.is_near_field()
    }

    /// Largest directional albedo, without the factor of energy "conserving". Above 1, the model returns more light than arrives.
    #[getter]
    fn max_albedo(&self) -> f64 {
        // SAFETY: the material is initialised.
        double(unsafe { setup::hairis_material_max_albedo(&raw const self.raw) })
    }

    /// Prepares the BSDF of the material at a hit.
    ///
    /// Parameters
    /// ----------
    /// wo : sequence of 3 floats
    ///     Direction towards the viewer, in the fibre's frame: u runs along the fibre from root to tip, and v and w lie across it.
    /// h : float
    ///     Offset of the hit across the fibre, in [-1, 1]; only "chiang" reads it.
    ///
    /// Examples
    /// --------
    /// >>> bsdf = hairis.Material("chiang").prepare((0.6, 0.8, 0.0), h=0.3)
    /// >>> sum(lobe[0] for lobe in bsdf.albedo().values()) <= 1.001
    /// True
    #[pyo3(signature = (wo, h=0.0))]
    fn prepare(
        slf: Bound<'_, Self>,
        wo: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = offset_of)] h: f32,
    ) -> PyResult<Bsdf> {
        Ok(Bsdf::new(slf.unbind(), vector("wo", wo)?, h))
    }

    /// Evaluates values and densities of N directions, each at a hit of its own.
    ///
    /// Parameters
    /// ----------
    /// wo, wi : ndarray, float32, shape (3, N), C-contiguous
    ///     Directions towards the viewer and the light, in the fibre's frame, of unit length.
    /// h : ndarray, float32, shape (N,), optional
    ///     Offsets of the hits across the fibre, in [-1, 1]; 0 if left out.
    /// out : dict, optional
    ///     Arrays to write, for some or all of the columns below; other columns are not written. Without it, all arrays are new.
    ///
    /// Returns
    /// -------
    /// dict
    ///     "value", shape (3, N): S without the cosine, linear RGB, per steradian. "pdf", shape (N,): density, per steradian. If `out`
    ///     is given, it is this dict.
    ///
    /// Examples
    /// --------
    /// >>> wo, wi = np.zeros((2, 3, 5), np.float32)
    /// >>> wo[1], wi[2] = 1, 1
    /// >>> hairis.Material("gaussian", "blond").eval_hits(wo, wi)["value"].shape
    /// (3, 5)
    #[pyo3(signature = (wo, wi, h=None, *, out=None))]
    fn eval_hits<'py>(
        &self,
        py: Python<'py>,
        wo: &Bound<'py, PyAny>,
        wi: &Bound<'py, PyAny>,
        h: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let inputs = Self::inputs(wo, ("wi", wi), h)?;
        let outputs = Outputs::new(py, out, &EVALS, &all(&inputs))?;
        self.call(py, &inputs, &evals(&outputs), hits::hairis_eval_hits)?;
        Ok(outputs.dict)
    }

    /// Draws N samples, each at a hit of its own.
    ///
    /// Parameters
    /// ----------
    /// wo : ndarray, float32, shape (3, N), C-contiguous
    ///     Directions towards the viewer, in the fibre's frame, of unit length.
    /// xi : ndarray, float32, shape (3, N), C-contiguous
    ///     Uniform numbers in [0, 1), which select the lobe, the inclination and the azimuth.
    /// h : ndarray, float32, shape (N,), optional
    ///     Offsets of the hits across the fibre, in [-1, 1]; 0 if left out.
    /// out : dict, optional
    ///     Arrays to write, for some or all of the columns below; other columns are not written. Without it, all arrays are new.
    ///
    /// Returns
    /// -------
    /// dict
    ///     "wi", shape (3, N): directions. "value", shape (3, N), and "pdf", shape (N,): as in `eval_hits`. "weight", shape (3, N):
    ///     value times the cosine over the density. "lobe", shape (N,): place in `lobe_names`, or -1 for a discarded sample. A discarded
    ///     sample has a value, pdf and weight of 0, and still counts.
    ///
    /// Examples
    /// --------
    /// >>> wo = np.repeat(np.array([[0.6], [0.8], [0]], np.float32), 1000, axis=1)
    /// >>> xi = np.random.default_rng(1).random((3, 1000), np.float32)
    /// >>> samples = hairis.Material("gaussian", "brown", sampler="matched").sample_hits(wo, xi)
    /// >>> bool(0.1 < samples["weight"].mean() < 1)
    /// True
    #[pyo3(signature = (wo, xi, h=None, *, out=None))]
    fn sample_hits<'py>(
        &self,
        py: Python<'py>,
        wo: &Bound<'py, PyAny>,
        xi: &Bound<'py, PyAny>,
        h: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let inputs = Self::inputs(wo, ("xi", xi), h)?;
        let outputs = Outputs::new(py, out, &SAMPLES, &all(&inputs))?;
        self.call(py, &inputs, &samples(&outputs), hits::hairis_sample_hits)?;
        Ok(outputs.dict)
    }

    /// Evaluates N directions, each at a hit of its own, and the derivatives of a loss of their values.
    ///
    /// Parameters
    /// ----------
    /// wo, wi, h
    ///     As in `eval_hits`.
    /// d_value : ndarray, float32, shape (3, N), C-contiguous
    ///     Derivative of the loss by each value, which reverse mode calls the cotangent of the value.
    /// out : dict, optional
    ///     Arrays to write, for some or all of the columns below; other columns are not written. Without it, all arrays are new.
    ///
    /// Returns
    /// -------
    /// columns : dict
    ///     "value", shape (3, N): the same bits as in `eval_hits`. "d_wo" and "d_wi", shape (3, N), and "d_h", shape (N,): derivatives
    ///     of the loss. If `out` is given, it is this dict.
    /// d_fields : dict
    ///     Derivatives of the loss by the fields that have numbers, summed over all hits, in the form of `fields`: by "color" and by
    ///     "beta_n" at that colour, if the material has a colour.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If a material of "gaussian" or "cauchy" has another energy than "raw", because the factor of energy has no derivatives.
    ///
    /// Examples
    /// --------
    /// >>> wo, wi = np.zeros((2, 3, 5), np.float32)
    /// >>> wo[1], wi[2] = 1, 1
    /// >>> hair = hairis.Material("gaussian", "blond", energy="raw")
    /// >>> columns, d_fields = hair.eval_grad(wo, wi, np.ones((3, 5), np.float32))
    /// >>> len(d_fields["beta"]), columns["d_wi"].shape
    /// (3, (3, 5))
    #[pyo3(signature = (wo, wi, d_value, h=None, *, out=None))]
    fn eval_grad<'py>(
        &self,
        py: Python<'py>,
        wo: &Bound<'py, PyAny>,
        wi: &Bound<'py, PyAny>,
        d_value: &Bound<'py, PyAny>,
        h: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<(Bound<'py, PyDict>, Bound<'py, PyDict>)> {
        let hits = Self::inputs(wo, ("wi", wi), h)?;
        let d_value = Input::new("d_value", d_value, 3, Some(hits.0.n))?;
        let read = [&all(&hits)[..], &[&d_value]].concat();
        let outputs = Outputs::new(py, out, &GRADIENTS, &read)?;
        let (wo, wi, h) = &hits;
        let (id, values) = (self.id, &self.values);
        let (inputs, is_raw) = (
            Inputs {
                wo,
                h: h.as_ref(),
                wi,
                d_value: &d_value,
            },
            self.energy == "raw",
        );
        let (rows, mut done) = (&outputs.rows[..], None);
        let to = &mut done;
        Detached(move || {
            // SAFETY: the arrays have n numbers in each row, and are borrowed.
            *to = Some(unsafe { gradients::eval_grad(id, values, is_raw, &inputs, rows) });
            0
        })
        .run(py)?;
        let derivatives = match done {
            Some(Ok(derivatives)) => derivatives,
            Some(Err(refusal)) => return Err(refusal.raise(self.energy)),
            None => unreachable!("the call ran"),
        };
        let d_fields = fields_of(&derivatives).into_iter();
        let numbers = d_fields.filter(|(_, value)| !matches!(value, Value::Word(_)));
        Ok((outputs.dict, dict_of(py, numbers)?))
    }

    pub(crate) fn __repr__(&self) -> String {
        self.call_of(&self.values)
    }

    fn __eq__(&self, other: &Self) -> bool {
        (self.id, self.energy, self.values) == (other.id, other.energy, other.values)
    }

    /// Hashes 0 and -0, which are equal, alike.
    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        let values = self.values.map(|x| x + 0.0);
        PyString::new(py, &self.call_of(&values)).hash()
    }

    /// Returns the arguments of the call that makes the same material, for pickle and copy.
    fn __getnewargs_ex__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<((&'static str,), Bound<'py, PyDict>)> {
        let arguments = self.fields(py)?;
        arguments.set_item("energy", self.energy)?;
        if let Some((field, word)) = self.id.choice() {
            arguments.set_item(field, word)?;
        }
        Ok(((self.id.name(),), arguments))
    }
}
