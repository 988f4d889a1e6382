"""Hair over arrays of JAX, which compiles and differentiates it.

>>> import jax
>>> def loss(width):
...     hair = hairis.jax.material("gaussian", "brown", beta=width)
...     return hair.eval((0.6, 0.0, 0.8), jax.numpy.array([[0.0, 0.6, 0.8], [0.6, 0.8, 0.0]])).sum()
>>> jax.jit(jax.grad(loss))(jax.numpy.array([0.1, 0.1, 0.2])).shape
(3,)

Directions have shape (..., 3), fields of three numbers (3,) or (..., 3), and all shapes broadcast. On the CPU, calls run the kernels of the
library with its derivatives; on other devices, and where a field has an entry per hit, XLA compiles the model as functions over arrays. These
functions also serve derivatives of densities and of samples. Materials with fields that are out of range raise an exception where the
kernels run.
"""

from __future__ import annotations

import importlib
from functools import partial
from typing import Any

import numpy as np

from . import Material, _columns
from ._arrays import NAMES, Array, Hair, Model, Pair, Samples
from ._shapes import common

__all__ = ["material"]

jax: Any = importlib.import_module("jax")
custom_derivatives: Any = importlib.import_module("jax.custom_derivatives")
jnp = jax.numpy


def array(name: str, value: Any, size: int) -> Any:
    """Returns an argument in single precision; with `size` components in its last dimension, unless that is 0."""
    must = f"{name} must be numbers of shape {f'(..., {size})' if size else '(...)'}, got"
    try:
        found = jnp.asarray(value)
    except (TypeError, ValueError):
        raise TypeError(f"{must} {type(value)}") from None
    if found.dtype.kind not in "fiu" and found.dtype != jnp.bfloat16 or (size and found.shape[-1:] != (size,)):
        raise TypeError(f"{must} {found.dtype} of shape {found.shape}")
    return found.astype(jnp.float32)


def constants(model: Model, fields: Any) -> Any:
    named = model.named(fields)
    return model.constants({name: jnp.moveaxis(x, -1, 0) if model.sizes[name] else x for name, x in named.items()}, jnp)


def compiled_eval(model: Model, wo: Any, wi: Any, h: Any, *fields: Any) -> tuple[Any, ...]:
    """Returns values and densities, by functions that XLA compiles."""
    wo, wi = jnp.moveaxis(wo, -1, 0), jnp.moveaxis(wi, -1, 0)
    e = model.program.eval_hit(constants(model, fields), wo, h, wi, jnp)
    return jnp.stack(e.value, -1), e.pdf


def compiled_sample(model: Model, wo: Any, xi: Any, h: Any, *fields: Any) -> tuple[Any, ...]:
    """Returns samples, by functions that XLA compiles."""
    wo, xi = jnp.moveaxis(wo, -1, 0), jnp.moveaxis(xi, -1, 0)
    s = model.program.sample_hit(constants(model, fields), wo, h, xi, jnp)
    return jnp.stack(s.wi, -1), jnp.stack(s.value, -1), s.pdf, jnp.stack(s.weight, -1), s.slot


def host(call: Any, model: Model, shapes: Any, *arrays: Any) -> Any:
    """Calls the library on the host: under vmap, once for all entries of a batch with one material, and otherwise once per entry.

    The arrays are of hits, and then fields. Each dimension of a batch comes first, and has length 1 in arrays without that batch.
    """

    def now(*arrays: Any) -> Any:
        whole = [np.asarray(x) for x in arrays]
        leading = [x.shape[: x.ndim - rank] for x, rank in zip(whole, ranks)]
        batch = np.broadcast_shapes(*leading)
        hits, fields = whole[:count], whole[count:]
        if call is not _columns.derivatives and all(np.prod(lead, dtype=int) == 1 for lead in leading[count:]):
            one = [x.reshape(x.shape[len(lead) :]) for x, lead in zip(fields, leading[count:])]
            own = [np.broadcast_to(x, batch + x.shape[len(lead) :]) for x, lead in zip(hits, leading)]
            return call(model.text, model.named(one), *own)
        entries = [np.broadcast_to(x, batch + x.shape[len(lead) :]) for x, lead in zip(whole, leading)]
        results: Any = [np.empty(batch + result.shape, np.float32) for result in shapes]
        for place in np.ndindex(*batch):
            parts = [x[place] for x in entries]
            for result, part in zip(results, call(model.text, model.named(parts[count:]), *parts[:count])):
                result[place] = part
        return results

    count = len(arrays) - len(model.sizes)
    ranks = [x.ndim for x in arrays]
    return jax.pure_callback(now, shapes, *arrays, vmap_method="expand_dims")


def by_platform(model: Model, kernel: Any, compiled: Any, *arrays: Any) -> Any:
    """Calls the library on the CPU, and the compiled function on other platforms unless the model needs the library."""
    return kernel(*arrays) if model.needs_library else jax.lax.platform_dependent(*arrays, cpu=kernel, default=compiled)


def shape(*dimensions: int) -> Any:
    return jax.ShapeDtypeStruct(dimensions, jnp.float32)


@partial(jax.custom_vjp, nondiff_argnums=(0,))
def evaluated(model: Model, *arrays: Any) -> Any:
    """Returns values and densities at wo, wi, h and fields, by the kernels on the CPU."""

    def kernel(*arrays: Any) -> Any:
        hits = arrays[2].shape
        return tuple(host(_columns.evaluate, model, (shape(*hits, 3), shape(*hits)), *arrays))

    return by_platform(model, kernel, partial(compiled_eval, model), *arrays)


def evaluated_forward(model: Model, *arrays: Any) -> Any:
    primals = tuple(x.value for x in arrays)
    return evaluated(model, *primals), primals


def evaluated_backward(model: Model, arrays: Any, cotangents: Any) -> Any:
    d_value, d_pdf = cotangents

    def is_zero(d: Any) -> bool:
        return isinstance(d, custom_derivatives.SymbolicZero)

    def compiled(place: int, d: Any, *arrays: Any) -> Any:
        return jax.vjp(lambda *arrays: compiled_eval(model, *arrays)[place], *arrays)[1](d)

    def kernel(d: Any, *arrays: Any) -> Any:
        shapes = tuple(shape(*x.shape) for x in arrays)
        return tuple(host(_columns.derivatives, model, shapes, *arrays[:3], d, *arrays[3:]))

    found = tuple(map(jnp.zeros_like, arrays))
    if not is_zero(d_value):
        found = by_platform(model, kernel, partial(compiled, 0), d_value, *arrays)
    if not is_zero(d_pdf):
        found = tuple(map(jnp.add, found, compiled(1, d_pdf, *arrays)))
    return found


evaluated.defvjp(evaluated_forward, evaluated_backward, symbolic_zeros=True)


@partial(jax.custom_vjp, nondiff_argnums=(0,))
def sampled(model: Model, *arrays: Any) -> Any:
    """Returns samples at wo, xi, h and fields, by the kernels on the CPU."""

    def kernel(*arrays: Any) -> Any:
        hits = arrays[2].shape
        shapes = [shape(*hits, 3) if name in ("wi", "value", "weight") else shape(*hits) for name in NAMES]
        return tuple(host(_columns.sample, model, tuple(shapes), *arrays))

    return by_platform(model, kernel, partial(compiled_sample, model), *arrays)


# Samples that are differentiated are those of the functions that XLA compiles, whose derivatives the library lacks.
sampled.defvjp(
    lambda model, *arrays: jax.vjp(partial(compiled_sample, model), *arrays),
    lambda model, pull, cotangents: pull(cotangents),
)

# Calls outside of other functions are compiled once per shape, too.
evaluate, sample = (jax.jit(function, static_argnums=0) for function in (evaluated, sampled))


class JaxHair(Hair):
    """Hair over arrays of JAX, which `material` makes."""

    def _is_array(self, value: Any) -> bool:
        return isinstance(value, jax.Array)

    def _arrays(self, h: Any, **vectors: Any) -> list[Any]:
        """Returns arrays of hits, in the shape that they broadcast to, and fields."""
        hits = {name: array(name, value, 3) for name, value in vectors.items()}
        hits["h"] = array("h", h, 0)
        whole = common({name: x.shape if name == "h" else x.shape[:-1] for name, x in hits.items()})
        all_hits = [jnp.broadcast_to(x, whole if name == "h" else (*whole, 3)) for name, x in hits.items()]
        return all_hits + [array(name, self._given[name], size) for name, size in self._model.sizes.items()]

    def _has_one_material(self, arrays: Any) -> bool:
        return [int(size > 0) for size in self._model.sizes.values()] == [x.ndim for x in arrays[3:]]

    def eval_pdf(self, wo: Array, wi: Array, h: Array = 0.0) -> Pair:
        arrays = self._arrays(h, wo=wo, wi=wi)
        call = evaluate if self._has_one_material(arrays) else compiled_eval
        value, pdf = call(self._model, *arrays)
        return value, pdf

    def sample(self, wo: Array, xi: Array, h: Array = 0.0) -> Samples:
        arrays = self._arrays(h, wo=wo, xi=xi)
        call = sample if self._has_one_material(arrays) else compiled_sample
        return dict(zip(NAMES, call(self._model, *arrays)))


def material(model: str | Material = "gaussian", preset: str | None = None, **fields: Any) -> JaxHair:
    """Makes hair of a model and a preset, or of a material with energy "raw", with fields in their place: numbers, words or arrays of JAX. A
    field of three numbers is an array of shape (3,), or (..., 3) with an entry per hit, which broadcasts with the hits."""
    return JaxHair(model, preset, fields)

