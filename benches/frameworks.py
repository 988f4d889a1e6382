#!/usr/bin/env python3
"""Writes times of hits in frameworks of arrays, from one run, as a record: frameworks.py > benches/records/frameworks.csv

Evaluates value and density, or draws a sample, of hits that each have two directions of their own, in one thread: Mitsuba's plugin
`hair`, the BSDF of hairis.mitsuba, hairis.drjit on LLVM, hairis.torch and hairis.jax on the CPU, and columns of NumPy, which are slices of
the library. Contenders take turns. A time is the processor time of the process, in ns per hit, tracing included.

Needs the wheel, mitsuba, and jax and torch where they are installed; DRJIT_LIBLLVM_PATH as Dr.Jit does. HAIRIS_ROUNDS=11 and
HAIRIS_HITS=4194304 are the counts.
"""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
import time
from collections.abc import Callable
from datetime import date
from importlib.metadata import version
from typing import Any

os.environ["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"
ROUNDS, HITS = int(os.environ.get("HAIRIS_ROUNDS", 11)), int(os.environ.get("HAIRIS_HITS", 1 << 22))

import drjit as dr  # noqa: E402
import mitsuba as mi  # noqa: E402
import numpy as np  # noqa: E402

mi.set_variant("llvm_ad_rgb")
dr.set_thread_count(1)
import hairis  # noqa: E402
import hairis.drjit  # noqa: E402
import hairis.mitsuba  # noqa: E402

MODELS = {"gaussian": "published", "gaussian matched": "matched", "chiang": "mean"}
rng = np.random.default_rng(65)


def directions() -> Any:
    v = rng.normal(size=(3, HITS))
    return np.ascontiguousarray(v / np.linalg.norm(v, axis=0), np.float32)


WO, WI, XI = directions(), directions(), rng.random((3, HITS), np.float32)
Contender = tuple[str, str, str, Callable[[], Any]]


def numpy_contenders(model: str, material: hairis.Material) -> list[Contender]:
    evaluated, drawn = material.eval_hits(WO, WI), material.sample_hits(WO, XI)
    return [
        ("NumPy", model, "eval_pdf", lambda: material.eval_hits(WO, WI, out=evaluated)),
        ("NumPy", model, "sample", lambda: material.sample_hits(WO, XI, out=drawn)),
    ]


def drjit_contenders(model: str, material: hairis.Material) -> list[Contender]:
    hair = hairis.drjit.material(material)
    wo, wi, xi = (mi.Vector3f(*columns) for columns in (WO, WI, XI))

    def run(call: Callable[..., Any], last: Any) -> None:
        dr.eval(call(wo, last))
        dr.sync_thread()

    return [
        ("Dr.Jit", model, "eval_pdf", lambda: run(hair.eval_pdf, wi)),
        ("Dr.Jit", model, "sample", lambda: run(hair.sample, xi)),
    ]


def mitsuba_contenders(name: str, model: str, plugin: dict[str, Any]) -> list[Contender]:
    bsdf, context = mi.load_dict(plugin), mi.BSDFContext()
    si = dr.zeros(mi.SurfaceInteraction3f, HITS)
    si.wi, si.uv = mi.Vector3f(*WO), mi.Point2f(0.3, 0.5)
    wi, one, two = mi.Vector3f(*WI), mi.Float(XI[0]), mi.Point2f(*XI[1:])
    dr.eval(si, wi, one, two)

    def run(results: Any) -> None:
        dr.eval(results)
        dr.sync_thread()

    return [
        (name, model, "eval_pdf", lambda: run(bsdf.eval_pdf(context, si, wi))),
        (name, model, "sample", lambda: run(bsdf.sample(context, si, one, two))),
    ]


def torch_contenders(model: str, material: hairis.Material) -> list[Contender]:
    import hairis.torch
    import torch

    torch.set_num_threads(1)
    hair = hairis.torch.material(material)
    wo, wi, xi = (torch.from_numpy(columns).T for columns in (WO, WI, XI))
    return [
        ("PyTorch", model, "eval_pdf", lambda: hair.eval_pdf(wo, wi)),
        ("PyTorch", model, "sample", lambda: hair.sample(wo, xi)),
    ]


def jax_contenders(model: str, material: hairis.Material) -> list[Contender]:
    import hairis.jax
    import jax

    hair = hairis.jax.material(material)
    wo, wi, xi = (jax.numpy.asarray(columns.T) for columns in (WO, WI, XI))
    eval_pdf, sample = jax.jit(hair.eval_pdf), jax.jit(hair.sample)
    return [
        ("JAX", model, "eval_pdf", lambda: jax.block_until_ready(eval_pdf(wo, wi))),
        ("JAX", model, "sample", lambda: jax.block_until_ready(sample(wo, xi))),
    ]


def contenders() -> list[Contender]:
    found = mitsuba_contenders("Mitsuba's hair", "chiang", {"type": "hair"})
    for model, word in MODELS.items():
        name = model.split()[0]
        choice: dict[str, Any] = {hairis.models()[name]["choice"]: word}
        material = hairis.Material(name, "brown", energy="raw", **choice)
        found += numpy_contenders(model, material) + drjit_contenders(model, material)
        plugin = {"type": "hairis", "model": name, "preset": "brown", "choice": word}
        found += mitsuba_contenders("hairis.mitsuba", model, plugin)
        for framework, more in (("torch", torch_contenders), ("jax", jax_contenders)):
            if importlib.util.find_spec(framework):
                found += more(model, material)
    return found


def facts_of_processor() -> dict[str, str]:
    with open("/proc/cpuinfo") as file:
        return dict(map(str.strip, line.split(":", 1)) for line in file.read().split("\n\n")[0].splitlines() if ":" in line)


def processor(facts: dict[str, str]) -> str:
    return f"{facts['model name']} family {facts['cpu family']} model {facts['model']} stepping {facts['stepping']}"


def main() -> None:
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    packages = [f"{name} {version(name)}" for name in ("numpy", "mitsuba", "drjit", "jax", "torch") if importlib.util.find_spec(name)]
    facts = facts_of_processor()
    of_llvm = next((name for name in ("avx512f", "avx2") if name in facts["flags"].split()), "sse2")
    llvm = ".".join(map(str, dr.detail.llvm_version()))
    print(f"# CPU: {processor(facts)}\n# commit: {commit}\n# date: {date.today()}")
    print(f"# NumPy, PyTorch and JAX on {hairis.level()}, Dr.Jit and Mitsuba on {of_llvm} by LLVM {llvm}; {', '.join(packages)}")
    load = os.getloadavg()[0]
    print(f"# {ROUNDS} rounds in turns of {HITS} hits in one thread, load average {load:.1f} of {os.cpu_count()} cores")
    print("# ns: processor time per hit, median of the rounds; low, high: quartiles")
    print("contender,model,call,ns,low,high")
    all_of_them = contenders()
    for *_, run in all_of_them:
        run()
    times: list[list[float]] = [[] for _ in all_of_them]
    for round_of_them in range(ROUNDS):
        print(f"round {round_of_them + 1} of {ROUNDS}", file=sys.stderr)
        for (*_, run), found in zip(all_of_them, times):
            started = time.process_time()
            run()
            found.append((time.process_time() - started) / HITS * 1e9)
    for (*names, _), found in zip(all_of_them, times):
        low, median, high = np.quantile(found, [0.25, 0.5, 0.75])
        print(f"{','.join(names)},{median:.2f},{low:.2f},{high:.2f}")


if __name__ == "__main__":
    main()
