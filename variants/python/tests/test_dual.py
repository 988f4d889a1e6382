"""Dual scattering: against its definition by the samples of a material, and its functions against sums."""

from pathlib import Path

import numpy as np
import pytest

import hairis
import hairis.dual

VARIANTS = Path(__file__).parents[2]
DEPTHS = np.array([0.0, 0.5, 3.0], np.float32)


@pytest.mark.parametrize("model", ["gaussian", "cauchy", "kajiya-kay", "chiang"])
def test_albedos_are_those_of_samples(model: str) -> None:
    hair = hairis.Material(model, "blond")
    xi = np.random.default_rng(1).random((200_000, 3))
    h = 2 * np.random.default_rng(2).random(200_000) - 1
    drawn = hair.sample((0, 1, 0), xi, h)
    phi = np.abs(np.arctan2(drawn["wi"][:, 2], drawn["wi"][:, 1]))
    averages = np.reshape(hairis.dual.material(hair).coefficients, (8, 3, 10))[:, :, 0]
    for side, share in [(0, phi / np.pi), (1, 1 - phi / np.pi)]:
        light = drawn["weight"] * share[:, None]
        mean, error = light.mean(axis=0), light.std(axis=0) / len(light) ** 0.5
        # The polynomials have errors of up to 1e-2 where energy conservation sets in.
        assert np.all(np.abs(averages[side] - mean) < 5 * error + 0.01), (side, averages[side], mean)


def test_the_gain_is_one_number() -> None:
    gain = hairis.dual.GAIN
    for file, text in [
        ("capi/include/hairis.h", f"#define HAIRIS_DUAL_GAIN {gain}f"),
        ("shaders/examples/three/src/multiple.js", f"export const GAIN = {gain};"),
    ]:
        assert text in (VARIANTS / file).read_text(encoding="utf-8"), file


def test_depths_are_shares_of_light() -> None:
    dual = hairis.dual.material("chiang", "brown")
    crossed = dual.depth(np.float32(0.2), DEPTHS)
    np.testing.assert_allclose(crossed.direct, np.exp(-DEPTHS), rtol=1e-6)
    one = dual.strands(np.float32(0.2), np.float32(1.0))
    forward = np.array([float(x) for x in one.scattered])
    assert float(one.direct) == 0 and np.all((forward > 0.02) & (forward < 0.5))
    for c in range(3):
        through = np.exp(-DEPTHS * (1 - forward[c])) - np.exp(-DEPTHS)
        np.testing.assert_allclose(crossed.scattered[c], through, rtol=1e-4, atol=1e-6)


def test_shading_adds_what_other_fibres_scatter() -> None:
    hair = hairis.Material("gaussian", "blond")
    dual, wo, wi = hairis.dual.material(hair), (0.0, 0.6, 0.8), (0.0, 1.0, 0.0)
    single = hair.eval(wo, wi)
    clear, deep = (dual.shade(wo, wi, single, dual.depth(0.0, depth)) for depth in (0.0, 8.0))
    alone = dual.shade(wo, wi, single, dual.depth(0.0, 0.0), (0.0, 0.0))
    np.testing.assert_allclose(np.ravel(alone), single, rtol=1e-6)
    assert np.all(np.ravel(clear) > single) and np.all(np.ravel(deep) < single)
