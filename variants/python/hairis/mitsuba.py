"""Hair as a BSDF of Mitsuba 3, in all variants with RGB. Import the module after `mi.set_variant`; it registers the plugin "hairis".

The plugin's properties are `model`, `choice`, `preset`, `energy`, which must be "raw", and the fields of the model. `mi.traverse` lists the
numbers among the fields, which optimisers move in variants that differentiate. The BSDF is for curves, whose frame is (x, y along the fibre, z the
normal), so that the fibre's (u, v, w) is (y, z, x); the offset across the fibre follows from the direction of the viewer.
"""

from __future__ import annotations

import importlib
from typing import Any

from . import Material
from ._arrays import described, width
from .drjit import material

dr: Any = importlib.import_module("drjit")
mi: Any = importlib.import_module("mitsuba")


def fibre(v: Any) -> Any:
    return mi.Vector3f(v.y, v.z, v.x)


def cosine(w: Any) -> Any:
    """Returns the cosine of the inclination to the normal plane, of a direction in the fibre's frame."""
    return dr.sqrt(w.y * w.y + w.z * w.z)


class HairBSDF(mi.BSDF):  # type: ignore[misc]
    """Hair of a model of hairis, whose numbers are parameters."""

    def __init__(self, props: Any) -> None:
        mi.BSDF.__init__(self, props)
        model, preset, choice = props.get("model", "gaussian"), props.get("preset"), props.get("choice")
        energy = props.get("energy", "raw")
        # Tests need a density that is wrong by a factor.
        self.pdf_factor = float(props.get("pdf_factor", 1.0))
        fields: dict[str, Any] = {}
        for name in props.unqueried():
            value = props[name]
            fields[name] = value if isinstance(value, str | int | float) else [float(x) for x in value]
        if choice is not None:
            fields[described(model)["choice"]] = choice
        self.material = Material(model, preset, energy=energy, **fields)
        self.hair = material(self.material)
        kinds = described(self.material.model)["fields"]
        given: Any = self.material.fields
        self.numbers = {}
        for name, value in given.items():
            if not isinstance(value, str):
                kind = mi.Color3f if kinds[name]["kind"] == "rgb" else mi.Vector3f
                self.numbers[name] = kind(*value) if width(kinds[name]) else mi.Float(value)
        flags = mi.BSDFFlags.Glossy | mi.BSDFFlags.Anisotropic | mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide | mi.BSDFFlags.NonSymmetric
        self.m_components, self.m_flags = [flags], flags

    def traverse(self, callback: Any) -> None:
        for name, value in self.numbers.items():
            callback.put(name, value, mi.ParamFlags.Differentiable)

    def parameters_changed(self, keys: Any = ()) -> None:
        # Numbers that are not literals, so that further changes compile no other kernel.
        dr.make_opaque(self.numbers)
        self.hair = material(self.material, **self.numbers)

    def evaluated(self, si: Any, wo: Any) -> Any:
        viewer, light = fibre(si.wi), fibre(wo)
        value, pdf = self.hair.eval_pdf(viewer, light, self.offset(viewer))
        return mi.Color3f(value) * cosine(light), pdf * self.pdf_factor

    def offset(self, viewer: Any) -> Any:
        """Returns the offset across the fibre of a hit on a round curve, whose normal is v."""
        return viewer.z / dr.maximum(cosine(viewer), 1e-20)

    def sample(self, ctx: Any, si: Any, sample1: Any, sample2: Any, active: Any = True) -> Any:
        viewer = fibre(si.wi)
        drawn = self.hair.sample(viewer, [sample1, sample2.x, sample2.y], self.offset(viewer))
        wi = drawn["wi"]
        bs = dr.zeros(mi.BSDFSample3f, dr.width(drawn["pdf"]))
        bs.wo, bs.pdf, bs.eta = mi.Vector3f(wi.z, wi.x, wi.y), drawn["pdf"] * self.pdf_factor, 1.0
        bs.sampled_type, bs.sampled_component = mi.UInt32(+mi.BSDFFlags.Glossy), mi.UInt32(0)
        return bs, dr.select(active, mi.Color3f(drawn["weight"]) / self.pdf_factor, 0)

    def eval(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
        return dr.select(active, self.evaluated(si, wo)[0], 0)

    def pdf(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
        return dr.select(active, self.evaluated(si, wo)[1], 0)

    def eval_pdf(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
        value, pdf = self.evaluated(si, wo)
        return dr.select(active, value, 0), dr.select(active, pdf, 0)

    def to_string(self) -> str:
        return f"HairBSDF[{self.hair!r}]"


mi.register_bsdf("hairis", HairBSDF)
