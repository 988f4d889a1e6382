//! BSDFs of Python: a material at a hit, and its calls on many directions.

use crate::arrays::{Detached, EVALS, Input, Outputs, SAMPLES, evals, samples};
use crate::fields::double;
use crate::hair::Material;
use crate::shapes::{EVAL, PDF, SAMPLE, any_shape, one, pair};
use crate::text::literal;
use crate::values::{items, vector, word};
use hairis_capi::layout::{BSDF_SIZE, LOBES, LobeResult, RawBsdf};
use hairis_capi::{columns, points};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// Material at a hit, seen from one direction, which `Material.prepare` makes.
///
/// Examples
/// --------
/// >>> bsdf = hairis.Material("gaussian", "brown", sampler="matched").prepare(wo=(0.6, 0.0, 0.8))
/// >>> xi = np.random.default_rng(1).random((3, 1000), np.float32)
/// >>> samples = bsdf.sample_columns(xi)
/// >>> samples["weight"].shape
/// (3, 1000)
#[pyclass(frozen, module = "hairis")]
pub(crate) struct Bsdf {
    material: Py<Material>,
    wo: [f32; 3],
    h: f32,
    /// Bit i is set if lobe i is kept.
    lobes: u32,
    raw: RawBsdf,
}

impl Bsdf {
    pub(crate) fn new(material: Py<Material>, wo: [f32; 3], h: f32) -> Self {
        let mut raw = RawBsdf {
            head: [0; 4],
            body: [0; BSDF_SIZE - 16],
        };
        // SAFETY: the material is initialised, and the BSDF of this call.
        unsafe {
            let of = &raw const material.get().raw;
            points::hairis_prepare(&raw mut raw, of, wo[0], wo[1], wo[2], h);
        }
        Self {
            material,
            wo,
            h,
            lobes: (1 << LOBES) - 1,
            raw,
        }
    }

    /// Returns the names of the lobes that are kept.
    fn kept(&self) -> Vec<&'static str> {
        let names = self.names().iter().enumerate();
        names
            .filter(|(slot, _)| self.lobes >> slot & 1 == 1)
            .map(|(_, name)| *name)
            .collect()
    }

    fn is_whole(&self) -> bool {
        self.kept().len() == self.names().len()
    }

    /// Returns the names of the lobes of the model, by slot.
    fn names(&self) -> &'static [&'static str] {
        self.material.get().id.lobes()
    }
}

#[pymethods]
impl Bsdf {
    /// Computes the directional albedo of each lobe by name: the integral of value times cosine over all directions, linear RGB.
    ///
    /// Examples
    /// --------
    /// >>> list(hairis.Material("gaussian").prepare((0, 1, 0)).albedo())
    /// ['r', 'tt', 'trt', 'glint']
    fn albedo<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mut lobes = [[0.0; 3]; LOBES];
        // SAFETY: the BSDF is prepared.
        unsafe { points::hairis_albedo(&raw const self.raw, &raw mut lobes) };
        let by_name = PyDict::new(py);
        for (name, rgb) in self.names().iter().zip(lobes) {
            by_name.set_item(name, PyTuple::new(py, rgb.map(double))?)?;
        }
        Ok(by_name)
    }

    /// Evaluates each lobe by name at one direction: its value without its colour, its colour, and its own density.
    ///
    /// Parameters
    /// ----------
    /// wi : sequence of 3 floats
    ///     Direction towards the light, in the fibre's frame, of unit length.
    ///
    /// Examples
    /// --------
    /// >>> bsdf = hairis.Material("kajiya-kay").prepare((0, 1, 0))
    /// >>> value, color, pdf = bsdf.lobes((0, 0, 1))["diffuse"]
    /// >>> len(color)
    /// 3
    fn lobes<'py>(&self, py: Python<'py>, wi: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let wi = vector("wi", wi)?;
        let mut lobes = [LobeResult::default(); LOBES];
        // SAFETY: the BSDF is prepared.
        unsafe { points::hairis_lobes(&raw const self.raw, wi[0], wi[1], wi[2], &raw mut lobes) };
        let by_name = PyDict::new(py);
        for (name, lobe) in self.names().iter().zip(lobes) {
            let color = PyTuple::new(py, lobe.color.map(double))?;
            by_name.set_item(name, (double(lobe.value), color, double(lobe.pdf)))?;
        }
        Ok(by_name)
    }

    /// Returns the BSDF with only these lobes; the others neither scatter nor are sampled.
    ///
    /// Examples
    /// --------
    /// >>> bsdf = hairis.Material("gaussian").prepare((0, 1, 0)).with_lobes(["r"])
    /// >>> bsdf.albedo()["tt"]
    /// (0.0, 0.0, 0.0)
    fn with_lobes(&self, names: &Bound<'_, PyAny>) -> PyResult<Self> {
        let known = self.names();
        let mut lobes = 0;
        for (i, name) in items("lobes", "a list of names", names)?.iter().enumerate() {
            let name = word(&format_args!("lobes[{i}]"), name)?;
            let Some(slot) = known.iter().position(|one| *one == name) else {
                let known = known.join(", ");
                return Err(PyValueError::new_err(format!(
                    "lobes must be some of {known}, got {name:?}"
                )));
            };
            lobes |= 1 << slot;
        }
        let mut raw = self.raw;
        // SAFETY: the BSDF is prepared.
        unsafe { points::hairis_restrict(&raw mut raw, lobes) };
        Python::attach(|py| {
            let material = self.material.clone_ref(py);
            Ok(Self {
                material,
                lobes: self.lobes & lobes,
                raw,
                ..*self
            })
        })
    }

    /// Evaluates S without the cosine, linear RGB, per steradian.
    ///
    /// Parameters
    /// ----------
    /// wi : array_like, shape (..., 3)
    ///     Directions towards the light, in the fibre's frame, of unit length: one, or any number in any shape.
    ///
    /// Returns
    /// -------
    /// ndarray, float32, shape (..., 3)
    ///
    /// Examples
    /// --------
    /// >>> bsdf = hairis.Material("gaussian", "brown").prepare((0.6, 0.0, 0.8))
    /// >>> bsdf.eval((0, 0.6, 0.8)).shape, bsdf.eval(np.ones((4, 5, 3))).shape
    /// ((3,), (4, 5, 3))
    fn eval<'py>(slf: &Bound<'py, Self>, wi: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        one(
            &any_shape(slf.as_any(), "eval_columns", &EVAL, &[("wi", wi)], None)?,
            EVAL[0],
        )
    }

    /// Evaluates the density with which `sample` draws directions, per steradian.
    ///
    /// Parameters
    /// ----------
    /// wi : array_like, shape (..., 3)
    ///     As in `eval`.
    ///
    /// Returns
    /// -------
    /// ndarray, float32, shape (...)
    ///
    /// Examples
    /// --------
    /// >>> bsdf = hairis.Material("gaussian", "brown").prepare((0.6, 0.0, 0.8))
    /// >>> bool(bsdf.pdf((0, 0.6, 0.8)) > 0)
    /// True
    fn pdf<'py>(slf: &Bound<'py, Self>, wi: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        one(
            &any_shape(slf.as_any(), "eval_columns", &PDF, &[("wi", wi)], None)?,
            PDF[0],
        )
    }

    /// Evaluates what `eval` and `pdf` return, in one call that takes the time of one of them.
    ///
    /// Examples
    /// --------
    /// >>> value, pdf = hairis.Material("chiang").prepare((0, 1, 0)).eval_pdf(np.ones((4, 3)))
    /// >>> value.shape, pdf.shape
    /// ((4, 3), (4,))
    fn eval_pdf<'py>(
        slf: &Bound<'py, Self>,
        wi: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let both = [EVAL[0], PDF[0]];
        pair(&any_shape(
            slf.as_any(),
            "eval_columns",
            &both,
            &[("wi", wi)],
            None,
        )?)
    }

    /// Draws samples at the hit.
    ///
    /// Parameters
    /// ----------
    /// xi : array_like, shape (..., 3)
    ///     Uniform numbers in [0, 1), which select the lobe, the inclination and the azimuth.
    ///
    /// Returns
    /// -------
    /// dict
    ///     "wi", "value" and "weight", shape (..., 3), "pdf" and "lobe", shape (...): as in `Material.sample_hits`.
    ///
    /// Examples
    /// --------
    /// >>> bsdf = hairis.Material("gaussian", "brown").prepare((0.6, 0.0, 0.8))
    /// >>> bsdf.sample(np.random.default_rng(1).random((10, 3)))["wi"].shape
    /// (10, 3)
    fn sample<'py>(slf: &Bound<'py, Self>, xi: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        any_shape(slf.as_any(), "sample_columns", &SAMPLE, &[("xi", xi)], None)
    }

    /// Evaluates values and densities of N directions.
    ///
    /// Parameters
    /// ----------
    /// wi : ndarray, float32, shape (3, N), C-contiguous
    ///     Directions towards the light, in the fibre's frame, of unit length.
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
    /// >>> bsdf = hairis.Material("cauchy", "red").prepare((0, 1, 0))
    /// >>> out = {"pdf": np.empty(2, np.float32)}
    /// >>> bsdf.eval_columns(np.eye(3, 2, -1, np.float32), out=out) is out
    /// True
    #[pyo3(signature = (wi, *, out=None))]
    fn eval_columns<'py>(
        &self,
        py: Python<'py>,
        wi: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let wi = Input::new("wi", wi, 3, None)?;
        let n = wi.n;
        let outputs = Outputs::new(py, out, &EVALS, &[&wi])?;
        let (raw, rows, to) = (&raw const self.raw, wi.rows(), evals(&outputs));
        // SAFETY: the arrays have n numbers in each row, and are borrowed.
        Detached(move || unsafe {
            columns::hairis_eval_columns(raw, n, &raw const rows, &raw const to)
        })
        .run(py)?;
        Ok(outputs.dict)
    }

    /// Draws N samples at the hit.
    ///
    /// Parameters
    /// ----------
    /// xi : ndarray, float32, shape (3, N), C-contiguous
    ///     Uniform numbers in [0, 1), which select the lobe, the inclination and the azimuth.
    /// out : dict, optional
    ///     Arrays to write, for some or all of the columns below; other columns are not written. Without it, all arrays are new.
    ///
    /// Returns
    /// -------
    /// dict
    ///     "wi", "value" and "weight", shape (3, N), "pdf" and "lobe", shape (N,): as in `Material.sample_hits`.
    ///
    /// Examples
    /// --------
    /// >>> xi = np.random.default_rng(1).random((3, 4096), np.float32)
    /// >>> bsdf = hairis.Material("gaussian", "brown", sampler="matched").prepare((0, 1, 0))
    /// >>> albedo = sum(lobe[0] for lobe in bsdf.albedo().values())
    /// >>> bool(abs(bsdf.sample_columns(xi)["weight"][0].mean() / albedo - 1) < 0.05)
    /// True
    #[pyo3(signature = (xi, *, out=None))]
    fn sample_columns<'py>(
        &self,
        py: Python<'py>,
        xi: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let xi = Input::new("xi", xi, 3, None)?;
        let n = xi.n;
        let outputs = Outputs::new(py, out, &SAMPLES, &[&xi])?;
        let (raw, rows, to) = (&raw const self.raw, xi.rows(), samples(&outputs));
        // SAFETY: the arrays have n numbers in each row, and are borrowed.
        Detached(move || unsafe {
            columns::hairis_sample_columns(raw, n, &raw const rows, &raw const to)
        })
        .run(py)?;
        Ok(outputs.dict)
    }

    fn __repr__(&self) -> String {
        let [u, v, w] = self.wo.map(|x| literal(double(x)));
        let (material, h) = (self.material.get().expression(), literal(double(self.h)));
        let lobes = if self.is_whole() {
            String::new()
        } else {
            format!(".with_lobes({:?})", self.kept())
        };
        format!("{material}.prepare(({u}, {v}, {w}), {h}){lobes}")
    }

    /// Returns the call that makes the same BSDF, for pickle and copy.
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let make = py.import("hairis._make")?.getattr("bsdf")?;
        let lobes = if self.is_whole() {
            None
        } else {
            Some(self.kept())
        };
        let arguments = (
            self.material.clone_ref(py),
            self.wo.map(double),
            double(self.h),
            lobes,
        );
        Ok((make, arguments.into_pyobject(py)?))
    }
}
