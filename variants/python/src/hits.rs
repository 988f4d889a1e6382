//! Columns of hits, and calls of the C interface on them.

use crate::arrays::{Detached, Input};
use hairis_capi::layout::{Hits, RawMaterial};
use pyo3::prelude::*;

/// Columns of hits that a call reads: `wo`, directions or uniform numbers, and `h`.
pub(crate) type Columns<'py> = (Input<'py>, Input<'py>, Option<Input<'py>>);

/// Returns all columns of hits.
pub(crate) fn all<'a, 'py>((wo, third, h): &'a Columns<'py>) -> Vec<&'a Input<'py>> {
    [wo, third].into_iter().chain(h).collect()
}

/// Function of the C interface on hits, which writes columns `T`.
pub(crate) type Call<T> = unsafe extern "C" fn(
    *const RawMaterial,
    usize,
    usize,
    *const Hits,
    *const [*const f32; 3],
    *const T,
) -> i32;

/// Calls the C interface on hits. The caller must hold a borrow of the arrays of `to`.
pub(crate) fn call<T>(
    material: &RawMaterial,
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
    let (raw, n, rows) = (core::ptr::from_ref(material), wo.n, third.rows());
    // SAFETY: the arrays have n numbers in each row, and are borrowed.
    Detached(move || unsafe { call(raw, 1, n, &raw const hits, &raw const rows, to) }).run(py)
}

/// Reads the columns of hits: `wo`, `h` and the third, all of one length.
pub(crate) fn inputs<'py>(
    wo: &Bound<'py, PyAny>,
    third: (&'static str, &Bound<'py, PyAny>),
    h: Option<&Bound<'py, PyAny>>,
) -> PyResult<Columns<'py>> {
    let wo = Input::new("wo", wo, 3, None)?;
    let n = Some(wo.n);
    let third = Input::new(third.0, third.1, 3, n)?;
    Ok((wo, third, h.map(|h| Input::new("h", h, 1, n)).transpose()?))
}
