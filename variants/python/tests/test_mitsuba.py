"""Tests of the BSDF for Mitsuba, whose chi-square test variants/capi/examples/mitsuba/chi2.py runs over every model and sampler."""

from __future__ import annotations

import importlib
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import hairis
import numpy as np
import pytest

# In any variant: samples, values and densities at one hit, and the parameters.
ONE_HIT = """
import sys
import mitsuba as mi
mi.set_variant(sys.argv[1])
import drjit as dr, hairis, hairis.mitsuba, numpy as np
for name in hairis.models():
    bsdf = mi.load_dict({"type": "hairis", "model": name, "preset": "brown"})
    si = dr.zeros(mi.SurfaceInteraction3f)
    si.wi = mi.Vector3f(0.2, 0.6, 0.7746)
    drawn, weight = bsdf.sample(mi.BSDFContext(), si, 0.3, mi.Point2f(0.2, 0.7))
    value, pdf = bsdf.eval_pdf(mi.BSDFContext(), si, drawn.wo)
    numbers = [drawn.wo, drawn.pdf, weight, value, pdf, bsdf.eval(mi.BSDFContext(), si, drawn.wo), bsdf.pdf(mi.BSDFContext(), si, drawn.wo)]
    print(*np.concatenate([np.ravel(np.array(x, float)) for x in numbers]))
    hair = hairis.Material(name, "brown")
    assert set(mi.traverse(bsdf).keys()) == {key for key, value in hair.fields.items() if not isinstance(value, str)}
"""


@pytest.mark.parametrize("variant", ["scalar_rgb", "llvm_ad_rgb"])
def test_one_hit_is_the_wheel_s(variant: str) -> None:
    pytest.importorskip("mitsuba")
    run = subprocess.run([sys.executable, "-c", ONE_HIT, variant], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    lines = run.stdout.splitlines()
    assert len(lines) == len(hairis.models())
    for line, name in zip(lines, hairis.models()):
        got = np.array(line.split(), float)
        hair = hairis.Material(name, "brown", energy="raw")
        # Mitsuba has (x, y along the fibre, z the normal), and the fibre (y, z, x).
        wo = (0.6, 0.7746, 0.2)
        h = 0.2 / np.hypot(0.7746, 0.2)
        s = hair.sample(wo, (0.3, 0.2, 0.7), h)
        value, pdf = hair.eval_pdf(wo, s["wi"], h)
        value = value * np.hypot(s["wi"][1], s["wi"][2])
        want = [s["wi"][[2, 0, 1]], [s["pdf"]], s["weight"], value, [pdf], value, [pdf]]
        np.testing.assert_allclose(got, np.concatenate(want), rtol=1e-4, atol=1e-6)


@pytest.fixture
def mi() -> Any:
    mitsuba: Any = pytest.importorskip("mitsuba")
    mitsuba.set_variant("llvm_ad_rgb")
    importlib.import_module("hairis.mitsuba")
    return mitsuba


def test_other_energies_are_refused(mi: Any) -> None:
    with pytest.raises(Exception, match='energy must be "raw" for arrays, got "conserving"'):
        mi.load_dict({"type": "hairis", "energy": "conserving"})


def test_derivatives_of_a_picture(mi: Any, tmp_path: Path) -> None:
    """Mitsuba's path replay differentiates a picture by widths and a colour as differences do, and twice without an update as once."""
    dr: Any = importlib.import_module("drjit")
    x = np.linspace(-8, 8, 12)
    strands = [[f"{a:g} {0.1 * y:g} {0.3 * np.sin(y):g} 0.06" for a in x] for y in range(-20, 21)]
    # Mitsuba 3.9.1 reads past the control points where a ray hits the very end of the last curve.
    strands.append([f"0 0 {-500 - 0.1 * i:g} 1e-4" for i in range(4)])
    file = tmp_path / "strands.txt"
    file.write_text("\n\n".join(map("\n".join, strands)))
    scene = mi.load_dict({
        "type": "scene",
        "integrator": {"type": "prb", "max_depth": 3},
        "lamp": {"type": "directional", "direction": [0.3, -0.5, -1], "irradiance": {"type": "rgb", "value": 3.0}},
        "sky": {"type": "constant", "radiance": 0.3},
        "sensor": {
            "type": "perspective",
            "fov": 30,
            "to_world": mi.ScalarTransform4f().look_at([0, 0, 12], [0, 0, 0], [0, 1, 0]),
            "film": {"type": "hdrfilm", "width": 48, "height": 32, "rfilter": {"type": "box"}},
        },
        "hair": {"type": "bsplinecurve", "filename": str(file), "bsdf": {"type": "hairis", "preset": "brown", "choice": "matched"}},
    })
    params = mi.traverse(scene)
    keys = ["hair.bsdf.beta", "hair.bsdf.i_trt", "hair.bsdf.gamma_tt"]

    def mean(seed: int, spp: int) -> Any:
        return dr.mean(mi.render(scene, params, spp=spp, seed=seed), axis=None)

    for key in keys:
        dr.enable_grad(params[key])
    params.update()
    gradients = []
    for _ in range(2):
        dr.backward(mean(7, 256))
        gradients.append([np.array(dr.grad(params[key])).ravel() for key in keys])
    for key, once, twice in zip(keys, *gradients):
        np.testing.assert_allclose(twice, 2 * once, rtol=1e-4)
        before = np.array(dr.detach(params[key])).ravel()
        for i, number in enumerate(before):
            ends = []
            for sign in (-1, 1):
                moved = before.copy()
                moved[i] += 0.03 * sign * number
                params[key] = type(params[key])(*moved.tolist())
                params.update()
                ends.append(float(mean(7, 256).array[0]))
            difference = (ends[1] - ends[0]) / (0.06 * number)
            assert once[i] == pytest.approx(difference, rel=0.05, abs=1e-3), (key, i)
        params[key] = type(params[key])(*before.tolist())
        params.update()


def test_the_example_recovers_the_hair_of_a_picture(tmp_path: Path) -> None:
    pytest.importorskip("mitsuba")
    example = Path(__file__).parent.parent / "examples" / "mitsuba_fit.py"
    assert len(example.read_text().splitlines()) <= 30
    picture = tmp_path / "fit.png"
    run = subprocess.run([sys.executable, example, picture], capture_output=True, text=True)
    assert run.returncode == 0 and picture.exists(), run.stderr
    found, hidden = zip(*(re.findall(r"\[([^]]*)\]", line) for line in run.stdout.splitlines()))
    numbers = [np.array(" ".join(part).split(), float) for part in (found, hidden)]
    assert numbers[0].shape == (5,)
    np.testing.assert_allclose(numbers[0], numbers[1], rtol=0, atol=0.03)
