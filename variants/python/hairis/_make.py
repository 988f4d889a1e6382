"""Functions that pickled objects refer to."""

from __future__ import annotations

from collections.abc import Sequence

from ._hairis import Bsdf, Material


def bsdf(material: Material, wo: Sequence[float], h: float, lobes: Sequence[str] | None) -> Bsdf:
    """Returns the BSDF of a material at a hit, restricted to some lobes if they are given."""
    whole = material.prepare(wo, h)
    return whole if lobes is None else whole.with_lobes(lobes)
