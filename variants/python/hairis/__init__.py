"""Hair scattering for renderers and notebooks: many directions at a time, with NumPy arrays in and out.

>>> hair = hairis.Material("gaussian", "brown", sampler="matched")
>>> bsdf = hair.prepare(wo=(0.6, 0.0, 0.8))
>>> samples = bsdf.sample_columns(np.random.default_rng(1).random((3, 1000), np.float32))
>>> samples["weight"].shape
(3, 1000)

Directions point away from the fibre, in its frame: u runs along the fibre from root to tip, and v and w lie across it. `wo` points
towards the viewer and `wi` towards the light. Columns are float32 of shape (3, N) or (N,), C-contiguous and aligned; nothing is
converted. Calls release the interpreter's lock, so that the caller may run them in threads of its own.
"""

from ._hairis import Bsdf, Material, level, models

__all__ = ["Bsdf", "Material", "level", "models"]
