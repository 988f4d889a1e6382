"""A Mitsuba 3 BSDF over the wheel of hairis, for any JIT variant: import it after mi.set_variant(...).

Mitsuba's frame of a curve is (x, y along it, z the normal); the fibre's (u, v, w) is (y, z, x). Mitsuba's eval includes the cosine to
the normal plane. Arrays leave Dr.Jit for NumPy, so loops and calls must be evaluated: switch off dr.JitFlag.SymbolicLoops and
dr.JitFlag.SymbolicCalls before rendering."""

import drjit as dr
import hairis
import mitsuba as mi
import numpy as np


def columns(v):
    """Mitsuba's local directions as columns of shape (3, N) in the fibre's frame."""
    a = np.array(v, dtype=np.float32).reshape(3, -1)
    return np.ascontiguousarray(a[[1, 2, 0]])


def vector(a):
    return mi.Vector3f(a[2], a[0], a[1])


def offset(wo):
    """Offset across the fibre of hits on round curves, whose normal is z."""
    return np.ascontiguousarray(wo[2] / np.maximum(np.hypot(wo[1], wo[2]), 1e-20), np.float32)


def alike(*arrays):
    n = max(a.shape[1] for a in arrays)
    return [np.ascontiguousarray(np.broadcast_to(a, (a.shape[0], n))) for a in arrays]


class HairIS(mi.BSDF):
    """The plugin's properties: model, choice, preset, energy, and the fields of the model."""

    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        model, energy = props.get("model", "gaussian"), props.get("energy", "conserving")
        preset, word = props.get("preset"), props.get("choice")
        # For tests: a density that is wrong by this factor must be found.
        self.pdf_factor = float(props.get("pdf_factor", 1.0))
        fields = {}
        for name in props.unqueried():
            value = props[name]
            fields[name] = value if isinstance(value, (str, float, int)) else [float(x) for x in np.array(value).ravel()]
        if word is not None:
            fields[hairis.models()[model]["choice"]] = word
        self.material = hairis.Material(model, preset, energy=energy, **fields)
        flags = (mi.BSDFFlags.Glossy | mi.BSDFFlags.Anisotropic | mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
                 | mi.BSDFFlags.NonSymmetric)
        self.m_components, self.m_flags = [flags], flags

    def evaluated(self, si, wo):
        o, i = alike(columns(si.wi), columns(wo))
        r = self.material.eval_hits(o, i, offset(o))
        return mi.Color3f(r["value"] * np.hypot(i[1], i[2])), mi.Float(r["pdf"] * self.pdf_factor)

    def sample(self, ctx, si, s1, s2, active=True):
        xi = np.concatenate([np.array(s1).reshape(1, -1), np.array(s2).reshape(2, -1)]).astype(np.float32)
        o, xi = alike(columns(si.wi), xi)
        r = self.material.sample_hits(o, xi, offset(o))
        bs = dr.zeros(mi.BSDFSample3f, o.shape[1])
        bs.wo, bs.pdf, bs.eta = vector(r["wi"]), mi.Float(r["pdf"] * self.pdf_factor), 1.0
        bs.sampled_type, bs.sampled_component = mi.UInt32(+mi.BSDFFlags.Glossy), mi.UInt32(0)
        return bs, mi.Color3f(r["weight"] / self.pdf_factor) & active

    def eval(self, ctx, si, wo, active=True):
        return self.evaluated(si, wo)[0] & active

    def pdf(self, ctx, si, wo, active=True):
        return dr.select(active, self.evaluated(si, wo)[1], 0)

    def eval_pdf(self, ctx, si, wo, active=True):
        value, pdf = self.evaluated(si, wo)
        return value & active, dr.select(active, pdf, 0)

    def to_string(self):
        return f"HairIS[{self.material!r}]"


mi.register_bsdf("hairis", HairIS)
