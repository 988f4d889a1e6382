"""Tests of the wheel: its results, and the reconstruction of objects."""

from __future__ import annotations

import copy
import doctest
import json
import pickle
import subprocess
import sys
import threading
from typing import Any, cast

import hairis
import hairis.plot
import numpy as np
import pytest
from conftest import bits, directions
from numpy.typing import NDArray

ALL = [
    (name, preset, {} if model["choice"] is None else {model["choice"]: word})
    for name, model in hairis.models().items()
    for preset in model["presets"]
    for word in (model["choices"] or [None])
]


@pytest.mark.parametrize(("model", "preset", "choice"), ALL)
@pytest.mark.parametrize("energy", ["raw", "conserving", "scaled"])
def test_objects_make_themselves(model: str, preset: str, choice: dict[str, Any], energy: Any) -> None:
    hair = hairis.Material(model, preset, energy=energy, **choice)
    for same in (
        eval(repr(hair)),
        pickle.loads(pickle.dumps(hair)),
        copy.deepcopy(hair),
        hairis.Material.from_json(hair.to_json(), energy=energy),
        hairis.Material(model, None, energy=energy, **choice, **cast(dict[str, Any], hair.fields)),
    ):
        assert same == hair and hash(same) == hash(hair) and repr(same) == repr(hair)
    assert json.loads(hair.to_json())["params"].keys() == hair.fields.keys()
    wi = directions(40, 1)
    bsdf = hair.prepare((0.6, 0.0, 0.8), h=0.25)
    kept = bsdf.with_lobes(hair.lobe_names[:1])
    for one in (bsdf, kept):
        for same_bsdf in (eval(repr(one)), pickle.loads(pickle.dumps(one))):
            assert repr(same_bsdf) == repr(one)
            for name, column in one.eval_columns(wi).items():
                assert (bits(column) == bits(same_bsdf.eval_columns(wi)[name])).all()


def test_materials_differ() -> None:
    hair = hairis.Material("gaussian", "brown")
    assert hair != hairis.Material("gaussian", "red")
    assert hair != hairis.Material("gaussian", "brown", energy="raw")
    assert hair != hairis.Material("gaussian", "brown", sampler="matched")
    assert hair != "brown"


def test_replaced_fields_leave_no_trace() -> None:
    """Materials with equal fields are equal, whatever the values of fields that others took the place of."""
    color = (0.5, 0.4, 0.3)
    hair = hairis.Material("chiang", "brown", color=color)
    assert pickle.loads(pickle.dumps(hair)) == hair == hairis.Material.from_json(hair.to_json())


ODD = [float("nan"), float("inf"), -float("inf"), -0.0, 1e-45, -3.4028235e38, 1e16, 1 / 3]


@pytest.mark.parametrize("odd", ODD)
@pytest.mark.parametrize("place", range(4))
def test_odd_numbers_as_text(odd: float, place: int) -> None:
    """The text of an object is an expression that makes the same object, whatever its numbers are."""
    *wo, h = (odd if i == place else 0.5 for i in range(4))
    hair = hairis.Material("chiang", "brown")
    for bsdf in (hair.prepare(wo, h), hair.prepare(wo, h).with_lobes(["r"]), hair.prepare(wo, h).with_lobes([])):
        for same in (eval(repr(bsdf), {"hairis": hairis}), pickle.loads(pickle.dumps(bsdf)), copy.deepcopy(bsdf)):
            assert repr(same) == repr(bsdf)
            wi = directions(20, 1)
            for name, column in bsdf.eval_columns(wi).items():
                assert (bits(column) == bits(same.eval_columns(wi)[name])).all()


def test_zeros_of_both_signs_are_equal() -> None:
    """Materials with equal fields are equal and have one hash."""
    found = 0
    for model, info in hairis.models().items():
        for name, value in hairis.Material(model).fields.items():
            if isinstance(value, str) or not info["fields"][name]["range"][0] <= 0:
                continue
            zeros = [0.0, -0.0] if isinstance(value, float) else [(0.0,) * len(value), (-0.0,) * len(value)]
            a, b = (hairis.Material(model, **cast(dict[str, Any], {name: zero})) for zero in zeros)
            assert a.fields == b.fields and a == b and not a != b and hash(a) == hash(b) and len({a, b}) == 1
            for one in (a, b):
                for same in (eval(repr(one)), pickle.loads(pickle.dumps(one)), hairis.Material.from_json(one.to_json())):
                    assert same == one and hash(same) == hash(one) and repr(same) == repr(one)
            found += 1
    assert found > 15


@pytest.mark.parametrize(("model", "preset", "choice"), ALL)
def test_columns_agree(model: str, preset: str, choice: dict[str, Any], xi: NDArray[np.float32]) -> None:
    """Samples have the densities and values of evaluations, and the furnace agrees with the albedo."""
    hair = hairis.Material(model, preset, energy="raw", **choice)
    bsdf = hair.prepare((0.6, 0.8, 0.0), h=0.1)
    samples = bsdf.sample_columns(xi)
    live = samples["lobe"] >= 0
    again = bsdf.eval_columns(samples["wi"])
    np.testing.assert_allclose(samples["pdf"][live], again["pdf"][live], rtol=2e-3)
    cos = np.hypot(samples["wi"][1], samples["wi"][2])
    weight = samples["value"][:, live] * cos[live] / samples["pdf"][live]
    np.testing.assert_allclose(samples["weight"][:, live], weight, rtol=1e-3, atol=1e-6)
    assert (samples["lobe"] < len(hair.lobe_names)).all()
    albedo = np.sum(list(bsdf.albedo().values()), axis=0)
    error = samples["weight"].std(axis=1) / np.sqrt(xi.shape[1])
    assert (abs(samples["weight"].mean(axis=1) - albedo) < 5 * error + 1e-4).all()
    value = sum(np.array(v) * np.array(c) for v, c, _ in bsdf.lobes((0.0, 0.6, 0.8)).values())
    one = bsdf.eval_columns(np.array([[0.0], [0.6], [0.8]], np.float32))["value"][:, 0]
    np.testing.assert_allclose(value, one, rtol=1e-4, atol=1e-7)


def test_hits_are_bsdfs() -> None:
    wo, wi = directions(200, 5), directions(200, 6)
    h = np.random.default_rng(7).uniform(-1, 1, 200).astype(np.float32)
    for energy in ("raw", "conserving", "scaled"):
        hair = hairis.Material("chiang", "blond", energy=energy)
        hits = hair.eval_hits(wo, wi, h)
        for i in range(0, 200, 17):
            one = hair.prepare(wo[:, i], float(h[i])).eval_columns(np.ascontiguousarray(wi[:, i : i + 1]))
            np.testing.assert_allclose(hits["value"][:, i], one["value"][:, 0], rtol=1e-3, atol=1e-6)
        assert not (bits(hits["pdf"]) == bits(hair.eval_hits(wo, wi)["pdf"])).all()


SHAPES: list[tuple[int, ...]] = [(), (7,), (1,), (0,), (2, 3), (3, 3), (2, 0, 4)]


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("model", "preset", "choice"), ALL[:: len(hairis.models()["gaussian"]["presets"])])
def test_any_shape_is_columns(model: str, preset: str, choice: dict[str, Any], shape: tuple[int, ...]) -> None:
    """Arrays of any shape have the bits of columns at their places, whatever their type and layout are."""
    hair = hairis.Material(model, preset, **choice)
    bsdf = hair.prepare((0.6, 0.0, 0.8), h=0.25)
    n = int(np.prod(shape))
    wi, wo, h = directions(n, 1), directions(n, 2), np.linspace(-1, 1, n, dtype=np.float32)
    xi = np.random.default_rng(3).random((3, n), np.float32)

    def shaped(column: NDArray[np.float32]) -> NDArray[np.float32]:
        return column.T.reshape(*shape, 3) if column.ndim == 2 else column.reshape(shape)

    def same(got: NDArray[Any], column: NDArray[np.float32]) -> None:
        assert got.dtype == np.float32 and got.flags.c_contiguous
        assert got.shape == shape + column.shape[:-1] and (bits(got) == bits(shaped(column))).all()

    for of, columns, sampled, hit in (
        (bsdf, bsdf.eval_columns(wi), bsdf.sample_columns(xi), ()),
        (hair, hair.eval_hits(wo, wi, h), hair.sample_hits(wo, xi, h), (shaped(wo), shaped(h))),
    ):
        call: Any = of
        before, after = hit[:1], hit[1:]
        for argument in (shaped(wi), np.asfortranarray(shaped(wi)), shaped(wi).astype(float), shaped(wi).astype(">f4"), shaped(wi).tolist()):
            if n > 0 or isinstance(argument, np.ndarray):
                same(call.eval(*before, argument, *after), columns["value"])
        same(call.pdf(*before, shaped(wi), *after), columns["pdf"])
        for got, name in zip(call.eval_pdf(*before, shaped(wi), *after), ("value", "pdf")):
            same(got, columns[name])
        samples = call.sample(*before, shaped(xi), *after)
        assert samples.keys() == sampled.keys()
        for name, column in sampled.items():
            same(samples[name], column)


def test_shapes_broadcast() -> None:
    hair = hairis.Material("chiang", "blond")
    wo, wi, h = directions(4, 1).T.reshape(4, 1, 3), directions(5, 2).T, np.linspace(-0.9, 0.9, 6, dtype=np.float32).reshape(6, 1, 1)
    whole = [np.ascontiguousarray(np.broadcast_to(a, (6, 4, 5, 3)).reshape(-1, 3).T) for a in (wo, wi)]
    offsets = np.ascontiguousarray(np.broadcast_to(h, (6, 4, 5)).reshape(-1))
    columns = hair.eval_hits(whole[0], whole[1], offsets)
    value, pdf = hair.eval_pdf(wo, wi, h)
    assert (bits(value) == bits(np.ascontiguousarray(columns["value"].T)).reshape(6, 4, 5, 3)).all()
    assert (bits(pdf) == bits(columns["pdf"]).reshape(6, 4, 5)).all()
    assert hair.sample((0, 1, 0), np.full((2, 3), 0.5), 0.3)["wi"].shape == (2, 3)


def test_energy() -> None:
    bright = {energy: hairis.Material("gaussian", "bright", energy=energy) for energy in ("raw", "conserving", "scaled")}
    albedo = {name: sum(lobe[0] for lobe in one.prepare((0.99, 0.14, 0)).albedo().values()) for name, one in bright.items()}
    assert albedo["raw"] > 1.5 and 0.99 < albedo["conserving"] < 1.001 and albedo["scaled"] < 1.001
    assert bright["raw"].max_albedo > 1.5 and bright["scaled"].max_albedo < 1.01


def test_out() -> None:
    hair = hairis.Material("gaussian", "brown", sampler="matched")
    wo, wi, n = directions(77, 1), directions(77, 2), 77
    whole = hair.eval_hits(wo, wi)
    out = {"pdf": np.full(n, -1, np.float32)}
    assert hair.eval_hits(wo, wi, out=out) is out
    assert (bits(out["pdf"]) == bits(whole["pdf"])).all() and list(out) == ["pdf"]
    xi = np.random.default_rng(1).random((3, n), np.float32)
    all_columns, some = hair.sample_hits(wo, xi), {"weight": np.zeros((3, n), np.float32), "lobe": np.zeros(n, np.float32)}
    hair.sample_hits(wo, xi, out=some)
    assert all((bits(some[name]) == bits(all_columns[name])).all() for name in some)
    # A view of a larger block is written in place, and nothing beside it.
    block = np.full((5, 3, n), 7, np.float32)
    hair.eval_hits(wo, wi, out={"value": block[2]})
    assert (bits(block[2]) == bits(whole["value"])).all() and (block[[0, 1, 3, 4]] == 7).all()
    for empty in (hair.eval_hits(wo[:, :0].copy(), wi[:, :0].copy()), hair.prepare((0, 1, 0)).eval_columns(wi[:, :0].copy())):
        assert empty["value"].shape == (3, 0)


@pytest.mark.parametrize("model", ["d-eon", "gaussian"])
def test_colour_of_a_fibre(model: str) -> None:
    color = (0.5, 0.3, 0.1)
    hair = hairis.Material(model, "brown", color=color, color_of="fibre")
    lobes = hair.prepare((0, 1, 0)).albedo().values()
    assert np.sum(list(lobes), axis=0) == pytest.approx(color, abs=1e-3)
    assert hairis.Material.from_json(hair.to_json()) == hair
    assert hair != hairis.Material(model, "brown", color=color, color_of="mass")


def test_json_of_requests() -> None:
    hair = hairis.Material("chiang", "brown")
    request = {**json.loads(hair.to_json()), "wo": [0, 1, 0], "wi": [0, 0, 1], "h": 0.5}
    assert hairis.Material.from_json(json.dumps(request)) == hair


@pytest.mark.parametrize(
    ("like", "fields"),
    [
        ("cycles", {"roughness": 0.2, "coat": 0.5, "melanin": 0.4, "random": 0.7, "random_color": 0.5}),
        ("materialx", {"tint_TT": [0.9, 0.8, 0.7], "cuticle_angle": 0.45, "color": [0.5, 0.3, 0.2]}),
        ("osl", {"lroughness": 0.25, "troughness": 0.3, "aroughness": 0.4, "absorption": [0.1, 0.2, 0.3], "R_tint": [0.5, 0.6, 0.7]}),
        ("pbrt", {"beta_n": 0.4, "sigma_a": [0.1, 0.2, 0.4]}),
        ("mitsuba", {"eumelanin": 1.3}),
        (
            "rtxcr",
            {
                "longitudinalRoughness": 0.3, "azimuthalRoughness": 0.4, "ior": 1.5, "cuticleAngleInDegrees": 2, "melanin": 0.5,
                "absorptionModel": "physics", "azimuthalRoughnessTT": 0.3,
            },
        ),
    ],
)
def test_other_renderers_names(like: str, fields: dict[str, Any]) -> None:
    hair = hairis.Material("chiang", like=like, **fields)
    request = {"model": "chiang", "like": like, "params": fields}
    assert hair == hairis.Material.from_json(json.dumps(request)) == eval(repr(hair))
    assert hair != hairis.Material("chiang", like="pbrt", beta_m=0.9)


def test_threads() -> None:
    """Threads may share a material and its inputs."""
    hair, wo, wi = hairis.Material("cauchy", "brown"), directions(5000, 1), directions(5000, 2)
    want = hair.eval_hits(wo, wi)
    results: list[dict[str, Any]] = []
    threads = [threading.Thread(target=lambda: results.append(hair.eval_hits(wo, wi))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 4
    assert all((bits(one[name]) == bits(want[name])).all() for one in results for name in want)


def test_models() -> None:
    for name, model in hairis.models().items():
        assert hairis.Material(name).near_field == model["near_field"]
        assert hairis.Material(name).lobe_names == model["lobes"]
        for field, info in model["fields"].items():
            assert info["doc"].endswith(".") and (info["kind"] == "word") == (info["range"] is None)
            if info["kind"] == "word":
                assert [hairis.Material(name, **{field: word}).fields[field] for word in info["labels"]] == info["labels"]


def test_plots() -> None:
    import matplotlib

    matplotlib.use("agg")
    bsdf = hairis.Material("gaussian", "brown", sampler="matched").prepare((0.5, 0.75**0.5, 0.0))
    curves = {line.get_label(): line.get_ydata() for line in hairis.plot.polar(bsdf).get_lines()}
    assert set(curves) == {"R", "TT", "TRT", "glint", "sum"}
    parts = sum(np.asarray(curves[name]) for name in ("R", "TT", "TRT", "glint"))
    np.testing.assert_allclose(parts, np.asarray(curves["sum"]), rtol=1e-3, atol=1e-5)
    image = hairis.plot.sphere(bsdf, resolution=32).get_images()[0].get_array()
    assert image is not None and image.shape == (32, 64) and np.isfinite(image).all()


@pytest.mark.parametrize("module", [hairis, hairis.plot])
def test_examples_of_docstrings(module: Any) -> None:
    results = doctest.testmod(module, extraglobs={"hairis": hairis, "np": np})
    assert results.attempted > 2 and results.failed == 0


def test_every_call_has_an_example() -> None:
    for kind in (hairis.Material, hairis.Bsdf):
        for name in vars(kind):
            if callable(getattr(kind, name)) and not name.startswith("_"):
                assert ">>>" in getattr(kind, name).__doc__, name


def test_the_module_as_a_program_names_the_models() -> None:
    run = subprocess.run([sys.executable, "-m", "hairis"], capture_output=True, text=True, check=True)
    first, *rest = run.stdout.splitlines()
    assert first.startswith("hairis 0.1.0, eight lanes on ")
    assert [line.split(":")[0].strip() for line in rest] == list(hairis.models())


def test_plots_take_a_model_by_its_name() -> None:
    import matplotlib

    matplotlib.use("agg")
    for of in ("chiang", hairis.Material("kajiya-kay", "brown")):
        assert len(hairis.plot.polar(of, count=64).get_lines()) > 1
        assert len(hairis.plot.sphere(of, resolution=8).get_images()) == 1
