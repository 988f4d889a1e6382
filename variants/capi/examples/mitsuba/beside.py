"""The scene of render.py by Mitsuba with the plugin and by hairis-render: beside.py HAIRIS_RENDER PICTURE [SAMPLES]. Prints the mean radiance
of both with standard errors over eight seeds, and how far blocks of 16 x 16 pixels differ. SAMPLES are per pixel and seed."""

import subprocess
import sys

import mitsuba as mi
import numpy as np

import render

SEEDS = 8


def by_hairis_render(program, samples, seed):
    x, y, width, height = render.CROP
    command = [program, "render", "head", "--import", "tuft-lines.txt", "--scale", "1", "--curve", "linear", "--meet", "surface", "--integrator", "path",
               "--hair", "blond", "--energy", "per-wo", "--xi", "independent", "--size", f"{render.SIZE}x{render.SIZE}",
               "--crop", f"{x},{y},{width},{height}", "--spp", str(samples), "--seed", str(seed), "--out", f"tuft-{seed}.exr"]
    subprocess.run(command, check=True, capture_output=True)
    pixels = mi.Bitmap(f"tuft-{seed}.exr")
    channels = [field.name.split(".")[-1] for field in pixels.struct_()]
    return np.array(pixels)[..., [channels.index(name) for name in "RGB"]]


def mean_and_error(values):
    return values.mean(0), values.std(0, ddof=1) / np.sqrt(len(values))


def main():
    program, picture, samples = sys.argv[1], sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 64
    render.set_variant("scalar_rgb")
    scene = render.scene()
    pictures = [
        np.array([np.array(mi.render(scene, spp=samples, seed=seed))[..., :3] for seed in range(SEEDS)]),
        np.array([by_hairis_render(program, samples, seed) for seed in range(1, SEEDS + 1)]),
    ]
    means = [mean_and_error(pixels.mean((1, 2))) for pixels in pictures]
    for name, (mean, error) in zip(("Mitsuba", "hairis-render"), means):
        print(f"{name:<13}", " ".join(f"{m:.6f} ± {e:.6f}" for m, e in zip(mean, error)))
    (mine, my_error), (ours, our_error) = means
    difference, error = ours - mine, np.hypot(my_error, our_error)
    print("difference   ", " ".join(f"{100 * d / m:+.3f}% ± {100 * e / m:.3f}%" for d, m, e in zip(difference, mine, error)))
    _, _, width, height = render.CROP
    blocks = [mean_and_error(pixels.reshape(SEEDS, height // 16, 16, width // 16, 16, 3).mean((2, 4, 5))) for pixels in pictures]
    (a, a_error), (b, b_error) = blocks
    lit = a > 0.1 * a.max()
    scores = (b - a)[lit] / np.hypot(a_error, b_error)[lit]
    print(f"{lit.sum()} blocks with hair: difference over its standard error, root mean square {np.sqrt((scores**2).mean()):.2f}")
    gap = np.ones((height, 4, 3))
    both = np.hstack([pictures[0].mean(0), gap, pictures[1].mean(0)])
    mi.util.write_bitmap(picture, np.float32(both), write_async=False, quality=85)
    # After many scatterings the renderers differ by a tenth of a percent: see beside.md.
    return np.all(np.abs(difference) < 0.001 * mine + 3 * error)


if __name__ == "__main__":
    sys.exit(0 if main() else 1)
