"""Answers cases of `hairis referee vectors --model chiang` by the BSDF `hair` of Mitsuba 3: mitsuba_hair.py < cases.json > answers.json

Its fibre lies along y, its offset is the sine of the viewer's azimuth from the normal z, and its tilt has the other sign.
"""
import itertools
import json
import sys

import drjit as dr
import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")


def local(directions, azimuth):
    """Directions of our frame, whose fibre lies along the first axis, at this azimuth from the normal."""
    axis, across = directions[:, 0], np.hypot(directions[:, 1], directions[:, 2])
    return mi.Vector3f(across * np.sin(azimuth), axis, across * np.cos(azimuth))


SAMPLES = 1000
random = np.random.default_rng(1)
cases = [json.loads(line) for line in sys.stdin]
for _, scene in itertools.groupby(cases, key=lambda case: case["scene"]):
    scene = list(scene)
    params = scene[0]["params"]
    hair = mi.load_dict({
        "type": "hair", "longitudinal_roughness": params["beta_m"], "azimuthal_roughness": params["beta_n"], "int_ior": params["eta"],
        "ext_ior": 1.0, "scale_tilt": float(-np.degrees(params["tilt"])), "sigma_a": {"type": "rgb", "value": params["sigma_a"]}})
    wo, wi, h = (np.array([case[name] for case in scene]) for name in ("wo", "wi", "h"))
    viewer = np.arcsin(h)
    light = viewer + np.arctan2(wi[:, 2], wi[:, 1]) - np.arctan2(wo[:, 2], wo[:, 1])
    hit = dr.zeros(mi.SurfaceInteraction3f, len(scene))
    # Mitsuba calls the viewer's direction wi, and the light's wo.
    hit.wi = local(wo, viewer)
    value, pdf = hair.eval_pdf(mi.BSDFContext(), hit, local(wi, light))
    answers = [{**case, "value": value, "pdf": pdf} for case, value, pdf in zip(scene, np.array(value).T.tolist(), np.array(pdf).tolist())]
    # The first answer has samples of the shading point.
    hit = dr.zeros(mi.SurfaceInteraction3f, SAMPLES)
    hit.wi = local(np.repeat(wo[:1], SAMPLES, axis=0), viewer[0])
    numbers = [mi.Float(row) for row in random.random((3, SAMPLES))]
    drawn = hair.sample(mi.BSDFContext(), hit, numbers[0], mi.Point2f(*numbers[1:]))[0]
    pdf, (across, axis, normal) = np.array(drawn.pdf), np.array(drawn.wo)
    azimuth = np.arctan2(across, normal) - viewer[0] + np.arctan2(wo[0, 2], wo[0, 1])
    radius = np.hypot(across, normal)
    ours = np.stack([axis, radius * np.cos(azimuth), radius * np.sin(azimuth)], axis=1)
    answers[0]["samples"] = [direction if density > 0 else None for direction, density in zip(ours.tolist(), pdf)]
    for answer in answers:
        print(json.dumps(answer))
