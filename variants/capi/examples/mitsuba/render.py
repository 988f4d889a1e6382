"""A tuft of hair by Mitsuba: render.py PICTURE [VARIANT]. VARIANT is scalar_rgb, by the plugin in ./plugins, which is the default, or a JIT
variant, by the class of hair_bsdf.py."""

import sys
import time

import drjit as dr
import mitsuba as mi
import numpy as np

picture, variant = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "scalar_rgb"
mi.set_variant(variant)
if variant.startswith("scalar"):
    mi.file_resolver().append("plugins")
else:
    dr.set_flag(dr.JitFlag.SymbolicLoops, False)
    dr.set_flag(dr.JitFlag.SymbolicCalls, False)
    import hair_bsdf  # noqa: F401

rng = np.random.default_rng(3)
curves = []
for _ in range(400):
    radius, angle = 0.3 * np.sqrt(rng.random()), 2 * np.pi * rng.random()
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    points = [(x * (1 + 0.3 * k) + 0.02 * rng.normal(), y * (1 + 0.3 * k) + 0.02 * rng.normal(), 0.15 * k) for k in range(8)]
    curves.append("\n".join(f"{px:g} {py:g} {pz:g} 0.006" for px, py, pz in points))
curves += ["\n".join(f"0 0 {-500 - 0.1 * k:g} 1e-4" for k in range(4))] * 2  # see README.md
with open("tuft.txt", "w") as file:
    file.write("\n\n".join(curves) + "\n")

T = mi.ScalarTransform4f
scene = mi.load_dict({
    "type": "scene",
    "integrator": {"type": "path", "max_depth": 6},
    "sky": {"type": "constant"},
    "lamp": {
        "type": "rectangle",
        "to_world": T().look_at(origin=[2, -2, 3], target=[0, 0, 0.5], up=[0, 0, 1]).scale(0.5),
        "emitter": {"type": "area", "radiance": {"type": "rgb", "value": 15.0}},
    },
    "sensor": {
        "type": "perspective",
        "fov": 30,
        "to_world": T().look_at(origin=[2, -2.5, 1.5], target=[0, 0, 0.5], up=[0, 0, 1]),
        "film": {"type": "hdrfilm", "width": 192, "height": 192},
        "sampler": {"type": "independent", "sample_count": 16},
    },
    "hair": {
        "type": "bsplinecurve",
        "filename": "tuft.txt",
        "bsdf": {"type": "hairis", "model": "gaussian", "choice": "matched", "preset": "blond"},
    },
})
start = time.perf_counter()
image = np.mean([np.array(mi.render(scene, spp=8, seed=seed))[..., :3] for seed in range(8)], axis=0)
mi.util.write_bitmap(picture, image)
print(f"{picture}: {variant}, mean {image.mean():.4f}, {time.perf_counter() - start:.1f} s")
