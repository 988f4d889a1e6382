"""Recovers colour, width and tilt of hair from a picture, with Mitsuba 3: mitsuba_fit.py PICTURE [SEED]"""
import sys

import drjit as dr
import mitsuba as mi
import numpy as np

mi.set_variant("cuda_ad_rgb", "llvm_ad_rgb")
import hairis.mitsuba  # noqa: E402, F401

picture, seed = sys.argv[1], int((sys.argv + ["0"])[2])
strands = [[f"{x} {2.8 * y + 0.6 * np.sin(x + 6 * z)} {z} 0.1" for x in np.linspace(-7, 7, 24)] for y, z in np.random.default_rng(1).uniform(-1, 1, (60, 2))]
with open(picture + ".txt", "w") as file:  # the last curve is far away: a ray that meets its very end crashes Mitsuba 3.9.1
    file.write("\n\n".join("\n".join(strand) for strand in [*strands, [f"0 0 {z} 1e-4" for z in range(-994, -990)]]))
bsdf = dict(type="hairis", model="chiang", beta_m=0.25, tilt=0.1, sigma_a=[0.2, 0.4, 0.8])
scene = {f"lamp{i}": dict(type="directional", direction=[u, -1, -1], irradiance=dict(type="rgb", value=3.0)) for i, u in enumerate((-1, 0.3, 2))}
scene |= dict(hair=dict(type="bsplinecurve", filename=picture + ".txt", bsdf=bsdf), sky=dict(type="constant", radiance=dict(type="rgb", value=0.2)))
view = dict(type="perspective", fov=36, film=dict(type="hdrfilm", width=64, height=40), to_world=mi.ScalarTransform4f().look_at([0, 0, 14], [0, 0, 0], [0, 1, 0]))
scene = mi.load_dict(dict(type="scene", integrator=dict(type="prb", max_depth=4), view=view, **scene))
params, target, pictures, adam = mi.traverse(scene), mi.render(scene, spp=512, seed=9999), [], mi.ad.Adam(lr=0.02)
rates, hidden = {"hair.bsdf.sigma_a": 0.05, "hair.bsdf.beta_m": 0.03, "hair.bsdf.tilt": 0.01}, {key: np.array(value).ravel() for key, value in params if "bsdf" in key}
adam["hair.bsdf.sigma_a"], adam["hair.bsdf.beta_m"], adam["hair.bsdf.tilt"] = mi.Color3f(0.5), mi.Float(0.4), mi.Float(0)
for k in range(141):
    params.update(adam)
    pictures += [mi.render(scene, params, spp=512, seed=9998)] if k in (0, 140) else []
    dr.backward(dr.mean(dr.square((mi.render(scene, params, spp=16, seed=1000 * seed + k) - target) / (target + 0.1)), axis=None))
    adam.set_learning_rate({key: rate * (1 + np.cos(np.pi * k / 140)) / 2 for key, rate in rates.items()})
    adam.step()
print(*(f"{key}: {np.ravel(adam[key])}, hidden {hidden[key]}" for key in rates), sep="\n")
mi.util.write_bitmap(picture, np.hstack([np.array(part)[..., :3] for part in (*pictures, target)]), write_async=False)
