"""Tests of the modules for Dr.Jit, JAX and PyTorch against the wheel's calls on NumPy. Frameworks that are not installed are skipped.

Accuracy of the functions that frameworks compile, and their derivatives, are tested by .ci/frameworks.py on their printed source.
"""

from __future__ import annotations

import doctest
import importlib
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import hairis
import numpy as np
import pytest
from conftest import directions
from numpy.typing import NDArray

ENTRIES = [(name, {} if word is None else {model["choice"]: word}) for name, model in hairis.models().items() for word in model["choices"] or [None]]
SMALL = "kajiya-kay"
Array = NDArray[np.float32]


class Torch:
    """Framework of a test, whose arrays are made of NumPy's."""

    name = "torch"

    def __init__(self) -> None:
        self.torch: Any = pytest.importorskip("torch")
        self.module: Any = importlib.import_module("hairis.torch")

    def array(self, x: Any) -> Any:
        return self.torch.tensor(np.asarray(x, np.float32))

    def read(self, x: Any) -> Any:
        return x.detach().numpy()

    def jit(self, function: Any) -> Any:
        return self.torch.compile(function, backend="aot_eager")

    def grad(self, function: Any) -> Any:
        return self.torch.func.grad(function)

    def vmap(self, function: Any, places: Any) -> Any:
        return self.torch.func.vmap(function, places)


class Jax(Torch):
    name = "jax"

    def __init__(self) -> None:
        self.jax: Any = pytest.importorskip("jax")
        self.module = importlib.import_module("hairis.jax")

    def array(self, x: Any) -> Any:
        return self.jax.numpy.asarray(x, self.jax.numpy.float32)

    def read(self, x: Any) -> Any:
        return np.asarray(x)

    def jit(self, function: Any) -> Any:
        return self.jax.jit(function)

    def grad(self, function: Any) -> Any:
        return self.jax.grad(function)

    def vmap(self, function: Any, places: Any) -> Any:
        return self.jax.vmap(function, places)


@pytest.fixture(params=[Torch, Jax], ids=["torch", "jax"])
def host(request: pytest.FixtureRequest) -> Torch:
    found: Torch = request.param()
    return found


@pytest.fixture
def drjit() -> Any:
    pytest.importorskip("drjit")
    module: Any = importlib.import_module("hairis.drjit")
    return module


def llvm() -> Any:
    return importlib.import_module("drjit.llvm.ad")


def hits(n: int) -> tuple[Array, Array, Array, Array]:
    """Returns wo and wi as rows, offsets, and uniform numbers as rows."""
    rng = np.random.default_rng(7)
    h = rng.uniform(-0.9, 0.9, n).astype(np.float32)
    return directions(n, 1).T, directions(n, 2).T, h, rng.random((n, 3), np.float32)


def numbers(hair: hairis.Material) -> dict[str, Any]:
    return {name: value for name, value in hair.fields.items() if not isinstance(value, str)}


def columns(rows: Array) -> Array:
    return np.ascontiguousarray(rows.T)


@pytest.mark.parametrize("name", ["drjit", "jax", "torch"])
def test_one_framework_imports_no_other(name: str) -> None:
    pytest.importorskip(name)
    code = f"import sys, hairis; assert not {{'drjit', 'jax', 'torch'}} & set(sys.modules); import hairis.{name}; print(*sys.modules)"
    modules = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert {"drjit", "jax", "torch"} & set(modules) == {name}


@pytest.mark.parametrize("name", ["drjit", "jax", "torch"])
def test_examples_of_docstrings(name: str) -> None:
    pytest.importorskip(name)
    module = importlib.import_module(f"hairis.{name}")
    results = doctest.testmod(module, extraglobs={"hairis": hairis, "np": np})
    assert results.attempted > 2 and results.failed == 0


@pytest.mark.parametrize(("model", "choice"), ENTRIES)
def test_kernels_serve_arrays_of_the_cpu(host: Torch, model: str, choice: dict[str, Any]) -> None:
    """Values, samples and derivatives have the bits of the wheel's calls, also if a compiled function makes the material."""
    wo, wi, h, xi = hits(64)
    plain = hairis.Material(model, "brown", energy="raw", **choice)
    arrays = {name: host.array(value) for name, value in numbers(plain).items()}
    wo_, wi_, h_, xi_ = map(host.array, (wo, wi, h, xi))

    def hair(fields: Any) -> Any:
        return host.module.material(model, "brown", **choice, **fields)

    value, pdf = plain.eval_pdf(wo, wi, h)
    drawn = plain.sample(wo, xi, h)
    for fields in ({}, arrays):
        for got, want in zip(host.jit(lambda wo, f: hair(f).eval_pdf(wo, wi_, h_))(wo_, fields), (value, pdf)):
            assert (host.read(got) == want).all()
        (got, _), samples = hair(fields).eval_sample(wo_, wi_, xi_, h_)
        assert (host.read(got) == value).all()
        for name, want in drawn.items():
            assert (host.read(samples[name]) == want).all(), name
    d_value = np.random.default_rng(3).uniform(-1, 1, (64, 3)).astype(np.float32)
    d_hits, d_fields = plain.eval_grad(columns(wo), columns(wi), columns(d_value), h)

    def loss(inputs: Any) -> Any:
        return (hair(inputs["fields"]).eval(inputs["wo"], inputs["wi"], inputs["h"]) * host.array(d_value)).sum()

    found = host.grad(loss)({"fields": arrays, "wo": wo_, "wi": wi_, "h": h_})
    for name in arrays:
        assert (host.read(found["fields"][name]) == np.asarray(d_fields[name], np.float32)).all(), name
    for name in ("wo", "wi", "h"):
        want = d_hits[f"d_{name}"].T
        # Threads of XLA flush subnormal numbers to 0, on which the tiniest derivatives depend.
        assert ((host.read(found[name]) == want) | (abs(want) < 1e-25)).all(), name


def test_fields_in_place_of_others(host: Torch) -> None:
    wo, wi, h, _ = hits(64)
    plain = hairis.Material("chiang", energy="raw", color=(0.2, 0.5, 0.9))
    _, d_fields = plain.eval_grad(columns(wo), columns(wi), np.ones((3, 64), np.float32), h)
    found = host.grad(lambda color: host.module.material("chiang", color=color).eval(wo, wi, h).sum())(host.array((0.2, 0.5, 0.9)))
    assert (host.read(found) == np.asarray(d_fields["color"], np.float32)).all()


def test_a_field_with_an_entry_per_hit(host: Torch) -> None:
    """The functions over arrays serve hits with a material each, and agree with the kernels."""
    wo, wi, h, xi = hits(40)
    plain = hairis.Material(SMALL, "brown", energy="raw")
    shape = (4, 10)
    wide = {name: np.broadcast_to(np.asarray(value, np.float32), (*shape, *np.shape(value))) for name, value in numbers(plain).items()}
    arrays = {name: host.array(x) for name, x in wide.items()}

    def hair(fields: Any) -> Any:
        return host.module.material(SMALL, **fields)

    wo_, wi_, xi_ = (host.array(x.reshape(*shape, 3)) for x in (wo, wi, xi))
    value, pdf = (host.read(x) for x in host.jit(lambda f: hair(f).eval_pdf(wo_, wi_))(arrays))
    want, want_pdf = plain.eval_pdf(wo.reshape(*shape, 3), wi.reshape(*shape, 3))
    np.testing.assert_allclose(value, want, rtol=2e-5)
    np.testing.assert_allclose(pdf, want_pdf, rtol=2e-5)
    drawn, want_drawn = hair(arrays).sample(wo_, xi_), plain.sample(wo.reshape(*shape, 3), xi.reshape(*shape, 3))
    for name, x in want_drawn.items():
        np.testing.assert_allclose(host.read(drawn[name]), x, rtol=1e-4, atol=1e-5)
    _, d_fields = plain.eval_grad(columns(wo), columns(wi), np.ones((3, 40), np.float32))
    found = host.grad(lambda f: hair(f).eval(wo_, wi_).sum())(arrays)
    for name, d_field in d_fields.items():
        np.testing.assert_allclose(host.read(found[name]).sum((0, 1)), d_field, rtol=1e-4)


def test_derivatives_of_densities_and_samples(host: Torch) -> None:
    """They come from the functions over arrays, and agree with differences."""
    wo, wi, _, xi = hits(200)
    exponent = float(hairis.Material(SMALL).fields["exponent"])  # type: ignore[arg-type]

    def material(exponent: Any) -> Any:
        return host.module.material(SMALL, exponent=exponent)

    def both(exponent: Any) -> Any:
        value, pdf = material(exponent).eval_pdf(wo, wi)
        return value.sum() + pdf.sum()

    def weight(exponent: Any) -> Any:
        return material(exponent).sample(wo, xi)["weight"].sum()

    step = 0.05 * exponent
    for loss in (both, weight):
        ends = [float(loss(host.array(exponent + sign * step))) for sign in (-1, 1)]
        found = float(host.grad(loss)(host.array(exponent)))
        assert abs(found) > 1e-3 and found == pytest.approx((ends[1] - ends[0]) / (2 * step), rel=0.02), loss.__name__


def test_vmap(host: Torch) -> None:
    """A batch of hits is one call, and a batch of materials one per material; both compose with derivatives and compilation."""
    wo, wi, h, xi = hits(30)
    wo_, wi_, h_, xi_ = map(host.array, (wo, wi, h, xi))
    hair = hairis.Material("gaussian", "brown", energy="raw")
    widths = np.outer([1, 1.2, 0.7], numbers(hair)["beta"]).astype(np.float32)

    def value(beta: Any, wo: Any, wi: Any, h: Any) -> Any:
        return host.module.material("gaussian", "brown", beta=beta).eval(wo, wi, h)

    def loss(*inputs: Any) -> Any:
        return value(*inputs).sum()

    def each(beta: Array) -> hairis.Material:
        return hairis.Material("gaussian", "brown", energy="raw", beta=beta)

    want = np.stack([each(beta).eval(wo, wi, h) for beta in widths])
    by_material = host.vmap(value, (0, None, None, None))
    assert (host.read(by_material(host.array(widths), wo_, wi_, h_)) == want).all()
    by_hit = host.vmap(value, (None, 0, 0, 0))
    np.testing.assert_allclose(host.read(by_hit(host.array(widths[1]), wo_, wi_, h_)), want[1], rtol=1e-6)
    both = host.vmap(by_hit, (0, None, None, None))
    np.testing.assert_allclose(host.read(both(host.array(widths), wo_, wi_, h_)), want, rtol=1e-6)
    one = np.ones((3, 30), np.float32)
    d_beta = np.asarray([each(beta).eval_grad(columns(wo), columns(wi), one, h)[1]["beta"] for beta in widths])
    found = host.vmap(host.grad(loss), (0, None, None, None))(host.array(widths), wo_, wi_, h_)
    np.testing.assert_allclose(host.read(found), d_beta, rtol=1e-6)
    found = host.jit(host.vmap(host.grad(loss), (None, 0, 0, 0)))(host.array(widths[0]), wo_, wi_, h_)
    np.testing.assert_allclose(host.read(found).sum(0), d_beta[0], rtol=1e-4)
    drawn = host.vmap(lambda wo, xi: host.module.material(hair).sample(wo, xi)["weight"], (0, 0))(wo_, xi_)
    np.testing.assert_allclose(host.read(drawn), hair.sample(wo, xi)["weight"], rtol=1e-6)


def test_columns_are_not_copied() -> None:
    """Directions whose components lie apart in memory go to the kernels as they are, and results come back likewise."""
    module = importlib.import_module("hairis._columns")
    wo, wi, h, _ = hits(8)
    assert np.shares_memory(module.column(directions(8, 1).T), module.column(directions(8, 1).T)) is False
    rows = directions(8, 1)
    assert np.shares_memory(module.column(rows.T), rows)
    value, _ = module.evaluate(hairis.Material(energy="raw").to_json(), {}, wo, wi, h)
    assert np.shares_memory(module.column(value), value)


def test_other_devices_of_jax_run_the_functions() -> None:
    host = Jax()
    wo, wi, *_ = hits(4)
    traced = host.jax.jit(lambda kd: host.module.material(SMALL, kd=kd).eval(wo, wi)).trace(host.array((1, 1, 1)))
    assert "callback" in traced.lower().as_text()
    assert "callback" not in traced.lower(lowering_platforms=("cuda",)).as_text()


def test_other_devices_of_torch_run_the_functions() -> None:
    host = Torch()
    wo, wi, *_ = hits(4)
    value = host.module.material(SMALL).eval(host.array(wo).to("meta"), host.array(wi).to("meta"))
    assert value.shape == (4, 3) and value.device.type == "meta"


@pytest.mark.parametrize(("model", "choice"), ENTRIES)
def test_drjit_has_the_values_of_the_wheel(drjit: Any, model: str, choice: dict[str, Any]) -> None:
    wo, wi, h, xi = hits(500)
    hair = hairis.Material(model, "brown", energy="raw", **choice)
    wo_, wi_, xi_ = (llvm().Array3f(columns(x)) for x in (wo, wi, xi))
    h_ = llvm().Float(h)
    of_numbers = drjit.material(hair)
    of_arrays = drjit.material(hair, **{n: llvm().Array3f(x) if isinstance(x, tuple) else llvm().Float(x) for n, x in numbers(hair).items()})
    value, pdf = hair.eval_pdf(wo, wi, h)
    drawn = hair.sample(wo, xi, h)
    for arrays in (of_numbers, of_arrays):
        (got, got_pdf), samples = arrays.eval_sample(wo_, wi_, xi_, h_)
        np.testing.assert_allclose(np.array(got).T, value, rtol=2e-5, atol=1e-9)
        np.testing.assert_allclose(np.array(got_pdf), pdf, rtol=2e-5, atol=1e-9)
        # The last bits of a number next to a choice may choose the other branch.
        same = np.array(samples["lobe"]) == drawn["lobe"]
        assert same.mean() > 0.99
        for name, want in drawn.items():
            off = abs(np.array(samples[name]).T - want)[same] / (abs(want[same]) + 1)
            assert np.quantile(off, 0.99) < 1e-4, name


def test_drjit_differentiates(drjit: Any) -> None:
    dr: Any = importlib.import_module("drjit")
    wo, wi, h, _ = hits(500)
    plain = hairis.Material("chiang", "brown", energy="raw")
    arrays = {name: llvm().Array3f(x) if isinstance(x, tuple) else llvm().Float(x) for name, x in numbers(plain).items()}
    dr.enable_grad(arrays)
    value = drjit.material("chiang", "brown", **arrays).eval(llvm().Array3f(columns(wo)), llvm().Array3f(columns(wi)), llvm().Float(h))
    dr.backward(dr.sum(dr.sum(value)))
    _, d_fields = plain.eval_grad(columns(wo), columns(wi), np.ones((3, 500), np.float32), h)
    for name, want in d_fields.items():
        np.testing.assert_allclose(np.array(dr.grad(arrays[name])).ravel(), np.atleast_1d(want), rtol=1e-4, err_msg=name)


def test_scalar_arrays_of_drjit_are_numbers(drjit: Any) -> None:
    scalar: Any = importlib.import_module("drjit.scalar")
    hair = hairis.Material("chiang", "brown", energy="raw")
    value = drjit.material(hair).eval(scalar.Array3f(0.6, 0.0, 0.8), (0.0, 0.6, 0.8), 0.3)
    assert isinstance(value, scalar.Array3f) and list(value) == hair.eval((0.6, 0, 0.8), (0, 0.6, 0.8), 0.3).tolist()


def refusals(module: Any, array: Callable[[Any], Any]) -> list[tuple[type[Exception], str, Callable[[], object]]]:
    make, wo, wi = module.material, array(hits(10)[0]), array(hits(10)[1])
    vectors, got = "must be numbers of shape (..., 3), got", str(array([1]).dtype)
    refused = 'energy must be "raw" for arrays, got "conserving", whose factor has no derivatives: give energy="raw"'
    return [
        (ValueError, refused, lambda: make(hairis.Material())),
        (ValueError, refused, lambda: make("gaussian", energy="conserving")),
        (TypeError, "preset must be left out with a material, got 'brown'", lambda: make(hairis.Material(energy="raw"), "brown")),
        (ValueError, "field must be one of kd, ks, exponent, form, got \"beta\"", lambda: make(SMALL, beta=array((1, 1, 1)))),
        (TypeError, f"form must be a word, got {type(array([1]))}", lambda: make(SMALL, form=array([1]))),
        (TypeError, f"kd {vectors} {got} of shape (2,)", lambda: make(SMALL, kd=array((1, 1))).eval(wo, wi)),
        (TypeError, f"wi {vectors} {got} of shape (3, 10)", lambda: make().eval(wo, wi.T)),
        (TypeError, f"wi {vectors} <class 'str'>", lambda: make().pdf(wo, "abc")),
        (TypeError, f"xi {vectors} <class 'NoneType'>", lambda: make().sample(wo, None)),
        (ValueError, "wi must broadcast with the arguments before it, of shape (10,), got (9,)", lambda: make().eval(wo, wi[:9])),
        (ValueError, "h must broadcast with the arguments before it, of shape (10,), got (4,)", lambda: make().eval(wo, wi, array(np.zeros(4)))),
        (
            ValueError,
            "color must be numbers for calls that the framework compiles, got an array; give sigma_a",
            lambda: make("chiang", color=array(np.full((10, 3), 0.5))).eval(wo, wi),
        ),
    ]


@pytest.mark.parametrize("place", range(12))
def test_refusals(host: Torch, place: int) -> None:
    kind, text, call = refusals(host.module, host.array)[place]
    with pytest.raises(kind) as refusal:
        call()
    assert str(refusal.value) == text


def test_values_out_of_range_are_refused_on_the_cpu(host: Torch) -> None:
    wo, wi, *_ = hits(4)
    with pytest.raises(Exception, match=r"beta\[1\] must be a width in \[1e-4, pi\] rad, got 0"):
        host.read(host.module.material(beta=host.array((0.1, 0, 0.1))).eval(wo, wi))


@pytest.mark.parametrize("name", ["jax", "torch"])
def test_examples_recover_the_widths_that_they_hide(name: str) -> None:
    pytest.importorskip(name)
    example = Path(__file__).parent.parent / "examples" / f"{name}_hair.py"
    assert len(example.read_text().splitlines()) <= 30
    line = subprocess.run([sys.executable, example], capture_output=True, text=True, check=True).stdout
    widths, hidden = (np.array(part.replace(",", " ").split(), float) for part in re.findall(r"\[([^]]*)\]", line))
    np.testing.assert_allclose(widths, hidden, rtol=1e-3)
