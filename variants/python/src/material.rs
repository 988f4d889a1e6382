//! Materials of Python: a model with checked parameters, and its calls on many hits.

use crate::arrays::{EVALS, Outputs, SAMPLES, evals, samples};
use crate::bsdf::Bsdf;
use crate::fields::{Value, dict_of, double, fields_of};
use crate::gradients;
use crate::hair::Material;
use crate::hits::{all, call, inputs};
use crate::shapes::{EVAL, PDF, SAMPLE, any_shape, one, pair};
use crate::text;
use crate::values::{
    CONSERVING, energy_of, number, params_like, params_of, set_color, take_color, vector, word,
};
use hairis_capi::{hits, setup};
use hairis_materials::MaterialSpec;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple};

/// Reads the argument `model`.
fn model_of(value: &Bound<'_, PyAny>) -> PyResult<String> {
    word(&"model", value)
}

/// Reads the argument `h`.
fn offset_of(value: &Bound<'_, PyAny>) -> PyResult<f32> {
    number(&"h", value)
}

#[pymethods]
impl Material {
    #[new]
    #[pyo3(
        signature = (model="gaussian".to_owned(), preset=None, *, energy=CONSERVING, like=None, color_of=None, **fields),
        text_signature = "(model='gaussian', preset=None, *, energy='conserving', like=None, color_of=None, **fields)"
    )]
    fn new(
        #[pyo3(from_py_with = model_of)] model: String,
        preset: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = energy_of)] energy: (&'static str, u32),
        like: Option<&Bound<'_, PyAny>>,
        color_of: Option<&Bound<'_, PyAny>>,
        fields: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let color = color_of.map(|of| take_color(of, fields)).transpose()?;
        let preset = preset.map(|preset| word(&"preset", preset)).transpose()?;
        let like = like.map(|like| word(&"like", like)).transpose()?;
        let mut params = match like {
            Some(like) => params_like(&model, preset.as_deref(), &like, fields)?,
            None => params_of(&model, preset.as_deref(), fields)?,
        };
        if let Some(color) = color {
            set_color(&mut params, &color)?;
        }
        Self::of(&params, energy)
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
        text::json(self.id, &self.given())
    }

    /// Name of the model: "gaussian", "cauchy", "kajiya-kay", "chiang" or "d-eon".
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

    /// Evaluates S without the cosine, linear RGB, per steradian, each direction at a hit of its own.
    ///
    /// Parameters
    /// ----------
    /// wo, wi : array_like, shape (..., 3)
    ///     Directions towards the viewer and the light, in the fibre's frame, of unit length. All shapes broadcast.
    /// h : array_like, shape (...)
    ///     Offsets of the hits across the fibre, in [-1, 1].
    ///
    /// Returns
    /// -------
    /// ndarray, float32, shape (..., 3)
    ///
    /// Examples
    /// --------
    /// >>> hairis.Material("chiang").eval((0, 1, 0), np.ones((4, 1, 3)), h=np.linspace(-1, 1, 5)).shape
    /// (4, 5, 3)
    #[pyo3(signature = (wo, wi, h=None))]
    fn eval<'py>(
        slf: &Bound<'py, Self>,
        wo: &Bound<'py, PyAny>,
        wi: &Bound<'py, PyAny>,
        h: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let vectors = [("wo", wo), ("wi", wi)];
        one(
            &any_shape(slf.as_any(), "eval_hits", &EVAL, &vectors, h)?,
            EVAL[0],
        )
    }

    /// Evaluates the density with which `sample` draws directions, per steradian: an array of shape (...), of the arguments of `eval`.
    ///
    /// Examples
    /// --------
    /// >>> hairis.Material("gaussian").pdf(np.ones((4, 3)), (0, 0, 1)).shape
    /// (4,)
    #[pyo3(signature = (wo, wi, h=None))]
    fn pdf<'py>(
        slf: &Bound<'py, Self>,
        wo: &Bound<'py, PyAny>,
        wi: &Bound<'py, PyAny>,
        h: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let vectors = [("wo", wo), ("wi", wi)];
        one(
            &any_shape(slf.as_any(), "eval_hits", &PDF, &vectors, h)?,
            PDF[0],
        )
    }

    /// Evaluates what `eval` and `pdf` return, in one call that takes the time of one of them.
    ///
    /// Examples
    /// --------
    /// >>> [x.shape for x in hairis.Material("gaussian").eval_pdf((0, 1, 0), np.ones((4, 3)))]
    /// [(4, 3), (4,)]
    #[pyo3(signature = (wo, wi, h=None))]
    fn eval_pdf<'py>(
        slf: &Bound<'py, Self>,
        wo: &Bound<'py, PyAny>,
        wi: &Bound<'py, PyAny>,
        h: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let (vectors, both) = ([("wo", wo), ("wi", wi)], [EVAL[0], PDF[0]]);
        pair(&any_shape(slf.as_any(), "eval_hits", &both, &vectors, h)?)
    }

    /// Draws samples, each at a hit of its own.
    ///
    /// Parameters
    /// ----------
    /// wo : array_like, shape (..., 3)
    ///     Directions towards the viewer, in the fibre's frame, of unit length. All shapes broadcast.
    /// xi : array_like, shape (..., 3)
    ///     Uniform numbers in [0, 1), which select the lobe, the inclination and the azimuth.
    /// h : array_like, shape (...)
    ///     Offsets of the hits across the fibre, in [-1, 1].
    ///
    /// Returns
    /// -------
    /// dict
    ///     "wi", "value" and "weight", shape (..., 3), "pdf" and "lobe", shape (...): as in `sample_hits`.
    ///
    /// Examples
    /// --------
    /// >>> xi = np.random.default_rng(1).random((2, 10, 3))
    /// >>> hairis.Material("cauchy").sample((0.6, 0.8, 0), xi)["weight"].shape
    /// (2, 10, 3)
    #[pyo3(signature = (wo, xi, h=None))]
    fn sample<'py>(
        slf: &Bound<'py, Self>,
        wo: &Bound<'py, PyAny>,
        xi: &Bound<'py, PyAny>,
        h: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let vectors = [("wo", wo), ("xi", xi)];
        any_shape(slf.as_any(), "sample_hits", &SAMPLE, &vectors, h)
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
        let inputs = inputs(wo, ("wi", wi), h)?;
        let outputs = Outputs::new(py, out, &EVALS, &all(&inputs))?;
        call(
            &self.raw,
            py,
            &inputs,
            &evals(&outputs),
            hits::hairis_eval_hits,
        )?;
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
        let inputs = inputs(wo, ("xi", xi), h)?;
        let outputs = Outputs::new(py, out, &SAMPLES, &all(&inputs))?;
        call(
            &self.raw,
            py,
            &inputs,
            &samples(&outputs),
            hits::hairis_sample_hits,
        )?;
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
        let (columns, derivatives) = gradients::call(
            py,
            (self.id, &self.values, self.energy),
            &inputs(wo, ("wi", wi), h)?,
            d_value,
            out,
        )?;
        let d_fields = fields_of(&derivatives).into_iter();
        let numbers = d_fields.filter(|(_, value)| !matches!(value, Value::Word(_)));
        Ok((columns, dict_of(py, numbers)?))
    }

    fn __repr__(&self) -> String {
        self.expression()
    }

    fn __eq__(&self, other: &Self) -> bool {
        (self.id, self.energy, self.values) == (other.id, other.energy, other.values)
    }

    /// Hashes 0 and -0, which are equal, alike.
    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        let given = fields_of(&self.values.map(|x| double(x + 0.0)));
        PyString::new(py, &text::call(self.id, self.energy, &given)).hash()
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
