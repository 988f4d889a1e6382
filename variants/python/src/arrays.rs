//! Columns of NumPy arrays, which are borrowed and never copied.

use crate::values::{description, wrong};
use core::fmt::{self, Display, Formatter};
use core::ops::Range;
use core::ptr;
use hairis_capi::layout::{Evals, Samples};
use numpy::{
    BorrowError, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn,
    PyReadwriteArrayDyn, PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyString};

/// Names of the columns that a call writes, with the number of rows of each.
pub(crate) struct Columns<const N: usize> {
    columns: [(&'static str, usize); N],
    /// The names as strings of Python, of which every call would otherwise make new ones.
    keys: PyOnceLock<[Py<PyString>; N]>,
}

impl<const N: usize> Columns<N> {
    pub(crate) const fn new(columns: [(&'static str, usize); N]) -> Self {
        Self {
            columns,
            keys: PyOnceLock::new(),
        }
    }

    fn keys(&self, py: Python<'_>) -> &[Py<PyString>; N] {
        self.keys.get_or_init(py, || {
            self.columns
                .map(|(name, _)| PyString::intern(py, name).unbind())
        })
    }
}

/// Columns of an evaluation.
pub(crate) static EVALS: Columns<2> = Columns::new([("value", 3), ("pdf", 1)]);
/// Columns of samples.
pub(crate) static SAMPLES: Columns<5> = Columns::new([
    ("wi", 3),
    ("value", 3),
    ("pdf", 1),
    ("weight", 3),
    ("lobe", 1),
]);

fn shape(rows: usize, n: Option<usize>) -> String {
    let n = n.map_or_else(|| "N".to_owned(), |n| n.to_string());
    if rows == 3 {
        format!("(3, {n})")
    } else {
        format!("({n},)")
    }
}

/// Converts the columns of an evaluation to the struct of the C interface.
pub(crate) fn evals(outputs: &Outputs<'_, 2>) -> Evals {
    let [value, [pdf, ..]] = outputs.rows;
    Evals { value, pdf }
}

/// Converts the columns of samples to the struct of the C interface.
pub(crate) fn samples(outputs: &Outputs<'_, 5>) -> Samples {
    let [wi, value, pdf, weight, lobe] = outputs.rows;
    Samples {
        wi,
        value,
        pdf: pdf[0],
        weight,
        lobe: lobe[0],
    }
}

/// Makes the exception for an array of another type, shape or layout than required.
fn refused(name: &dyn Display, rows: usize, n: Option<usize>, got: &Bound<'_, PyAny>) -> PyErr {
    let array = got.cast::<PyArrayDyn<f32>>().ok();
    let layout = match array {
        Some(array) if !array.is_c_contiguous() => ", not C-contiguous",
        Some(array) if !array.data().is_aligned() => ", not aligned",
        _ => "",
    };
    PyTypeError::new_err(format!(
        "{name} must be float32 of shape {}, C-contiguous and aligned; got {}{layout}",
        shape(rows, n),
        description(got)
    ))
}

/// Returns the array if it is float32 of this shape, C-contiguous and aligned, and an exception otherwise.
fn cast<'a, 'py>(
    name: &dyn Display,
    rows: usize,
    n: Option<usize>,
    any: &'a Bound<'py, PyAny>,
) -> PyResult<&'a Bound<'py, PyArrayDyn<f32>>> {
    let array = any
        .cast::<PyArrayDyn<f32>>()
        .map_err(|_| refused(name, rows, n, any))?;
    let fits = match array.shape() {
        [three, len] => rows == 3 && *three == 3 && n.is_none_or(|n| n == *len),
        [len] => rows == 1 && n.is_none_or(|n| n == *len),
        _ => false,
    };
    // NumPy calls every empty array aligned; slices have an aligned start even then.
    if fits && array.is_c_contiguous() && array.data().is_aligned() {
        Ok(array)
    } else {
        Err(refused(name, rows, n, any))
    }
}

/// Returns the address of each row of a column.
fn rows_of(start: *const f32, n: usize) -> [*const f32; 3] {
    [start, start.wrapping_add(n), start.wrapping_add(2 * n)]
}

/// Returns the addresses of a contiguous array.
fn addresses(array: &Bound<'_, PyArrayDyn<f32>>) -> Range<usize> {
    let start = array.data().addr();
    start..start + size_of::<f32>() * array.len()
}

/// Makes the exception for an array that a call of another thread writes, or that this call is to write and the other reads.
fn in_use(name: &dyn Display) -> PyErr {
    PyValueError::new_err(format!(
        "{name} is in use by another call; give each thread arrays of its own to write"
    ))
}

/// Column that a call reads.
pub(crate) struct Input<'py> {
    name: &'static str,
    array: PyReadonlyArrayDyn<'py, f32>,
    pub(crate) n: usize,
}

impl<'py> Input<'py> {
    /// Borrows a column of `rows` rows, which must have `n` numbers each if `n` is known.
    pub(crate) fn new(
        name: &'static str,
        any: &Bound<'py, PyAny>,
        rows: usize,
        n: Option<usize>,
    ) -> PyResult<Self> {
        let array = cast(&name, rows, n, any)?;
        let n = array.shape().last().copied().unwrap_or(0);
        let array = array.try_readonly().map_err(|_| in_use(&name))?;
        Ok(Self { name, array, n })
    }

    pub(crate) fn rows(&self) -> [*const f32; 3] {
        rows_of(self.array.data().cast_const(), self.n)
    }

    /// Returns the rows; a column of one row gives that row and two empty ones.
    pub(crate) fn slices(&self) -> [&[f32]; 3] {
        let Ok(all) = self.array.as_slice() else {
            unreachable!("contiguous and aligned")
        };
        let row = |row: usize| {
            all.get(row * self.n..(row + 1) * self.n)
                .unwrap_or_default()
        };
        [row(0), row(1), row(2)]
    }
}

/// Column of `out` in exceptions.
struct Item(&'static str);

impl Display for Item {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "out[\"{}\"]", self.0)
    }
}

/// Columns that a call writes.
pub(crate) struct Outputs<'py, const N: usize> {
    /// Columns by name, for the caller.
    pub(crate) dict: Bound<'py, PyDict>,
    /// Borrows that are held so that nothing else reads or writes the columns.
    _borrowed: [Option<PyReadwriteArrayDyn<'py, f32>>; N],
    /// Rows of each column, null if the column is left out.
    pub(crate) rows: [[*mut f32; 3]; N],
}

impl<'py, const N: usize> Outputs<'py, N> {
    /// Makes new columns of every name, or borrows the columns of `out`. They have as many numbers per row as the inputs, of which there
    /// is at least one, and share no memory with them.
    pub(crate) fn new(
        py: Python<'py>,
        out: Option<&Bound<'py, PyAny>>,
        names: &Columns<N>,
        inputs: &[&Input<'py>],
    ) -> PyResult<Self> {
        let n = inputs[0].n;
        let (columns, keys) = (&names.columns, names.keys(py));
        let dict = match out {
            None => PyDict::new(py),
            Some(out) => {
                let dict = out
                    .cast::<PyDict>()
                    .map_err(|_| wrong(&"out", "a dict", out))?;
                dict.clone()
            }
        };
        if out.is_none() {
            for ((_, rows), key) in columns.iter().zip(keys) {
                if *rows == 3 {
                    dict.set_item(key, PyArray2::<f32>::zeros(py, [3, n], false))?;
                } else {
                    dict.set_item(key, PyArray1::<f32>::zeros(py, n, false))?;
                }
            }
        }
        let mut given = [const { None }; N];
        for (given, key) in given.iter_mut().zip(keys) {
            *given = dict.get_item(key)?;
        }
        // Strings of all keys would take a sixth of a call on one direction.
        if given.iter().flatten().count() < dict.len() {
            for key in dict.keys() {
                if !keys.iter().any(|known| key.eq(known).unwrap_or(false)) {
                    let names = columns.map(|(name, _)| name).join(", ");
                    let got = match key.cast::<PyString>() {
                        Ok(key) => format!("{:?}", key.to_string_lossy()),
                        Err(_) => key.repr()?.to_string(),
                    };
                    return Err(PyValueError::new_err(format!(
                        "out must have some of {names}, got {got}"
                    )));
                }
            }
        }
        let (mut borrowed, mut all) = ([const { None }; N], [[ptr::null_mut(); 3]; N]);
        let names = columns.map(|(name, _)| Item(name));
        let taken = inputs.iter();
        let taken = taken.map(|input| (&input.name as &dyn Display, addresses(&input.array)));
        let mut taken: Vec<_> = taken.collect();
        for (i, name) in names.iter().enumerate() {
            let Some(any) = &given[i] else { continue };
            let array = cast(name, columns[i].1, Some(n), any)?;
            let here = addresses(array);
            let overlaps = |(_, other): &&(&dyn Display, Range<usize>)| {
                here.start < other.end && other.start < here.end
            };
            if let Some((other, _)) = taken.iter().find(overlaps) {
                return Err(PyValueError::new_err(format!(
                    "{name} must share no memory with {other}"
                )));
            }
            let array = array.try_readwrite().map_err(|error| match error {
                BorrowError::NotWriteable => {
                    PyValueError::new_err(format!("{name} must be writeable"))
                }
                _ => in_use(name),
            })?;
            taken.push((name, here));
            all[i] = rows_of(array.data().cast_const(), n).map(<*const f32>::cast_mut);
            borrowed[i] = Some(array);
        }
        Ok(Self {
            dict,
            _borrowed: borrowed,
            rows: all,
        })
    }
}

/// Call that may run while other threads run Python.
pub(crate) struct Detached<F>(pub(crate) F);

// SAFETY: the call's pointers are of arrays that are borrowed, and of frozen objects that are kept, until it returns.
unsafe impl<F> Send for Detached<F> {}

impl<F: FnOnce() -> i32> Detached<F> {
    /// Runs the call without the interpreter's lock. The arguments have been checked before.
    pub(crate) fn run(self, py: Python<'_>) -> PyResult<()> {
        let call = self;
        let status = py.detach(move || {
            let Self(call) = { call };
            call()
        });
        match status {
            0 => Ok(()),
            _ => Err(PyValueError::new_err("the arguments were refused")),
        }
    }
}
