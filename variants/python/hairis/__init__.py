"""Hair scattering for renderers and notebooks: many directions at a time, NumPy in and out.

>>> hair = hairis.Material("gaussian", "brown", sampler="matched")
>>> bsdf = hair.prepare(wo=(0.6, 0.0, 0.8))
>>> samples = bsdf.sample_columns(np.random.default_rng(1).random((3, 1000), np.float32))
>>> samples["weight"].shape
(3, 1000)

Directions point away from the fibre, in its frame: u along it from root to tip, v and w across. `wo` is towards the viewer, `wi`
towards the light. Columns are float32 of shape (3, N) or (N,), C-contiguous and aligned; nothing is converted. Calls release the
interpreter's lock: threads are the caller's.
"""

from ._hairis import Bsdf, Material, level, models

__all__ = ["Bsdf", "Material", "level", "models"]
