"""Hair over arrays of Dr.Jit, which compiles the models for CPU and GPU and differentiates them.

>>> import drjit.llvm.ad as llvm
>>> hair = hairis.drjit.material("gaussian", "brown", gamma_tt=llvm.Float(0.1))
>>> value = hair.eval(llvm.Array3f(0.6, 0, 0.8), llvm.Array3f(0, 0.6, [0.8, -0.8]))
>>> value.shape
(3, 2)

Vectors are arrays whose first index is the component, such as `Array3f`, of any backend; results are `Array3f` and `Float`. Without an
array of a compiled backend, a call computes numbers by `hairis.Material`.
"""

from __future__ import annotations

import importlib
import sys
from typing import Any

from . import Material
from ._arrays import Array, Hair, Pair, Samples

__all__ = ["material"]

dr: Any = importlib.import_module("drjit")


def leaf(value: Any) -> Any:
    """Returns the type of the numbers of an array of a compiled backend, or None for numbers and scalar arrays."""
    if isinstance(value, list | tuple):
        return next((kind for kind in map(leaf, value) if kind), None)
    return dr.float32_array_t(dr.leaf_t(value)) if dr.is_jit_v(value) else None


class DrJitHair(Hair):
    """Hair over arrays of Dr.Jit, which `material` makes."""

    def _is_array(self, value: Any) -> bool:
        return leaf(value) is not None

    def _kind(self, **arguments: Array) -> Any:
        return leaf([*arguments.values(), *self._given.values()])

    def _vector(self, kind: Any, numbers: Any) -> Array:
        module = sys.modules[kind.__module__] if kind else importlib.import_module("drjit.scalar")
        return module.Array3f(*numbers)

    def eval_pdf(self, wo: Array, wi: Array, h: Array = 0.0) -> Pair:
        kind = self._kind(wo=wo, wi=wi, h=h)
        if kind is None:
            value, pdf = self._material.eval_pdf(list(wo), list(wi), h)
            return self._vector(kind, value.tolist()), float(pdf)
        result = self._model.program.eval_hit(self._model.constants(self._given, dr), wo, h, wi, dr)
        return self._vector(kind, result.value), result.pdf

    def sample(self, wo: Array, xi: Array, h: Array = 0.0) -> Samples:
        kind = self._kind(wo=wo, xi=xi, h=h)
        if kind is None:
            drawn = self._material.sample(list(wo), list(xi), h)
            return {name: self._vector(kind, x.tolist()) if x.ndim else float(x) for name, x in drawn.items()}
        s = self._model.program.sample_hit(self._model.constants(self._given, dr), wo, h, xi, dr)
        vectors = {name: self._vector(kind, getattr(s, name)) for name in ("wi", "value", "weight")}
        return {"wi": vectors["wi"], "value": vectors["value"], "pdf": s.pdf, "weight": vectors["weight"], "lobe": s.slot}


def material(model: str | Material = "gaussian", preset: str | None = None, **fields: Any) -> DrJitHair:
    """Makes hair of a model and a preset, or of a material with energy "raw", with fields in their place: numbers, words, or arrays of
    Dr.Jit. A field of several numbers is an array whose first index is the component. Arrays are not checked against their ranges."""
    return DrJitHair(model, preset, fields)
