"""Floating-point exceptions that calls of the wheel raise on everyday input, as a host with traps would meet them."""

from __future__ import annotations

import ctypes
import ctypes.util
import platform
from collections.abc import Callable
from typing import Any

import hairis
import pytest
from conftest import directions
from numpy.random import default_rng

pytestmark = pytest.mark.skipif(
    platform.system() != "Linux" or platform.machine() != "x86_64", reason="the numbers of the flags are those of x86-64"
)
INVALID, DIVISION_BY_ZERO, OVERFLOW = 1, 4, 8
WATCHED = INVALID | DIVISION_BY_ZERO | OVERFLOW


@pytest.fixture
def raised() -> Callable[[Callable[[], Any]], int]:
    """A function that returns the flags of the exceptions that a call raises."""
    libm = ctypes.CDLL(ctypes.util.find_library("m"))

    def flags(call: Callable[[], Any]) -> int:
        libm.feclearexcept(0x3F)
        call()
        return int(libm.fetestexcept(WATCHED))

    # Control: the square root of -1, by the same library.
    libm.sqrtf.argtypes = [ctypes.c_float]
    assert flags(lambda: libm.sqrtf(-1.0)) == INVALID
    assert flags(lambda: libm.sqrtf(1.0)) == 0
    return flags


def calls(model: str, preset: str, energy: Any, choice: dict[str, Any]) -> dict[str, Callable[[], Any]]:
    """Returns every call on a preset, with everyday input."""
    n = 37
    wo, wi = directions(n, 3), directions(n, 4)
    xi = default_rng(5).uniform(1e-6, 1 - 1e-6, (3, n)).astype("f4")
    h = default_rng(6).uniform(-1, 1, n).astype("f4")
    hair = hairis.Material(model, preset, energy=energy, **choice)
    bsdfs = [hair.prepare(wo[:, i], h[i]) for i in range(n)]
    return {
        "Material": lambda: hairis.Material(model, preset, energy=energy, **choice),
        "max_albedo": lambda: hair.max_albedo,
        "prepare": lambda: [hair.prepare(wo[:, i], h[i]) for i in range(n)],
        "albedo": lambda: [bsdf.albedo() for bsdf in bsdfs],
        "lobes": lambda: [bsdf.lobes(wi[:, i]) for i, bsdf in enumerate(bsdfs)],
        "eval_columns": lambda: [bsdf.eval_columns(wi) for bsdf in bsdfs],
        "sample_columns": lambda: [bsdf.sample_columns(xi) for bsdf in bsdfs],
        "eval_hits": lambda: hair.eval_hits(wo, wi, h),
        "sample_hits": lambda: hair.sample_hits(wo, xi, h),
    }


@pytest.mark.parametrize("energy", ["raw", "conserving", "scaled"])
@pytest.mark.parametrize("model", hairis.models())
def test_everyday_input_raises_no_exception(model: str, energy: Any, raised: Callable[[Callable[[], Any]], int]) -> None:
    about = hairis.models()[model]
    found = []
    for word in about["choices"] or [None]:
        choice: dict[str, Any] = {} if word is None else {about["choice"]: word}
        for preset in about["presets"]:
            made = calls(model, preset, energy, choice)
            found += [f"{word} {preset} {name}" for name, call in made.items() if raised(call)]
    assert not found
