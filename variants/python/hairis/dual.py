"""Dual scattering, after Zinke et al. 2008: light that many hairs scattered, for renderers that follow no paths.

>>> dual = hairis.dual.material("chiang", "blond")
>>> crossed = dual.depth(0.0, 2.5)
>>> single = hairis.Material("chiang", "blond").eval((0, 0, 1), (0, 1, 0))
>>> red, green, blue = dual.shade((0, 0, 1), (0, 1, 0), single, crossed)
>>> bool(red > blue > 0)
True

The functions take arrays of NumPy, Dr.Jit, JAX or PyTorch, which differentiates them. Vectors are arrays whose first index is the component.
Directions are of unit length, in the fibre's frame; angles are radians. The chapter `dual_scattering` of the documentation of `hairis`
has the formulas.
"""

from __future__ import annotations

from typing import Any

from . import Material
from ._arrays import compiled
from ._hairis import dual_program

__all__ = ["GAIN", "DualScattering", "material"]

# Array of a framework, or numbers.
Array = Any
GAIN = 1.15


class DualScattering:
    """Averages of the light that a material's fibres scatter, which `material` measures in tens of milliseconds.

    `coefficients` has 8 quantities of 3 channels of 10 powers in a row: polynomials of the inclination over a right angle, of the albedos, mean
    shifts and variances of light that goes on and that goes back, and of two terms of the azimuth.
    """

    def __init__(self, of: Material) -> None:
        source, self.coefficients = dual_program(of)
        self._program = compiled(source, "hairis.dual_scattering")
        self._averages = self._program.Material(tuple(self.coefficients))

    def strands(self, theta_i: Array, count: Array, framework: Any = None) -> Any:
        """Returns light that crossed `count` fibres, which are inclined to it by `theta_i`: a tuple of the share that met none, the
        shares that came through, red, green and blue, and the mean and variance of the shift of its inclination."""
        return self._program.strands(self._averages, theta_i, count, framework)

    def depth(self, theta_i: Array, depth: Array, framework: Any = None) -> Any:
        """Returns light that came through an optical depth, the mean number of fibres on its way, as `strands` returns it."""
        return self._program.depth(self._averages, theta_i, depth, framework)

    def shade(self, wo: Array, wi: Array, single: Array, crossed: Any, gain: tuple[float, float] = (GAIN, GAIN), framework: Any = None) -> Any:
        """Returns the light from `wi` to the viewer in place of `single`, the value of one scattering, per steradian. `crossed` comes from
        `strands` or `depth`, and `gain` holds factors on light that crossed fibres and on light that comes back from those behind."""
        return self._program.shade(self._averages, wo, wi, single, crossed, gain[0], gain[1], framework).value


def material(model: str | Material = "gaussian", preset: str | None = None, **fields: Any) -> DualScattering:
    """Measures a material, given as `hairis.Material` is, or that material itself."""
    return DualScattering(model if isinstance(model, Material) else Material(model, preset, **fields))
