"""Plots of lobes with matplotlib, which `pip install hairis[plot]` installs.

>>> import matplotlib; matplotlib.use("agg")
>>> import hairis.plot
>>> axes = hairis.plot.polar("chiang")
>>> bsdf = hairis.Material("gaussian", "brown", sampler="matched").prepare((0.5, 0.75**0.5, 0.0))
>>> axes = hairis.plot.sphere(bsdf)

A model by its name, or a material, is seen from 30 degrees of inclination at azimuth 0, and at h = 0.3 if it is of the near field.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._hairis import Bsdf, Material

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LUMINANCE = np.array([0.2126, 0.7152, 0.0722], np.float32)


def _directions(theta: NDArray[Any], phi: NDArray[Any]) -> NDArray[np.float32]:
    """Returns unit vectors of shape (3, N) in the fibre's frame."""
    cos = np.cos(theta)
    columns = np.stack([np.sin(theta), cos * np.cos(phi), cos * np.sin(phi)]).reshape(3, -1)
    return np.ascontiguousarray(columns, np.float32)


def _bsdf(of: Bsdf | Material | str) -> Bsdf:
    material = Material(of) if isinstance(of, str) else of
    if isinstance(material, Bsdf):
        return material
    return material.prepare((0.5, 0.75**0.5, 0.0), 0.3 if material.near_field else 0.0)


def _axes(axes: Axes | None, **arguments: Any) -> Axes:
    if axes is not None:
        return axes
    import matplotlib.pyplot as plt

    made: Axes = plt.figure().add_subplot(**arguments)
    return made


def polar(
    of: Bsdf | Material | str, theta: float | None = None, *, count: int = 1024, axes: Axes | None = None
) -> Axes:
    """Draws each lobe and their sum as a polar plot over the azimuth of `wi`, on a logarithmic scale.

    Parameters
    ----------
    of : Bsdf, Material or str
        Material at a hit, a material, or a model by its name.
    theta : float, optional
        Inclination of `wi` in radians, in (-pi/2, pi/2). Without it, the inclination at which S times the cosine is largest.
    count : int
        Number of azimuths.
    axes : matplotlib Axes, optional
        Polar axes to draw in; without it, new axes are made.

    Returns
    -------
    matplotlib Axes
        The radius is the luminance of S times the cosine, per steradian, over four decades. The angle is the azimuth of `wi`, in
        radians.
    """
    bsdf = _bsdf(of)
    axes = _axes(axes, projection="polar")
    phi = np.linspace(-np.pi, np.pi, count)
    if theta is None:
        grid, azimuths = np.meshgrid(np.linspace(-1.5, 1.5, 301), np.linspace(-np.pi, np.pi, 64), indexing="ij")
        values = LUMINANCE @ bsdf.eval_columns(_directions(grid, azimuths))["value"]
        theta = float(grid.ravel()[int(np.argmax(values * np.cos(grid.ravel())))])
    wi = _directions(np.full_like(phi, theta), phi)
    total = LUMINANCE @ bsdf.eval_columns(wi)["value"] * np.cos(theta)
    most = max(float(total.max()), 1e-30)
    axes.plot(phi, np.maximum(total, 1e-9 * most), "k", label="sum", linewidth=2, alpha=0.3)
    for name in bsdf.albedo():
        one = LUMINANCE @ bsdf.with_lobes([name]).eval_columns(wi)["value"] * np.cos(theta)
        if one.max() > 0:
            label = name.upper() if name[0] in "rt" else name
            axes.plot(phi, np.maximum(one, 1e-9 * most), label=label, linewidth=1)
    title = f"theta_i = {np.degrees(theta):.1f}°"
    axes.set(rscale="log", ylim=(1e-4 * most, 1.2 * most), rlabel_position=110, title=title)
    axes.tick_params(labelsize="small")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=3, fontsize="small", frameon=False)
    return axes


def sphere(of: Bsdf | Material | str, *, resolution: int = 256, axes: Axes | None = None) -> Axes:
    """Draws the BSDF as a map over the sphere on a logarithmic scale, with the azimuth across and the inclination up.

    Parameters
    ----------
    of : Bsdf, Material or str
        Material at a hit, a material, or a model by its name.
    resolution : int
        Number of rows of the map, which has twice as many columns.
    axes : matplotlib Axes, optional
        Axes to draw in; without it, new axes are made.

    Returns
    -------
    matplotlib Axes
        The colour is log10 of the luminance of S, per steradian, over six decades. Angles are in degrees.
    """
    bsdf = _bsdf(of)
    axes = _axes(axes)
    theta = (np.arange(resolution) + 0.5) / resolution * np.pi - np.pi / 2
    phi = (np.arange(2 * resolution) + 0.5) / (2 * resolution) * 2 * np.pi - np.pi
    values = LUMINANCE @ bsdf.eval_columns(_directions(*np.meshgrid(theta, phi, indexing="ij")))["value"]
    shown = np.log10(np.maximum(values, max(float(values.max()), 1e-30) * 1e-6)).reshape(resolution, -1)
    image = axes.imshow(shown, origin="lower", extent=(-180, 180, -90, 90), cmap="magma")
    axes.set(xlabel="phi_i, degrees", ylabel="theta_i, degrees", xticks=range(-180, 181, 90), yticks=range(-90, 91, 45))
    axes.figure.colorbar(image, ax=axes, label="log10 S", shrink=0.6)
    return axes
