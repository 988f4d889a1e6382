"""Tests of the arguments that the wheel rejects: every refusal is listed with its sentence, which names the argument and the cause."""

from __future__ import annotations

import threading
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import hairis
import numpy as np
import pytest
from conftest import directions, unaligned

Call = Callable[[], object]


def refusals() -> list[tuple[type[Exception], str, Call]]:
    """Returns every refusal but those of JSON and of other threads: the exception, its text and a call."""
    make: Any = hairis.Material
    hair: Any = make()
    bsdf: Any = hair.prepare((0, 1, 0))
    raw: Any = make(energy="raw")
    good, f32 = directions(10, 1), np.float32
    frozen = np.zeros((3, 10), f32)
    frozen.flags.writeable = False
    block = np.zeros((4, 10), f32)
    room = bytearray(120)
    twice = [np.frombuffer(room, f32).reshape(3, 10) for _ in range(2)]
    lobes, energies = "lobes must be some of r, tt, trt, glint", "energy must be one of raw, conserving, scaled"
    samplers = ", ".join(hairis.models()["cauchy"]["choices"])
    models = "model must be one of " + ", ".join(hairis.models())
    pbrt = "beta_m, beta_n, alpha, eta, sigma_a, eumelanin, reflectance, pheomelanin"
    fields = "alpha, beta, gamma_tt, gamma_g, phi_g, i_r, i_tt, i_trt, i_g"

    def column(name: str, shape: str, got: str) -> str:
        return f"{name} must be float32 of shape {shape}, C-contiguous and aligned; got {got}"

    vectors, before = "{} must be numbers of shape (..., 3), got", "must broadcast with the arguments before it, of shape"
    value = "beta[1] must be a width in [1e-4, pi] rad, got 0"
    most = "must be at most 3.4028235e38 in magnitude, got"
    return [
        # Names.
        (ValueError, f'{models}, got "hair"', lambda: make("hair")),
        (ValueError, f'{models}, got "two\\nlines"', lambda: make("two\nlines")),
        (ValueError, f'{models}, got "\ufffd\ufffd\ufffd"', lambda: make("\ud800")),
        (ValueError, 'model must have no NUL, got "gaus\\0sian"', lambda: make("gaus\0sian")),
        (TypeError, "model must be a word, got <class 'NoneType'>", lambda: make(None)),
        (ValueError, 'preset must be one of default, blond, brown, red, black, white, got "green"', lambda: make("chiang", "green")),
        (ValueError, 'preset must have no NUL, got "\\0"', lambda: make("chiang", "\0")),
        (TypeError, "preset must be a word, got <class 'int'>", lambda: make("chiang", 1)),
        (ValueError, 'like must be one of cycles, materialx, osl, pbrt, mitsuba, rtxcr, got "blender"', lambda: make("chiang", like="blender")),
        (ValueError, 'model must be "chiang" where like is given, got "gaussian"', lambda: make(like="cycles")),
        (ValueError, 'preset must be None where like is given, got "blond"', lambda: make("chiang", "blond", like="cycles")),
        (TypeError, "like must be a word, got <class 'int'>", lambda: make("chiang", like=1)),
        (ValueError, "color must be given where color_of is, got None", lambda: make("chiang", color_of="mass")),
        (ValueError, 'color_of must be one of chiang, fibre, mass, got "head"', lambda: make("chiang", color=(1, 1, 1), color_of="head")),
        (ValueError, 'color_of must be a sense that gaussian has, got "chiang"', lambda: make(color=(1, 1, 1), color_of="chiang")),
        (ValueError, "melanin and color exclude each other; give one", lambda: make("d-eon", melanin=(1, 0), color=(1, 1, 1), color_of="mass")),
        (ValueError, "color[1] must be finite and at least 0, got -1", lambda: make(color=(1, -1, 1), color_of="mass")),
        (TypeError, "color_of must be a word, got <class 'int'>", lambda: make(color=(1, 1, 1), color_of=1)),
        (ValueError, f'field must be one of {pbrt}, got "beta"', lambda: make("chiang", like="pbrt", beta=1)),
        (ValueError, "melanin and color exclude each other; give one", lambda: make("chiang", like="cycles", melanin=1, color=(1, 1, 1))),
        (ValueError, "roughness must be in [0.001, 1], got 2", lambda: make("chiang", like="cycles", roughness=2)),
        (ValueError, f'{energies}, got "most"', lambda: make(energy="most")),
        (TypeError, "energy must be a word, got <class 'NoneType'>", lambda: make(energy=None)),
        (TypeError, "energy must be a word, got <class 'int'>", lambda: make.from_json(hair.to_json(), energy=0)),
        (ValueError, f'sampler must be one of {samplers}, got "best"', lambda: make("cauchy", sampler="best")),
        (TypeError, "sampler must be a word, got <class 'float'>", lambda: make(sampler=1.0)),
        (ValueError, f'field must be one of sampler, {fields}, got "eta"', lambda: make(eta=1.5)),
        (ValueError, 'shifts must be one of d-eon, small-angle, got "none"', lambda: make("chiang", shifts="none")),
        (ValueError, 'shifts must have no NUL, got "d\\0"', lambda: make("chiang", shifts="d\0")),
        (TypeError, "shifts must be a word, got <class 'float'>", lambda: make("chiang", shifts=1.0)),
        (ValueError, "sigma_a and color exclude each other; give one", lambda: make("chiang", sigma_a=(1, 1, 1), color=(1, 1, 1))),
        # Numbers.
        (ValueError, value, lambda: make(beta=(0.1, 0, 0.2))),
        (ValueError, "gamma_tt must be a width in [1e-4, pi] rad, got NaN", lambda: make(gamma_tt=float("nan"))),
        (ValueError, "i_r[2] must be finite and at least 0, got -inf", lambda: make(i_r=(1, 1, -np.inf))),
        (ValueError, f"beta[0] {most} a larger integer", lambda: make(beta=(10**400, 1, 1))),
        (ValueError, f"beta[0] {most} 1e39", lambda: make(beta=(1e39, 1, 1))),
        (ValueError, f"gamma_tt {most} -1.5e300", lambda: make(gamma_tt=-1.5e300)),
        (TypeError, "gamma_tt must be a number, got <class 'str'>", lambda: make(gamma_tt="wide")),
        (TypeError, "gamma_tt must be a number, got float64 of shape (2,)", lambda: make(gamma_tt=np.ones(2))),
        (TypeError, "gamma_tt must be a number, got <class 'complex'>", lambda: make(gamma_tt=1j)),
        (ValueError, "beta must be 3 numbers, got 2", lambda: make(beta=(0.1, 0.2))),
        (ValueError, "beta must be 3 numbers, got 0", lambda: make(beta=[])),
        (TypeError, "beta must be 3 numbers, got <class 'float'>", lambda: make(beta=0.1)),
        (TypeError, "beta must be 3 numbers, got <class 'str'>", lambda: make(beta="abc")),
        (TypeError, "beta must be 3 numbers, got <class 'set'>", lambda: make(beta={1, 2, 3})),
        (TypeError, "beta must be 3 numbers, got <class 'bytes'>", lambda: make(beta=b"abc")),
        (TypeError, "beta must be 3 numbers, got float64 of shape ()", lambda: make(beta=np.array(0.1))),
        (TypeError, "beta[1] must be a number, got <class 'NoneType'>", lambda: make(beta=(0.1, None, 0.1))),
        (TypeError, "beta[0] must be a number, got float64 of shape (1,)", lambda: make(beta=np.ones((3, 1)))),
        (ValueError, "wo must be 3 numbers, got 2", lambda: hair.prepare((0, 1))),
        (TypeError, "wo must be 3 numbers, got <class 'str'>", lambda: hair.prepare("abc")),
        (TypeError, "wo[2] must be a number, got <class 'str'>", lambda: hair.prepare((0, 1, "x"))),
        (TypeError, "wo[0] must be a number, got float32 of shape (10,)", lambda: hair.prepare(good)),
        (ValueError, f"wo[1] {most} a larger integer", lambda: hair.prepare((0, -(10**400), 0))),
        (TypeError, "h must be a number, got <class 'str'>", lambda: hair.prepare((0, 0, 1), h="x")),
        (TypeError, "h must be a number, got <class 'NoneType'>", lambda: hair.prepare((0, 0, 1), None)),
        (ValueError, f"h {most} a larger integer", lambda: hair.prepare((0, 0, 1), 10**400)),
        (ValueError, "wi must be 3 numbers, got 4", lambda: bsdf.lobes((0, 0, 0, 1))),
        # Lobes.
        (ValueError, f'{lobes}, got "X"', lambda: bsdf.with_lobes(["X"])),
        (TypeError, "lobes must be a list of names, got <class 'str'>", lambda: bsdf.with_lobes("tt")),
        (TypeError, "lobes must be a list of names, got <class 'NoneType'>", lambda: bsdf.with_lobes(None)),
        (TypeError, "lobes[1] must be a word, got <class 'int'>", lambda: bsdf.with_lobes(["tt", 1])),
        # Columns.
        (TypeError, column("wi", "(3, N)", "float64 of shape (3, 10)"), lambda: bsdf.eval_columns(good.astype(float))),
        (TypeError, column("wi", "(3, N)", ">f4 of shape (3, 10)"), lambda: bsdf.eval_columns(good.astype(">f4"))),
        (TypeError, column("wi", "(3, N)", "float32 of shape (10, 3)"), lambda: bsdf.eval_columns(good.T.copy())),
        (TypeError, column("wi", "(3, N)", "float32 of shape (3,)"), lambda: bsdf.eval_columns(np.zeros(3, f32))),
        (TypeError, column("wi", "(3, N)", "float32 of shape (3, 10), not C-contiguous"), lambda: bsdf.eval_columns(np.asfortranarray(good))),
        (TypeError, column("wi", "(3, N)", "float32 of shape (3, 10), not aligned"), lambda: bsdf.eval_columns(unaligned(10))),
        (TypeError, column("wi", "(3, N)", "float32 of shape (3, 0), not aligned"), lambda: bsdf.eval_columns(unaligned(10)[:, :0].reshape(3, 0))),
        (TypeError, column("wi", "(3, N)", "<class 'list'>"), lambda: bsdf.eval_columns([[0], [1], [0]])),
        (TypeError, column("xi", "(3, N)", "<class 'NoneType'>"), lambda: bsdf.sample_columns(None)),
        (TypeError, column("xi", "(3, 10)", "float32 of shape (3, 9)"), lambda: hair.sample_hits(good, good[:, :9].copy())),
        (TypeError, column("h", "(10,)", "float32 of shape (9,)"), lambda: hair.eval_hits(good, good, np.zeros(9, f32))),
        (TypeError, column("h", "(10,)", "<class 'float'>"), lambda: hair.eval_hits(good, good, 0.5)),
        (TypeError, column("d_value", "(3, 10)", "float32 of shape (3, 9), not C-contiguous"), lambda: raw.eval_grad(good, good, good[:, :9])),
        (TypeError, column("d_value", "(3, 10)", "float32 of shape (3, 10), not aligned"), lambda: raw.eval_grad(good, good, unaligned(10))),
        # Arrays of any shape.
        (TypeError, f"{vectors.format('wi')} float32 of shape (3, 10)", lambda: bsdf.eval(good)),
        (TypeError, f"{vectors.format('wi')} int64 of shape ()", lambda: bsdf.pdf(7)),
        (TypeError, f"{vectors.format('wi')} <class 'str'>", lambda: bsdf.eval_pdf("abc")),
        (TypeError, f"{vectors.format('wi')} <class 'list'>", lambda: bsdf.eval([[0, 1, 0], [0, 1]])),
        (TypeError, f"{vectors.format('wi')} complex128 of shape (3,)", lambda: bsdf.eval(np.ones(3, complex))),
        (TypeError, f"{vectors.format('xi')} <class 'NoneType'>", lambda: bsdf.sample(None)),
        (TypeError, f"{vectors.format('wo')} float64 of shape (2,)", lambda: hair.sample((0.6, 0.8), np.ones(3))),
        (TypeError, "h must be numbers of shape (...), got <class 'str'>", lambda: hair.eval((0, 1, 0), (0, 1, 0), "x")),
        (ValueError, f"wi {most} 1.000000e+39", lambda: bsdf.eval((0, 1e39, 0))),
        (TypeError, f"{vectors.format('wi')} <class 'tuple'>", lambda: bsdf.eval((0, 10**400, 0))),
        (ValueError, f"wi {before} (10,), got (9,)", lambda: hair.eval(good.T, good.T[:9])),
        (ValueError, f"h {before} (10,), got (2, 9)", lambda: hair.pdf(good.T, (0, 1, 0), np.zeros((2, 9)))),
        # Outputs.
        (TypeError, "out must be a dict, got <class 'list'>", lambda: bsdf.eval_columns(good, out=[])),
        (ValueError, 'out must have some of value, pdf, got "weight"', lambda: bsdf.eval_columns(good, out={"weight": frozen})),
        (ValueError, "out must have some of wi, value, pdf, weight, lobe, got 1", lambda: bsdf.sample_columns(good, out={1: 2})),
        (ValueError, 'out must have some of value, d_wo, d_wi, d_h, got "pdf"', lambda: raw.eval_grad(good, good, good, out={"pdf": 1})),
        (TypeError, column('out["pdf"]', "(10,)", "float32 of shape (9,)"), lambda: bsdf.eval_columns(good, out={"pdf": np.zeros(9, f32)})),
        (TypeError, column('out["value"]', "(3, 10)", "float32 of shape (3, 10), not aligned"), lambda: bsdf.eval_columns(good, out={"value": unaligned(10)})),
        (TypeError, column('out["value"]', "(3, 10)", "<class 'NoneType'>"), lambda: bsdf.eval_columns(good, out={"value": None})),
        (ValueError, 'out["value"] must be writeable', lambda: bsdf.eval_columns(good, out={"value": frozen})),
        (ValueError, 'out["value"] must share no memory with wi', lambda: bsdf.eval_columns(good, out={"value": good})),
        (ValueError, 'out["value"] must share no memory with wo', lambda: hair.eval_hits(good, good.copy(), out={"value": good})),
        (ValueError, 'out["pdf"] must share no memory with out["value"]', lambda: bsdf.eval_columns(good, out={"value": block[:3], "pdf": block[2]})),
        (ValueError, 'out["value"] must share no memory with wi', lambda: bsdf.eval_columns(twice[0], out={"value": twice[1]})),
        (ValueError, 'out["d_h"] must share no memory with d_value', lambda: raw.eval_grad(good, good, frozen, out={"d_h": frozen[1]})),
        # Derivatives.
        (ValueError, 'energy must be "raw" for derivatives, got "conserving"', lambda: hair.eval_grad(good, good, good)),
        # Files.
        (TypeError, "text must be a word, got <class 'bytes'>", lambda: make.from_json(b"{}")),
        (ValueError, "text must have one material, got 2", lambda: make.from_json(hair.to_json() * 2)),
    ]


@pytest.mark.parametrize("place", range(len(refusals())))
def test_refusals(place: int) -> None:
    kind, text, call = refusals()[place]
    with pytest.raises(kind) as refusal:
        call()
    assert str(refusal.value) == text


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{"model":"gaussian","params":{}}', "params.alpha: missing"),
        ('{"model":"chiang"}', "params: missing"),
        ('{"params":{}}', "model: missing"),
        ('{"model":7,"params":{}}', "model: must be a string, got 7"),
        (
            '{"model":"hair","params":{}}',
            "model: must be " + " or ".join(f'"{model}"' for model in hairis.models()) + ', got "hair"',
        ),
        ('{"model":"gaussian","params":[1]}', "params: must be an object, got an array of 1"),
        (
            '{"model":"gaussian","smapler":"matched","params":{}}',
            "smapler: unknown field, expected one of model, sampler, params, wo, wi, xi",
        ),
        (
            '{"model":"kajiya-kay","params":{"sampler":"matched"}}',
            "params.sampler: unknown field, expected one of kd, ks, exponent, form",
        ),
        ('{"model":"kajiya-kay","params":{"exponent":9,"exponent":8}}', "params.exponent: given twice"),
        ('{"model":"kajiya-kay","model":"chiang","params":{}}', "model: given twice"),
        (
            '{"model":"chiang","params":{"beta_m":0.3,"beta_n":0.3}}',
            "params.sigma_a: missing; give one of sigma_a, melanin, melanin_amount, color",
        ),
        (
            '{"model":"kajiya-kay","params":{"kd":[1,1,1],"ks":[1,"a",1],"exponent":9}}',
            'params.ks[1]: must be a number, got "a"',
        ),
        (
            '{"model":"kajiya-kay","params":{"kd":[1,1,1],"ks":[1,-1,1],"exponent":9}}',
            "params.ks[1]: must be finite and at least 0, got -1",
        ),
        ("[]", "line: must be an object, got an array of 0"),
        ("{", "line: not JSON: EOF while parsing an object (line 1, column 1)"),
        ("", "must have a material, got nothing"),
    ],
)
def test_json_is_refused_as_by_eval(text: str, message: str) -> None:
    with pytest.raises(ValueError) as refusal:
        hairis.Material.from_json(text)
    assert str(refusal.value) == message


HOSTILE: list[Any] = [
    None, True, 7, 10**400, -1.0, float("nan"), 1j, Fraction(1, 3), "", "tt", "\ud800\n", b"abc", object(), int, [], (1, 2), {1: 2},
    {0.1, 0.2, 0.3}, [10**400] * 3, [[1, 2, 3]], ["x", "y", "z"], range(3), np.array(0.5), np.ones((3, 1)), np.array(["a"] * 3),
    np.zeros((3, 4), np.float32), np.zeros((2, 3, 4), np.float32), np.zeros(3, ">f4"), np.zeros(3, "datetime64[s]"),
]  # fmt: skip


@pytest.mark.parametrize("place", range(len(HOSTILE)))
def test_refusals_name_their_argument(place: int) -> None:
    """Whatever an argument is, the call accepts it, or the exception begins with the name of the argument or of its item."""
    value = HOSTILE[place]
    make: Any = hairis.Material
    hair: Any = make("chiang", energy="raw")
    bsdf: Any = hair.prepare((0, 1, 0))
    good = directions(4, 1)
    calls: list[tuple[str, Call]] = [
        ("model", lambda: make(value)),
        ("preset", lambda: make("chiang", value)),
        ("energy", lambda: make(energy=value)),
        ("beta", lambda: make(beta=value)),
        ("gamma_tt", lambda: make(gamma_tt=value)),
        ("sampler", lambda: make(sampler=value)),
        ("shifts", lambda: make("chiang", shifts=value)),
        ("text", lambda: make.from_json(value)),
        ("wo", lambda: hair.prepare(value)),
        ("h", lambda: hair.prepare((0, 1, 0), value)),
        ("wi", lambda: bsdf.lobes(value)),
        ("lobes", lambda: bsdf.with_lobes(value)),
        ("wi", lambda: bsdf.eval_columns(value)),
        ("xi", lambda: bsdf.sample_columns(value)),
        ("h", lambda: hair.eval_hits(good, good, value)),
        ("wi", lambda: bsdf.eval(value)),
        ("xi", lambda: bsdf.sample(value)),
        ("wo", lambda: hair.eval_pdf(value, (0, 1, 0))),
        ("h", lambda: hair.pdf(np.ones((2, 3)), (0, 1, 0), value)),
        ("d_value", lambda: hair.eval_grad(good, good, value)),
        ("out", lambda: bsdf.eval_columns(good, out=value)),
        ("out", lambda: bsdf.eval_columns(good, out={"pdf": value})),
    ]
    for name, call in calls:
        try:
            call()
        except (TypeError, ValueError) as error:
            text = str(error)
            is_json = name == "text" and isinstance(value, str)
            assert is_json or text.split(" ")[0].split("[")[0] == name, (name, value, text)
            assert len(text.splitlines()) == 1 and "must" in text or is_json, (name, value, text)


def test_exceptions_of_values_stay() -> None:
    """An exception that says nothing about a type is not replaced."""

    class Interrupted:
        def __float__(self) -> float:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        hairis.Material(gamma_tt=Interrupted())  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["out[\"weight\"]", "xi"])
def test_arrays_that_another_thread_uses(name: str) -> None:
    """A call that meets another one says so, and not that the array is read-only or overlaps."""
    bsdf = hairis.Material("gaussian", "brown").prepare((0.6, 0, 0.8))
    xi = np.random.default_rng(1).random((3, 200_000), np.float32)
    shared = np.zeros_like(xi)
    done, seen = threading.Event(), set()

    def write() -> None:
        while not done.is_set():
            try:
                bsdf.sample_columns(xi, out={"weight": shared})
            except ValueError as error:
                seen.add(str(error))

    writer = threading.Thread(target=write)
    writer.start()
    for _ in range(1000):
        try:
            if name == "xi":
                bsdf.sample_columns(shared)
            else:
                bsdf.sample_columns(xi, out={"weight": shared})
        except ValueError as error:
            seen.add(str(error))
        if any(text.startswith(name) for text in seen):
            break
    done.set()
    writer.join()
    used = "is in use by another call; give each thread arrays of its own to write"
    assert f"{name} {used}" in seen and seen <= {f"{one} {used}" for one in ('out["weight"]', "xi")}


def test_outputs_side_by_side() -> None:
    block = np.zeros((4, 10), np.float32)
    out = {"value": block[:3], "pdf": block[3]}
    assert hairis.Material().prepare((0, 1, 0)).eval_columns(directions(10, 1), out=out) is out
