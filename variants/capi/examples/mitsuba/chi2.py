"""Mitsuba's chi-square test of the BSDF in hairis.mitsuba: every model and sampler, two presets, four directions, with one level of .01
over all; then controls, densities 5% too large or too small, which must be refused. chi2.py [SAMPLES]"""

import sys
from xml.sax.saxutils import quoteattr

import drjit as dr
import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
import hairis.mitsuba  # noqa: E402
from mitsuba.chi2 import BSDFAdapter, ChiSquareTest  # noqa: E402


class FibreDomain:
    """(phi, theta) about the fibre, which is y. A domain of equal areas would have its pole elsewhere: densities have 1 / cos(theta) at
    the fibre's axis, which the trapezoid rule does not integrate. Here the Jacobian cos(theta) is part of the density."""

    edge = 1e-3

    def bounds(self):
        return mi.ScalarBoundingBox2f([-dr.pi, -dr.pi / 2], [dr.pi, dr.pi / 2])

    def aspect(self):
        return 2

    def map_forward(self, p):
        sin_phi, cos_phi = dr.sincos(p.x)
        sin_theta, cos_theta = dr.sincos(dr.clip(p.y, self.edge - dr.pi / 2, dr.pi / 2 - self.edge))
        return mi.Vector3f(cos_theta * sin_phi, sin_theta, cos_theta * cos_phi)

    def map_backward(self, w):
        return mi.Vector2f(dr.atan2(w.x, w.z), dr.atan2(w.y, dr.sqrt(w.x * w.x + w.z * w.z)))


def xml(properties):
    kinds = {str: "string", float: "float"}
    return "".join(f"<{kinds[type(v)]} name={quoteattr(k)} value={quoteattr(str(v))}/>" for k, v in properties.items())


def passes(properties, wi, samples, tests):
    sample, pdf = BSDFAdapter("hairis", xml(properties), wi=wi)

    def pdf_cos(w):
        return pdf(w) * dr.sqrt(w.x * w.x + w.z * w.z)

    test = ChiSquareTest(FibreDomain(), sample, pdf_cos, sample_dim=3, sample_count=samples, res=101, ires=16)
    return test.run(0.01, test_count=tests, quiet=True), test.p_value


def main():
    samples = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000
    entries = [(name, word) for name, model in hairis.models().items() for word in (model["choices"] or [None])]
    angles, presets = [(0, 0.7), (35, 2.0), (-60, -1.0), (75, 0.3)], ["brown", "white"]
    total, good = len(entries) * len(angles) * len(presets), 0
    for name, word in entries:
        p_values = []
        for preset in presets:
            for theta, phi in angles:
                theta = np.radians(theta)
                wi = [float(x) for x in (np.cos(theta) * np.sin(phi), np.sin(theta), np.cos(theta) * np.cos(phi))]
                properties = {"model": name, "preset": preset, "energy": "raw", **({"choice": word} if word else {})}
                ok, p = passes(properties, wi, samples, total)
                good, p_values = good + ok, [*p_values, p]
                if not ok:
                    print(f"FAIL {properties} from {wi}: p {p:.3g}")
        print(f"{name} {word or ''}: least p {min(p_values):.3g}, median {np.median(p_values):.2f}", flush=True)
    print(f"chi-square: {good} of {total} pass")
    found = 0
    for model, factor in (("gaussian", 1.05), ("chiang", 0.95)):
        ok, p = passes({"model": model, "preset": "brown", "pdf_factor": factor}, [0.6, 0.5, 0.6245], samples, total)
        found += not ok
        print(f"control, density of {model} times {factor}: {'PASSES' if ok else 'refused'}, p {p:.3g}")
    sys.exit(0 if good == total and found == 2 else 1)


main()
