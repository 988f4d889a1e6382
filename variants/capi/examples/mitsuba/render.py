"""A tuft of hair by Mitsuba: render.py PICTURE [VARIANT]. VARIANT is scalar_rgb, by the plugin in ./plugins, which is the default, or a JIT
variant, by the class of hairis.mitsuba, which has energy "raw". Hair goes to two files: tuft.txt has the control points, tuft-lines.txt the same curves as straight
segments for other renderers."""

import sys
import time

import mitsuba as mi
import numpy as np

SIZE = 512
CROP = (88, 112, 336, 256)  # x, y, width, height
SEGMENTS = 20


def set_variant(variant):
    mi.set_variant(variant)
    if variant.startswith("scalar"):
        mi.file_resolver().append(".")  # Mitsuba looks for plugins/hairis.so.
    else:
        import hairis.mitsuba  # noqa: F401


def tuft():
    """Control points of strands as rows x, y, z and radius in cm; y is up. Strands are pointed at both ends, because hairis-render closes
    ends by half spheres, and Mitsuba leaves them open."""
    rng = np.random.default_rng(3)
    t = np.linspace(0, 1, 24)[:, None]
    strands = []
    for _ in range(3000):
        root = 1.8 * np.sqrt(rng.random()) * np.exp(2j * np.pi * rng.random())
        curl = 0.4 * (1 + 0.3 * rng.normal()) * np.exp(1j * (2 * np.pi * (1.7 * t + 0.15 * rng.normal()) + np.angle(root))) * t
        far = root * (1 + 0.8 * t + (0.9 + 0.2 * rng.normal()) * t**2) + curl
        x, y, z = far.real, (13 + rng.normal()) * (t - 0.95 * t**2), far.imag
        strands.append(np.hstack([x, y, z, 0.024 * t * (1 - t)]))
    return strands


def lines(points):
    """A uniform cubic B-spline as segments, so many per span that pictures do not depend on their number."""
    t = np.arange(SEGMENTS)[:, None] / SEGMENTS
    weights = np.hstack([(1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3]) / 6
    end = np.array([[1, 4, 1]]) / 6 @ points[-3:]
    return np.vstack([weights @ points[k : k + 4] for k in range(len(points) - 3)] + [end])


def write(name, strands):
    with open(name, "w") as file:
        file.write("\n\n".join("\n".join("%.9g %.9g %.9g %.9g" % tuple(node) for node in strand) for strand in strands) + "\n")


def scene():
    """The scene `head` of hairis-render for hair from a file: the camera and the lamp follow the extent of the hair."""
    strands = tuft()
    far = [np.array([[0, -500 - 0.1 * k, 0, 1e-4] for k in range(4)])] * 2  # see README.md
    write("tuft.txt", strands + far)
    strands = [lines(points) for points in strands]
    write("tuft-lines.txt", strands)
    nodes = np.vstack(strands)
    least, most = (nodes[:, :3] - nodes[:, 3:]).min(0), (nodes[:, :3] + nodes[:, 3:]).max(0)
    centre, unit = (least + most) / 2, np.linalg.norm(most - least) / 40
    T = mi.ScalarTransform4f
    return mi.load_dict({
        "type": "scene",
        "integrator": {"type": "path"},
        "lamp": {
            "type": "rectangle",
            "to_world": T().translate(list(centre + unit * np.array([0, 30, 10]))).rotate([1, 0, 0], 90).scale(float(20 * unit)),
            "emitter": {"type": "area", "radiance": {"type": "rgb", "value": 6.0}},
        },
        "sensor": {
            "type": "perspective",
            "fov": 42,
            "to_world": T().look_at(origin=list(centre + unit * np.array([0, 9, 52])), target=list(centre), up=[0, 1, 0]),
            "film": {
                "type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"},
                **dict(zip(("crop_offset_x", "crop_offset_y", "crop_width", "crop_height"), CROP)),
            },
            "sampler": {"type": "independent"},
        },
        "hair": {
            "type": "bsplinecurve",
            "filename": "tuft.txt",
            "bsdf": {"type": "hairis", "model": "gaussian", "choice": "matched", "preset": "blond"},
        },
    })


def main():
    picture, variant = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "scalar_rgb"
    set_variant(variant)
    hair = scene()
    start = time.perf_counter()
    image = np.mean([np.array(mi.render(hair, spp=8, seed=seed))[..., :3] for seed in range(4)], axis=0)
    mi.util.write_bitmap(picture, image)
    print(f"{picture}: {variant}, mean {image.mean():.4f}, {time.perf_counter() - start:.1f} s")


if __name__ == "__main__":
    main()
