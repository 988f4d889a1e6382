"""Hair over tensors of PyTorch, which autograd differentiates.

>>> import torch
>>> width = torch.tensor([0.1, 0.1, 0.2], requires_grad=True)
>>> hair = hairis.torch.material("gaussian", "brown", beta=width)
>>> value = hair.eval((0.6, 0.0, 0.8), torch.tensor([[0.0, 0.6, 0.8], [0.6, 0.8, 0.0]]))
>>> value.sum().backward()
>>> value.shape, width.grad.shape
(torch.Size([2, 3]), torch.Size([3]))

Directions have shape (..., 3), fields of three numbers (3,) or (..., 3), and all shapes broadcast. On the CPU, calls run the kernels of the
library with its derivatives; on other devices, and where a field has an entry per hit, PyTorch runs the model as functions over tensors.
These functions also serve derivatives of densities and of samples. Materials with fields that are out of range raise an exception
where the kernels run.
"""

from __future__ import annotations

import importlib
from typing import Any

from . import Material, _columns
from ._arrays import NAMES, Array, Hair, Model, Pair, Samples
from ._shapes import common

__all__ = ["material"]

torch: Any = importlib.import_module("torch")


def tensor(name: str, value: Any, size: int, device: Any) -> Any:
    """Returns an argument in single precision; with `size` components in its last dimension, unless that is 0."""
    must = f"{name} must be numbers of shape {f'(..., {size})' if size else '(...)'}, got"
    try:
        found = torch.as_tensor(value, device=device)
    except (TypeError, ValueError, RuntimeError):
        raise TypeError(f"{must} {type(value)}") from None
    if found.is_complex() or found.dtype == torch.bool or (size and found.shape[-1:] != (size,)):
        raise TypeError(f"{must} {found.dtype} of shape {tuple(found.shape)}")
    return found.to(torch.float32)


@torch.compiler.disable  # type: ignore[untyped-decorator]
def library(call: Any, model: Model, hits: int, tensors: Any) -> Any:
    """Calls the library with tensors of the CPU, of which the first are of hits and the others fields."""
    arrays = [x.detach().numpy() for x in tensors]
    return tuple(map(torch.from_numpy, call(model.text, model.named(arrays[hits:]), *arrays[:hits])))


def constants(model: Model, fields: Any) -> Any:
    named = model.named(fields)
    return model.constants({name: x.unbind(-1) if model.sizes[name] else x for name, x in named.items()}, torch)


def evaluated(model: Model, wo: Any, wi: Any, h: Any, *fields: Any) -> Pair:
    """Returns values and densities, by functions over tensors."""
    e = model.program.eval_hit(constants(model, fields), wo.unbind(-1), h, wi.unbind(-1), torch)
    return torch.stack(e.value, -1), e.pdf


def sampled(model: Model, wo: Any, xi: Any, h: Any, *fields: Any) -> tuple[Any, ...]:
    """Returns samples, by functions over tensors."""
    s = model.program.sample_hit(constants(model, fields), wo.unbind(-1), h, xi.unbind(-1), torch)
    return torch.stack(s.wi, -1), torch.stack(s.value, -1), s.pdf, torch.stack(s.weight, -1), s.slot


def batched(function: Any, info: Any, dims: Any, model: Model, tensors: Any, hits: int, is_one: bool) -> Any:
    """Calls a function under vmap: once, with the batch as a further dimension of all hits, if they have one material, and otherwise once
    per entry of the batch. The first tensors are of hits, and the others fields."""
    moved = [x if dim is None else x.movedim(dim, 0) for x, dim in zip(tensors, dims)]
    if is_one:
        whole = [x.expand(info.batch_size, *x.shape) if dim is None else x for x, dim in zip(moved[:hits], dims)]
        results = function(model, *whole, *moved[hits:])
    else:
        entries = ([x if dim is None else x[i] for x, dim in zip(moved, dims)] for i in range(info.batch_size))
        results = tuple(torch.stack(parts) for parts in zip(*(function(model, *entry) for entry in entries)))
    return results, (0,) * len(results)


class Kernel(torch.autograd.Function):  # type: ignore[misc]
    """Call of the library on tensors of the CPU: of a model, then tensors of hits in one shape, then fields."""

    HITS = 3

    @staticmethod
    def setup_context(ctx: Any, inputs: Any, output: Any) -> None:
        ctx.model, *tensors = inputs
        ctx.save_for_backward(*tensors)
        ctx.set_materialize_grads(False)

    @classmethod
    def is_one(cls, dims: Any) -> bool:
        return all(dim is None for dim in dims[cls.HITS :])

    @classmethod
    def vmap(cls, info: Any, dims: Any, model: Model, *tensors: Any) -> Any:
        return batched(cls.apply, info, dims[1:], model, tensors, cls.HITS, cls.is_one(dims[1:]))


class Eval(Kernel):
    """Values and densities at wo, wi and h."""

    @staticmethod
    def forward(model: Model, *tensors: Any) -> Any:
        return library(_columns.evaluate, model, Eval.HITS, tensors)

    @staticmethod
    def backward(ctx: Any, d_value: Any, d_pdf: Any) -> Any:
        model, tensors = ctx.model, ctx.saved_tensors
        found: Any = [None] * len(tensors)
        if d_value is not None:
            found = Derivatives.apply(model, *tensors[:3], d_value, *tensors[3:])
        if d_pdf is not None:
            _, pull = torch.func.vjp(lambda *tensors: evaluated(model, *tensors)[1], *tensors)
            found = [b if a is None else a + b for a, b in zip(found, pull(d_pdf))]
        return None, *found


class Derivatives(Kernel):
    """Derivatives of a loss of values by wo, wi, h and fields, at wo, wi, h and the derivatives of the loss by values."""

    HITS = 4

    @staticmethod
    def forward(model: Model, *tensors: Any) -> Any:
        return library(_columns.derivatives, model, Derivatives.HITS, tensors)

    @staticmethod
    def backward(ctx: Any, *_: Any) -> Any:
        raise NotImplementedError("derivatives on the CPU must be of first order, got a derivative of a derivative")

    @classmethod
    def is_one(cls, dims: Any) -> bool:
        # Derivatives by fields are sums over hits.
        return len(dims) == cls.HITS


class Sample(Kernel):
    """Samples at wo, xi and h."""

    @staticmethod
    def forward(model: Model, *tensors: Any) -> Any:
        return library(_columns.sample, model, Sample.HITS, tensors)


@torch.compiler.disable  # type: ignore[untyped-decorator]
def run(kernel: Any, model: Model, tensors: Any) -> Any:
    """Calls the library, between the parts that torch.compile compiles."""
    return kernel.apply(model, *tensors)


class TorchHair(Hair):
    """Hair over tensors of PyTorch, which `material` makes."""

    def _is_array(self, value: Any) -> bool:
        return isinstance(value, torch.Tensor)

    def _tensors(self, h: Any, **vectors: Any) -> list[Any]:
        """Returns tensors of hits, in the shape that they broadcast to, and fields."""
        devices = (x.device for x in [*vectors.values(), h, *self._given.values()] if isinstance(x, torch.Tensor))
        device = next(devices, None)
        hits = {name: tensor(name, value, 3, device) for name, value in vectors.items()}
        hits["h"] = tensor("h", h, 0, device)
        shape = common({name: tuple(x.shape if name == "h" else x.shape[:-1]) for name, x in hits.items()})
        whole = [x.expand(shape if name == "h" else (*shape, 3)) for name, x in hits.items()]
        return whole + [tensor(name, self._given[name], size, device) for name, size in self._model.sizes.items()]

    def _is_for_kernels(self, tensors: Any) -> bool:
        """Returns true for tensors of the CPU and one material."""
        ranks = [int(size > 0) for size in self._model.sizes.values()]
        return tensors[0].device.type == "cpu" and ranks == [x.ndim for x in tensors[3:]]

    def eval_pdf(self, wo: Array, wi: Array, h: Array = 0.0) -> Pair:
        tensors = self._tensors(h, wo=wo, wi=wi)
        if self._is_for_kernels(tensors):
            value, pdf = run(Eval, self._model, tensors)
            return value, pdf
        return evaluated(self._model, *tensors)

    def sample(self, wo: Array, xi: Array, h: Array = 0.0) -> Samples:
        tensors = self._tensors(h, wo=wo, xi=xi)
        is_differentiated = torch.is_grad_enabled() and any(x.requires_grad for x in tensors)
        if self._is_for_kernels(tensors) and not is_differentiated:
            return dict(zip(NAMES, run(Sample, self._model, tensors)))
        return dict(zip(NAMES, sampled(self._model, *tensors)))


@torch.compiler.disable  # type: ignore[untyped-decorator]
def material(model: str | Material = "gaussian", preset: str | None = None, **fields: Any) -> TorchHair:
    """Makes hair of a model and a preset, or of a material with energy "raw", with fields in their place: numbers, words or tensors. A
    field of three numbers is a tensor of shape (3,), or (..., 3) with an entry per hit, which broadcasts with the hits."""
    return TorchHair(model, preset, fields)
