"""Calls of the library on arrays of NumPy whose fields may be arrays: values, samples and derivatives for frameworks on the CPU."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import Material
from ._arrays import NAMES, described

Array = NDArray[np.float32]
Fields = dict[str, Array]


@lru_cache(64)
def _values(text: str) -> tuple[str, dict[str, Any]]:
    """Returns the model of a material from JSON, and the values of its fields with the word of its choice."""
    material = Material.from_json(text, energy="raw")
    choice = {} if material.choice is None else {described(material.model)["choice"]: material.choice}
    return material.model, {**material.fields, **choice}


def _material(text: str, fields: Fields) -> Material:
    """Makes the material of a text with these fields; raises an exception that names the one that is out of its range."""
    model, values = _values(text)
    return Material(model, energy="raw", **{**values, **fields})


def column(a: Array) -> Array:
    """Returns components as rows, without a copy if they lie in memory like that."""
    return np.require(np.moveaxis(a, -1, 0).reshape(3, -1), np.float32, ["C", "A"])


def _row(a: Array) -> Array:
    return np.require(a.reshape(-1), np.float32, ["C", "A"])


def _shaped(column: Array, shape: tuple[int, ...]) -> Array:
    """Returns a column in the shape of the hits, as a view."""
    return np.moveaxis(column.reshape(3, *shape), 0, -1) if column.ndim == 2 else column.reshape(shape)


def evaluate(text: str, fields: Fields, wo: Array, wi: Array, h: Array) -> tuple[Array, Array]:
    """Returns values and densities of hits of one shape."""
    e = _material(text, fields).eval_hits(column(wo), column(wi), _row(h))
    return _shaped(e["value"], h.shape), _shaped(e["pdf"], h.shape)


def sample(text: str, fields: Fields, wo: Array, xi: Array, h: Array) -> list[Array]:
    """Returns wi, value, pdf, weight and lobe of hits of one shape."""
    s = _material(text, fields).sample_hits(column(wo), column(xi), _row(h))
    return [_shaped(s[name], h.shape) for name in NAMES]


def derivatives(text: str, fields: Fields, wo: Array, wi: Array, h: Array, d_value: Array) -> list[Array]:
    """Returns the derivatives of a loss of values by wo, wi, h and each field, in this order."""
    material = _material(text, fields)
    d_hits, d_fields = material.eval_grad(column(wo), column(wi), column(d_value), _row(h))
    by_field = [np.asarray(d_fields[name], np.float32) for name in fields]
    return [_shaped(d_hits[name], h.shape) for name in ("d_wo", "d_wi", "d_h")] + by_field
