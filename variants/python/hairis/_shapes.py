"""Calls on columns for arrays of any shape: the last dimension of a vector is the component, and shapes broadcast."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float32]
ROWS = {"wi": 3, "value": 3, "weight": 3, "pdf": 1, "lobe": 1}


def _read(name: str, value: Any, shape: str) -> Array:
    """Returns an argument in single precision, or raises an exception that names it."""
    must = f"{name} must be numbers of shape {shape}, got"
    try:
        array = np.asarray(value)
    except (TypeError, ValueError, OverflowError):
        # NumPy makes no array of nested sequences that differ in length.
        raise TypeError(f"{must} {type(value)}") from None
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{must} {f'{array.dtype} of shape {array.shape}' if isinstance(value, np.ndarray) else type(value)}")
    if shape == "(..., 3)" and array.shape[-1:] != (3,):
        raise TypeError(f"{must} {array.dtype} of shape {array.shape}")
    with np.errstate(over="ignore"):
        single = array.astype(np.float32, copy=False)
    if array.dtype != np.float32 and (large := np.isinf(single) & np.isfinite(array)).any():
        raise ValueError(f"{name} must be at most 3.4028235e38 in magnitude, got {array[large][0]:e}")
    return single


def common(shapes: dict[str, tuple[int, ...]]) -> tuple[int, ...]:
    """Returns the shape that all arguments broadcast to, or raises an exception that names the first that does not fit those before it."""
    whole: tuple[int, ...] = ()
    for name, shape in shapes.items():
        try:
            whole = np.broadcast_shapes(whole, shape)
        except ValueError:
            raise ValueError(f"{name} must broadcast with the arguments before it, of shape {whole}, got {shape}") from None
    return whole


def call(function: Callable[..., dict[str, Array]], results: tuple[str, ...], vectors: dict[str, Any], h: Any = None) -> dict[str, Array]:
    """Calls a function on columns, and returns these results in the shape that the arguments broadcast to."""
    arrays = {name: _read(name, value, "(..., 3)") for name, value in vectors.items()}
    if h is not None:
        arrays["h"] = _read("h", h, "(...)")
    shape = common({name: array.shape if name == "h" else array.shape[:-1] for name, array in arrays.items()})
    columns: dict[str, Array] = {}
    for name, array in arrays.items():
        if name == "h":
            columns[name] = np.ascontiguousarray(np.broadcast_to(array, shape).reshape(-1))
        else:
            rows = np.moveaxis(np.broadcast_to(array, (*shape, 3)), -1, 0)
            columns[name] = np.require(rows.reshape(3, -1), requirements=["C", "A"])
    n = columns[next(iter(vectors))].shape[1]
    out = {name: np.empty((3, n) if ROWS[name] == 3 else n, np.float32) for name in results}
    function(**columns, out=out)
    for name, column in out.items():
        is_vector = ROWS[name] == 3
        out[name] = np.ascontiguousarray(np.moveaxis(column.reshape(3, *shape), 0, -1)) if is_vector else column.reshape(shape)
    return out
