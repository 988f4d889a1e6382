"""Hair scattering for renderers and notebooks: many directions at a time, with NumPy arrays in and out.

>>> hair = hairis.Material("gaussian", "brown", sampler="matched")
>>> bsdf = hair.prepare(wo=(0.6, 0.0, 0.8))
>>> bsdf.eval((0, 0.6, 0.8)).shape
(3,)
>>> samples = bsdf.sample(np.random.default_rng(1).random((4, 1000, 3)))
>>> samples["weight"].shape
(4, 1000, 3)

Directions point away from the fibre, in its frame: u runs along the fibre from root to tip, and v and w lie across it. `wo` points
towards the viewer and `wi` towards the light. `eval`, `pdf`, `eval_pdf` and `sample` take arrays of any shape whose last dimension is the
component, and their shapes broadcast. The calls named after columns and hits are faster: columns are float32 of shape (3, N) or (N,),
C-contiguous and aligned, and nothing is converted. Calls release the interpreter's lock, so that the caller may run them in threads.

`hairis.torch`, `hairis.jax` and `hairis.drjit` have these calls over arrays of a framework, which differentiates them, and `hairis.mitsuba` is a
BSDF of Mitsuba 3. Each is imported by its name.
"""

from ._hairis import Bsdf, Material, level, models

__all__ = ["Bsdf", "Material", "level", "models"]
