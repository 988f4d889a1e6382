"""Tests of derivatives against differences."""

from __future__ import annotations

from typing import Any

import hairis
import numpy as np
import pytest
from conftest import bits, directions
from numpy.typing import NDArray

DEFAULTS: list[tuple[str, str, dict[str, Any]]] = [
    (name, preset, {}) for name, model in hairis.models().items() for preset in model["presets"][1:3]
]
IN_PLACE: list[dict[str, Any]] = [
    {"color": (0.2, 0.5, 0.9)},
    {"melanin": (0.6, 0.2)},
    {"melanin_amount": (0.4, 0.3)},
    {"cuticle_angle": 0.52},
]
# Fields whose default is the end of their range, beyond which there is no difference.
INSIDE: dict[str, dict[str, Any]] = {
    "chiang": {"tint_r": (0.9, 0.7, 0.8), "tint_tt": (0.8, 0.9, 0.6), "tint_trt": (0.5, 0.9, 0.7)},
    "d-eon": {"diffuse": 0.2, "diffuse_color": (0.7, 0.6, 0.5)},
}


def case(n: int) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]:
    """Returns hits, directions, derivatives of a loss, and offsets."""
    rng = np.random.default_rng(5)
    d_value = rng.uniform(-1, 1, (3, n)).astype(np.float32)
    return directions(n, 1), directions(n, 2), d_value, rng.uniform(-0.9, 0.9, n).astype(np.float32)


@pytest.mark.parametrize(("model", "preset", "more"), DEFAULTS + [("chiang", "brown", more) for more in IN_PLACE])
def test_fields_against_differences(model: str, preset: str, more: dict[str, Any]) -> None:
    wo, wi, d_value, h = case(3000)
    hair = hairis.Material(model, preset, energy="raw", **more, **INSIDE.get(model.removesuffix("-diffuse").removesuffix("-scattering"), {}))
    columns, d_fields = hair.eval_grad(wo, wi, d_value, h)
    assert d_fields.keys() == {name for name, value in hair.fields.items() if not isinstance(value, str)}
    assert (bits(columns["value"]) == bits(hair.eval_hits(wo, wi, h)["value"])).all()
    fields: dict[str, Any] = hair.fields
    choice = {} if hair.choice is None else {hairis.models()[model]["choice"]: hair.choice}

    def loss(name: str, value: Any) -> float:
        other = hairis.Material(model, energy="raw", **choice, **{**fields, name: value})
        return float((d_value * other.eval_hits(wo, wi, h)["value"].astype(np.float64)).sum())

    scale = max(float(np.abs(np.asarray(d)).max()) for d in d_fields.values())
    for name, got in d_fields.items():
        value = np.atleast_1d(np.asarray(fields[name], np.float64))
        for i in range(len(value)):
            step = 2e-3 * max(abs(value[i]), 0.1)
            ends = []
            for sign in (1, -1):
                moved = value.copy()
                moved[i] += sign * step
                ends.append(loss(name, moved if len(value) > 1 else float(moved[0])))
            want = (ends[0] - ends[1]) / (2 * step)
            assert np.atleast_1d(got)[i] == pytest.approx(want, rel=0.02, abs=2e-3 * scale), (name, i)


def test_out_and_threads_of_columns() -> None:
    wo, wi, d_value, _ = case(100)
    hair = hairis.Material("cauchy", "red", energy="raw")
    out = {"d_wi": np.empty((3, 100), np.float32)}
    columns, d_fields = hair.eval_grad(wo, wi, d_value, out=out)
    assert columns is out and d_fields.keys() == hair.fields.keys()
    whole, same = hair.eval_grad(wo, wi, d_value)
    assert same == d_fields and (bits(whole["d_wi"]) == bits(out["d_wi"])).all()


def test_ends() -> None:
    """The offset is infinitely steep at a silhouette, and has no derivative there; a clear fibre has that of its absorption."""
    wo, wi, d_value, h = case(1000)
    h = np.where(h < 0, np.float32(-1), np.float32(1))
    hair = hairis.Material("chiang", energy="raw", sigma_a=(0.0, 0.5, 0.0))
    columns, d_fields = hair.eval_grad(wo, wi, d_value, h)
    assert (columns["d_h"] == 0).all() and np.abs(columns["d_wi"]).max() > 0

    def loss(red: float) -> float:
        other = hairis.Material("chiang", energy="raw", sigma_a=(red, 0.5, 0.0))
        return float((d_value * other.eval_hits(wo, wi, h)["value"].astype(np.float64)).sum())

    step = 1e-3
    want = (4 * loss(step) - loss(2 * step) - 3 * loss(0.0)) / (2 * step)
    assert np.ravel(d_fields["sigma_a"])[0] == pytest.approx(want, rel=0.01)
