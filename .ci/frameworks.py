#!/usr/bin/env python3
"""Promise: models printed for Python have the accuracy of one lane in NumPy, JAX, PyTorch and Dr.Jit, and their derivatives are the wheel's.

  frameworks.py HAIRIS [FRAMEWORK...]     frameworks: numpy drjit torch jax; by default those that are installed

Needs the program hairis with hairis-shader, NumPy, the wheel, and the frameworks. For every model and sampler of the wheel prints
quantiles of errors against `hairis eval --path f64`, which are relative where the number is above 1e-8, for values and densities, for
samples by the same numbers (distance of the direction), and of derivatives by every field and direction against the wheel's. The hostile
set has poles, lobes without intensity, grazing hits and what is no direction: no result and no derivative of it may be infinite or NaN.
The wheel must have the same source.

HAIRIS_MATERIALS=20 and HAIRIS_HITS=10000 are the counts of random materials, and of hits of each.
"""

from __future__ import annotations

import importlib
import importlib.util
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from typing import Any, NamedTuple

import hairis
import numpy as np
from hairis._hairis import program as source_of

MATERIALS, HITS = int(os.environ.get("HAIRIS_MATERIALS", 20)), int(os.environ.get("HAIRIS_HITS", 10_000))
GRADIENTS = min(HITS, 200)
# All have a bound but the largest error: a number next to a choice may take the other branch.
QUANTILES = [0.5, 0.99, 0.999, 1.0]
DERIVATIVES = [1e-6, 2e-4, 1e-3]
rng = np.random.default_rng(65)
failures: list[str] = []


def columns(rows: Any) -> Any:
    return np.ascontiguousarray(np.asarray(rows, np.float32).T)


def directions(n: int) -> Any:
    v = rng.normal(size=(3, n))
    return np.ascontiguousarray(v / np.linalg.norm(v, axis=0), np.float32)


class Hits(NamedTuple):
    """Hits with a material each: index of the material, and columns."""

    of: Any
    wo: Any
    h: Any
    wi: Any
    xi: Any


class Subject(NamedTuple):
    """A model of the wheel, with its module of an arithmetic."""

    name: str
    choice: dict[str, str]
    module: Any

    def material(self, random: bool) -> hairis.Material:
        """Draws a material: a preset whose numbers are moved, or one with edges of the ranges."""
        model = hairis.models()[self.name]
        preset = hairis.Material(self.name, str(rng.choice(model["presets"])), energy="raw", **self.choice)
        fields: dict[str, Any] = {}
        for name, value in preset.fields.items():
            field = model["fields"][name]
            if isinstance(value, str):
                words = list(field["labels"])
                fields[name] = str(rng.choice(words)) if words else value
                continue
            low, high = field["range"]
            numbers = np.atleast_1d(np.asarray(value, np.float64))
            moved = numbers * np.exp(rng.uniform(-0.7, 0.7, numbers.shape)) + rng.uniform(-0.01, 0.01, numbers.shape)
            # Not at the ends of the ranges, where a derivative has one side.
            numbers = np.where((low < moved) & (moved < high), moved, numbers)
            # Zero intensities, and the ends of the ranges.
            edge = rng.random(numbers.shape) < (0.0 if random else 0.4)
            ends = np.where(rng.random(numbers.shape) < 0.7, low, min(high, 10 * abs(numbers).max() + 1))
            numbers = np.clip(np.where(edge, ends, numbers), low, high).astype(np.float32)
            fields[name] = numbers.tolist() if field["kind"] != "number" else float(numbers[0])
        return hairis.Material(self.name, energy="raw", **self.choice, **fields)

    def params(self, materials: list[hairis.Material]) -> Any:
        """Returns the parameters of all materials as a row per number of the module's Params."""
        rows = []
        for material in materials:
            row: list[float] = []
            for field, value in zip(self.module.Params._fields, self.numbers(material)):
                row += value
            rows.append(row)
        return columns(rows)

    def numbers(self, material: hairis.Material) -> list[list[float]]:
        fields, described = material.fields, hairis.models()[self.name]["fields"]
        values = []
        for name in self.module.Params._fields:
            value: Any = fields[name]
            if isinstance(value, str):
                value = described[name]["labels"].index(value)
            values.append(list(np.atleast_1d(np.asarray(value, np.float64))))
        return values


def printed(program: str, name: str, choice: dict[str, str], *flags: str) -> str:
    """Returns the source that `hairis shader` prints."""
    words = [part for word in choice.values() for part in ("--sampler", word)]
    command = [program, "shader", "--model", name, "--target", "python", *words, *flags]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def subjects(program: str, folder: str) -> Iterator[dict[str, Subject]]:
    """Yields the models of the wheel, each by arithmetic."""
    for name, model in hairis.models().items():
        for word in model["choices"] or [None]:
            choice, found = {} if word is None else {model["choice"]: word}, {}
            for arithmetic in ("gpu-native", "exact"):
                file = f"{name}_{word}_{arithmetic}".replace("-", "_")
                with open(os.path.join(folder, file + ".py"), "w") as out:
                    out.write(printed(program, name, choice, "--arithmetic", arithmetic))
                found[arithmetic] = Subject(name, choice, importlib.import_module(file))
            calls = [part for call in ("material", "eval_hit", "sample_hit") for part in ("--call", call)]
            if printed(program, name, choice, *calls) != source_of(hairis.Material(name, **choice))[0]:
                failures.append(f"{name} {word}: the wheel's source is not that of hairis shader")
            yield found


def asked(program: str, path: str, materials: list[hairis.Material], hits: Hits, query: str) -> Any:
    """Returns answers of `hairis eval`: rows of value, density and, for samples, direction, weight and whether there is one."""
    bases = [json.loads(material.to_json()) for material in materials]
    lines = []
    for i, of in enumerate(hits.of):
        request = {**bases[of], "wo": hits.wo[:, i].tolist(), query: getattr(hits, query)[:, i].tolist()}
        if hairis.models()[request["model"]]["near_field"]:
            request["h"] = float(hits.h[i])
        lines.append(json.dumps(request))
    run = subprocess.run([program, "eval", "--path", path], input="\n".join(lines), capture_output=True, text=True)
    rows = []
    for line in run.stdout.splitlines():
        answer = json.loads(line)
        row = [*answer["s"], answer["pdf"]]
        if query == "xi":
            row += [*answer["wi"], *answer["weight"], answer["lobe"] is not None]
        rows.append(row)
    return np.asarray(rows).T


class Numpy:
    """Framework of the arrays, by which results and derivatives are computed."""

    name = "numpy"
    differentiates = False

    def arrays(self, numbers: Any) -> list[Any]:
        return list(numbers)

    def call(self, function: Any, numbers: Any) -> Any:
        return np.stack([self.read(x) for x in function(*self.arrays(numbers))])

    def read(self, x: Any) -> Any:
        return np.asarray(x)


class Torch(Numpy):
    name = "torch"
    differentiates = True

    def __init__(self) -> None:
        self.torch = importlib.import_module("torch")

    def arrays(self, numbers: Any) -> list[Any]:
        return [self.torch.tensor(x) for x in numbers]

    def read(self, x: Any) -> Any:
        return x.detach().numpy()

    def gradient(self, function: Any, numbers: Any, weights: Any) -> tuple[Any, Any]:
        inputs = [x.requires_grad_() for x in self.arrays(numbers)]
        results = function(*inputs)
        sum(((x * w).sum() for x, w in zip(results, self.arrays(weights))), self.torch.tensor(0.0)).backward()
        gradients = [np.zeros_like(x.detach()) if x.grad is None else x.grad.numpy() for x in inputs]
        return np.stack([self.read(x) for x in results]), np.stack(gradients)


class Jax(Numpy):
    name = "jax"
    differentiates = True

    def __init__(self) -> None:
        self.jax = importlib.import_module("jax")

    def arrays(self, numbers: Any) -> list[Any]:
        return [self.jax.numpy.asarray(x) for x in numbers]

    def call(self, function: Any, numbers: Any) -> Any:
        return np.stack(self.jax.jit(lambda *x: list(function(*x)))(*self.arrays(numbers)))

    def gradient(self, function: Any, numbers: Any, weights: Any) -> tuple[Any, Any]:
        def loss(inputs: Any, weights: Any) -> Any:
            results = list(function(*inputs))
            return sum((x * w).sum() for x, w in zip(results, weights)), results

        if getattr(self, "function", None) is not function:
            self.function = function
            self.compiled = self.jax.jit(self.jax.value_and_grad(loss, has_aux=True))
        (_, results), gradients = self.compiled(self.arrays(numbers), self.arrays(weights))
        return np.stack(results), np.stack(gradients)


class DrJit(Numpy):
    name = "drjit"
    differentiates = True

    def __init__(self) -> None:
        self.dr = importlib.import_module("drjit")
        self.float = importlib.import_module("drjit.llvm.ad").Float

    def arrays(self, numbers: Any) -> list[Any]:
        return [self.float(np.ascontiguousarray(x)) for x in numbers]

    def call(self, function: Any, numbers: Any) -> Any:
        results = list(function(*self.arrays(numbers)))
        self.dr.eval(results)
        return np.stack([np.broadcast_to(x.numpy(), numbers.shape[1:]) for x in results])

    def gradient(self, function: Any, numbers: Any, weights: Any) -> tuple[Any, Any]:
        inputs = self.arrays(numbers)
        self.dr.enable_grad(inputs)
        results = list(function(*inputs))
        self.dr.backward(sum((x * w for x, w in zip(results, self.arrays(weights))), self.float(0.0)))
        gradients = [self.dr.grad(x) for x in inputs]
        values = [self.dr.detach(x) for x in results]
        self.dr.eval(gradients, values)
        shape = numbers.shape[1:]
        both = [np.stack([np.broadcast_to(x.numpy(), shape) for x in part]) for part in (values, gradients)]
        return both[0], both[1]


def calls(subject: Subject) -> tuple[Any, Any]:
    """Returns evaluation and sampling as functions of rows: parameters, wo, h, and wi or xi."""
    module, sizes = subject.module, subject.module._SIZES[subject.module.Params]

    def split(rows: tuple[Any, ...]) -> tuple[Any, Any, Any, Any]:
        numbers = iter(rows)
        params = module.Params(*(tuple(next(numbers) for _ in range(size)) if size else next(numbers) for size in sizes))
        *wo, h, a, b, c = numbers
        return module.material(params), tuple(wo), h, (a, b, c)

    def evaluate(*rows: Any) -> list[Any]:
        e = module.eval_hit(*split(rows))
        return [*e.value, e.pdf]

    def draw(*rows: Any) -> list[Any]:
        s = module.sample_hit(*split(rows))
        return [*s.value, s.pdf, *s.wi, *s.weight, s.slot]

    return evaluate, draw


def report(what: str, errors: Any, bounds: Any = None) -> Any:
    """Prints quantiles of errors and returns them. Notes a failure where one is above its bound."""
    found = np.quantile(errors, QUANTILES)
    print(f"    {what:20} " + " ".join(f"{x:8.1e}" for x in found), f"of {len(errors)}", flush=True)
    if bounds is not None and any(x > most for x, most in zip(found[:3], bounds)):
        failures.append(f"{what}: {found[:3]} must be below {np.asarray(bounds[:3])}")
    return found


def errors(evaluated: Any, drawn: Any, answers: Any) -> dict[str, Any]:
    """Returns the errors of values, densities, directions and weights, where neither side discards the sample."""
    both = (drawn[10] >= 0) & (answers["xi"][10] > 0)
    return {
        "value": relative(evaluated[:3], answers["wi"][:3]),
        "density": relative(evaluated[3], answers["wi"][3]),
        "sample": np.linalg.norm(drawn[4:7, both] - answers["xi"][4:7, both], axis=0),
        "weight": relative(drawn[7:10, both], answers["xi"][7:10, both]),
    }


def relative(got: Any, exact: Any) -> Any:
    is_large = exact > 1e-8
    return abs(got[is_large] / exact[is_large] - 1)


def hostile(count: int) -> Hits:
    """Returns hits at the edges: poles and next to them, axes, grazing, and what is no direction or random number."""
    axes = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1)]
    near = [(s, a, b) for s in (1, -1) for k in (4, 12, 20, 60) for a, b in ((2.0**-k, 0), (0, -(2.0**-k)), (-(2.0**-k), 2.0**-k))]
    other = [(np.nan, 0, 1), (np.inf, 0, 0), (0, 0, 0), (0, -np.inf, 1)]
    some = directions(8).T.tolist()
    set_of = np.asarray([*axes, *near, *other, *some], np.float32)
    length = np.linalg.norm(set_of[: len(axes) + len(near)], axis=1, keepdims=True)
    set_of[: len(length)] /= length
    pairs = np.stack(np.meshgrid(np.arange(len(set_of)), np.arange(len(set_of)))).reshape(2, -1)
    n = pairs.shape[1]
    h = rng.choice(np.float32([0, -1, 1, 0.99999994, 0.5, 2, np.nan]), n, p=[0.3, 0.15, 0.15, 0.1, 0.2, 0.05, 0.05])
    xi = rng.choice(np.float32([0, 0.25, 0.5, 0.99999994, 1e-9, 1, np.nan]), (3, n), p=[0.2, 0.2, 0.2, 0.2, 0.1, 0.05, 0.05])
    return Hits(np.arange(n) % count, columns(set_of[pairs[0]]), h, columns(set_of[pairs[1]]), xi)


def check(subject: Subject, host: Any, random: Any, edges: Any, answers: Any, lane: Any) -> None:
    evaluate, draw = calls(subject)
    materials, hits = random
    params = subject.params(materials)
    started = time.time()

    def rows(params: Any, hits: Hits, last: Any) -> Any:
        return np.concatenate([params[:, hits.of], hits.wo, hits.h[None], last])

    evaluated, drawn = (host.call(call, rows(params, hits, last)) for call, last in ((evaluate, hits.wi), (draw, hits.xi)))
    for what, found in errors(evaluated, drawn, answers).items():
        report(f"{host.name}: {what}", found, 2 * lane[what] + 1e-6)
    other = int(np.sum((drawn[10] >= 0) != (answers["xi"][10] > 0)))
    if other > 1e-3 * len(drawn[10]):
        failures.append(f"{host.name}: {other} of {len(drawn[10])} samples are discarded, or not, against the formulas")
    worst = hostile(len(edges))
    extreme = subject.params(edges)
    numbers = [rows(extreme, worst, last) for last in (worst.wi, worst.xi)]
    if host.differentiates:
        few = Hits(*(np.ascontiguousarray(x[..., :: max(1, HITS // GRADIENTS)]) for x in hits))
        weights = rng.uniform(-1, 1, (4, len(few.of))).astype(np.float32)
        weights[3] = 0
        inputs = rows(params, few, few.wi)
        # The calls of both sets have one shape, for which a compiler runs once.
        n = max(inputs.shape[1], numbers[0].shape[1])
        fit = lambda a: np.resize(a.T, (n, a.shape[0])).T.copy()
        _, gradient = host.gradient(evaluate, fit(inputs), fit(weights))
        derivatives(subject, host, materials, few, inputs, weights, gradient[:, : inputs.shape[1]])
        for function, inputs, count in ((evaluate, fit(numbers[0]), 4), (draw, fit(numbers[1]), 11)):
            weights = rng.uniform(-1, 1, (count, n)).astype(np.float32)
            values, gradient = host.gradient(function, inputs, weights)
            finite(host, function.__name__, inputs, values, gradient)
    else:
        for function, inputs in zip((evaluate, draw), numbers):
            finite(host, function.__name__, inputs, host.call(function, inputs), np.zeros(0))
    print(f"    {host.name}: {numbers[0].shape[1]} hostile hits, {time.time() - started:.1f} s", flush=True)


def finite(host: Any, name: str, inputs: Any, values: Any, gradient: Any) -> None:
    # A discarded sample has no direction.
    values = np.where(values[10] < 0, 0, values) if len(values) > 10 else values
    for what, numbers in (("results", values), ("derivatives", gradient)):
        bad = np.argwhere(~np.isfinite(numbers))
        if len(bad):
            row, hit = bad[0]
            failures.append(f"{host.name}: {len(bad)} {what} of {name} are not finite, the first of row {row} at {inputs[:, hit].tolist()}")


def derivatives(subject: Subject, host: Any, materials: Any, hits: Hits, inputs: Any, weights: Any, gradient: Any) -> None:
    """Compares with the wheel's derivatives, hit by hit."""
    sizes = [max(size, 1) for size in subject.module._SIZES[subject.module.Params]]
    distances = []
    for i, of in enumerate(hits.of):
        one = lambda a: np.ascontiguousarray(a[..., i : i + 1])
        hit, fields = materials[of].eval_grad(one(hits.wo), one(hits.wi), one(weights[:3]), one(hits.h))
        expected = []
        for name, size in zip(subject.module.Params._fields, sizes):
            value: Any = fields.get(name, np.nan)
            expected += np.broadcast_to(np.atleast_1d(np.asarray(np.nan if isinstance(value, str) else value, float)), size).tolist()
        expected = np.asarray([*expected, *hit["d_wo"][:, 0], hit["d_h"][0], *hit["d_wi"][:, 0]])
        # Relative to at least a thousandth of the loss for a change of the whole argument, as in the tests of gradients.
        loss = float(abs(hit["value"][:, 0] * weights[:3, i]).sum())
        least = 1e-3 * loss / np.maximum(abs(inputs[:, i]), 1e-2)
        scale = np.maximum(np.maximum(abs(expected), least), 1e-30)
        distances.append((abs(gradient[:, i] - expected) / scale)[~np.isnan(expected)])
    report(f"{host.name}: derivative", np.concatenate(distances), DERIVATIVES)


def main() -> None:
    program, *names = sys.argv[1:]
    known = {host.name: host for host in (Numpy, DrJit, Torch, Jax)}
    hosts = [known[name]() for name in names or known if names or importlib.util.find_spec(name)]
    print(f"{', '.join(host.name for host in hosts)}; quantiles of errors: {', '.join(str(q) for q in QUANTILES)}")
    with tempfile.TemporaryDirectory() as folder:
        sys.path.insert(0, folder)
        for found in subjects(program, folder):
            subject = found["exact"]
            print(subject.name, *subject.choice.values())
            random = [subject.material(True) for _ in range(MATERIALS)]
            edges = [subject.material(False) for _ in range(97)]
            n = MATERIALS * HITS
            h, xi = rng.uniform(-1, 1, n).astype(np.float32), rng.random((3, n), np.float32)
            hits = Hits(np.arange(n) % MATERIALS, directions(n), h, directions(n), xi)
            answers, lane = ({query: asked(program, path, random, hits, query) for query in ("wi", "xi")} for path in ("f64", "scalar"))
            lane["xi"][10] -= 1
            of_lane = {what: report(f"one lane: {what}", found) for what, found in errors(lane["wi"], lane["xi"], answers).items()}
            for arithmetic, subject in found.items():
                print("  " + arithmetic)
                for host in hosts:
                    before = len(failures)
                    check(subject, host, (random, hits), edges, answers, of_lane)
                    failures[before:] = [f"{subject.name} {arithmetic} {failure}" for failure in failures[before:]]
    for failure in failures:
        print("FAIL", failure)
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
