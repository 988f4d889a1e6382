"""The plugin's pixels against the wheel: a straight strand under a directional light, then in a furnace. pixels.py PLUGINS, the folder
that build.sh wrote, whose name must be "plugins"; files go to the working directory."""

import pathlib
import sys

import hairis
import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
# Mitsuba looks for plugins/hairis.so.
mi.file_resolver().append(str(pathlib.Path(sys.argv[1]).resolve().parent))
T = mi.ScalarTransform4f

# The strand, and a curve far away: Mitsuba 3.9.1 reads past the control points where a ray hits the very end of the last curve.
strand = "\n".join(f"{x:g} 0 0 0.5" for x in np.linspace(-40, 40, 33))
far = "\n".join(f"0 0 {-500 - 0.1 * i:g} 1e-4" for i in range(4))
with open("strand.txt", "w") as file:
    file.write(f"{strand}\n\n{far}\n")


def render(bsdf, towards, y, light, integrator, **options):
    scene = mi.load_dict({
        "type": "scene", "integrator": integrator, "light": light,
        "sensor": {
            "type": "orthographic",
            "to_world": T().look_at(origin=list(10 * towards + [0, y, 0]), target=[0, y, 0], up=[0, 1, 0]).scale([5e-5, 5e-5, 1]),
            "film": {"type": "hdrfilm", "width": 4, "height": 4, "rfilter": {"type": "box"}},
            "sampler": {"type": "independent", "sample_count": 1},
        },
        "hair": {"type": "bsplinecurve", "filename": "strand.txt", "bsdf": bsdf},
    })
    return np.array(mi.render(scene, **options))[..., :3].reshape(-1, 3)


def frame_at(towards, y):
    """The fibre's frame where the ray meets the tube, wo in it, and h."""
    normal = np.array([0, y / 0.5, np.sqrt(1 - (y / 0.5) ** 2)])
    u = np.array([1.0, 0, 0])
    frame = np.array([u, normal, np.cross(u, normal)])
    wo = frame @ towards
    return frame, wo, float(wo[2] / np.hypot(wo[1], wo[2]))


def view(degrees):
    return np.array([np.sin(np.radians(degrees)), 0, np.cos(np.radians(degrees))])


def main():
    entries = [(name, word) for name, model in hairis.models().items() for word in (model["choices"] or [None])]
    ratios, furnaces = [], []
    white = {"type": "rgb", "value": 1.0}
    for name, word in entries:
        choice = {hairis.models()[name]["choice"]: word} if word else {}
        properties = {"type": "hairis", "model": name, **({"choice": word} if word else {})}
        blond = hairis.Material(name, "blond", energy="raw", **choice)
        for degrees in (0, 30, -55):
            towards = view(degrees)
            for y in (0, 0.2, -0.35):
                frame, wo, h = frame_at(towards, y)
                bsdf = blond.prepare(wo, h)
                for theta, phi in ((0, 0), (-30, 60), (-45, 80), (20, -30), (60, -50)):
                    theta, phi = np.radians((theta, phi))
                    light = np.array([np.sin(theta), np.cos(theta) * np.sin(phi), np.cos(theta) * np.cos(phi)])
                    if frame[1] @ light < 0.05:
                        continue  # lit from behind: the tube shadows itself
                    emitter = {"type": "directional", "direction": list(-light), "irradiance": white}
                    pixels = render({**properties, "preset": "blond", "energy": "raw"}, towards, y, emitter, {"type": "path", "max_depth": 2})
                    wi = np.float32(frame @ light)
                    value = bsdf.eval_columns(wi[:, None].copy())["value"][:, 0] * np.hypot(wi[1], wi[2])
                    ratios.append(pixels.mean(0) / value)
        for energy in ("raw", "conserving"):
            for degrees in (0, 60, 80):
                towards = view(degrees)
                _, wo, h = frame_at(towards, 0)
                albedo = np.sum(list(hairis.Material(name, "white", energy=energy, **choice).prepare(wo, h).albedo().values()), axis=0)
                integrator = {"type": "direct", "emitter_samples": 0, "bsdf_samples": 1}
                pixels = render({**properties, "preset": "white", "energy": energy}, towards, 0, {"type": "constant", "radiance": white},
                                integrator, spp=4096, seed=3)
                furnaces.append(abs(pixels.mean(0)[0] / albedo[0] - 1))
    ratios = np.array(ratios)
    print(f"{len(ratios)} pixels, Mitsuba over hairis: {ratios.min():.6f} to {ratios.max():.6f}")
    print(f"furnace over albedo: worst of {len(furnaces)} off by {100 * max(furnaces):.2f}%")
    return abs(ratios - 1).max() < 1e-4 and max(furnaces) < 3e-3


sys.exit(0 if main() else 1)
