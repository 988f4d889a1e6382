"""Hair over arrays of a framework: what the modules for Dr.Jit, JAX and PyTorch share."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from types import ModuleType
from typing import Any

from . import Material, models
from ._hairis import program

# Array of a framework, or numbers.
Array = Any
Pair = tuple[Array, Array]
Samples = dict[str, Array]
# Results of a sample, in the order of their arrays.
NAMES = ("wi", "value", "pdf", "weight", "lobe")


@lru_cache(None)
def described(model: str) -> dict[str, Any]:
    """Returns the description of a model, of which `models` makes a new one each time."""
    return models()[model]


@lru_cache(None)
def compiled(source: str, name: str) -> Any:
    """Returns the module of a program, which `hairis shader --target python` prints: functions over arrays of any framework."""
    module = ModuleType(name)
    exec(compile(source, name, "exec"), module.__dict__)
    return module


class Model:
    """Material in which some fields are arrays, without these arrays: constant while a function is compiled."""

    def __init__(self, material: Material, names: tuple[str, ...]) -> None:
        source, self.numbers = program(material)
        self.program = compiled(source, f"hairis.{material.model}.{material.choice}")
        self.text = material.to_json()
        # Components of each array, 0 for a number.
        fields = described(material.model)["fields"]
        self.sizes = {name: width(fields[name]) for name in names}
        self.instead_of = {name: fields[name]["instead_of"] for name in names}
        # Fields in place of others, such as colours, are read by the library alone.
        self.needs_library = any(name not in self.program.Params._fields for name in names)
        self.constants_of_numbers: Any = None

    def named(self, fields: Any) -> dict[str, Array]:
        """Returns arrays by the names of their fields."""
        return dict(zip(self.sizes, fields))

    def constants(self, arrays: dict[str, Array], framework: Any) -> Any:
        """Returns the constants of the program, from arrays whose first index is the component."""
        if not arrays and self.constants_of_numbers is not None:
            return self.constants_of_numbers
        params, numbers = self.program.Params, iter(self.numbers)
        for name in arrays.keys() - set(params._fields):
            instead = self.instead_of[name]
            raise ValueError(f"{name} must be numbers for calls that the framework compiles, got an array; give {instead}")
        values = []
        for name, size in zip(params._fields, self.program._SIZES[params]):
            own: Any = tuple(next(numbers) for _ in range(size)) if size else next(numbers)
            values.append(arrays.get(name, own))
        constants = self.program.material(params(*values), framework if arrays else None)
        if arrays:
            return constants
        # Numbers of Python, which frameworks compile as literals.
        numbers_of_constants = (tuple(map(float, x)) if isinstance(x, tuple) else float(x) for x in constants)
        self.constants_of_numbers = type(constants)(*numbers_of_constants)
        return self.constants_of_numbers


model_of = lru_cache(256)(Model)


def width(field: dict[str, Any]) -> int:
    """Returns the count of components of a field, 0 for a number."""
    return {"number": 0, "rgb": 3}.get(field["kind"], len(field["labels"]))


def raw(model: str | Material, preset: str | None, fields: dict[str, Any], is_array: Callable[[Any], bool]) -> tuple[Material, dict[str, Array]]:
    """Returns the material of the numbers and words among the fields, and the arrays among them by name.

    In the material, any number stands in for an array, which has no value before a compiled function runs.
    """
    fields = dict(fields)
    energy = fields.pop("energy", model.energy if isinstance(model, Material) else "raw")
    if energy != "raw":
        raise ValueError(f'energy must be "raw" for arrays, got "{energy}", whose factor has no derivatives: give energy="raw"')
    if isinstance(model, Material):
        if preset is not None:
            raise TypeError(f"preset must be left out with a material, got {preset!r}")
        material, model = model, model.model
    else:
        material = Material(model, preset, energy="raw")
    known = described(model)["fields"]

    def head(name: str) -> str:
        """Returns the field that this one takes the place of, or the field itself."""
        found: str = known.get(name, {}).get("instead_of") or name
        return found

    replaced = {head(name) for name in fields}
    values: dict[str, Any] = {name: value for name, value in material.fields.items() if head(name) not in replaced}
    if material.choice is not None:
        values[described(model)["choice"]] = material.choice
    arrays: dict[str, Array] = {}
    for name, value in fields.items():
        field = known.get(name, {"kind": "word"})
        if field["kind"] != "word" and is_array(value):
            arrays[name] = value
            default = Material(model).fields.get(name, 0.5)
            value = default if isinstance(default, tuple) or field["kind"] == "number" else (default,) * width(field)
        values[name] = value
    return Material(model, energy="raw", **values), arrays


class Hair:
    """Hair whose numbers may be arrays of a framework, with energy "raw"."""

    def __init__(self, model: str | Material, preset: str | None, fields: dict[str, Any]) -> None:
        self._material, self._given = raw(model, preset, fields, self._is_array)
        self._model: Model = model_of(self._material, tuple(self._given))

    def _is_array(self, value: Any) -> bool:
        raise NotImplementedError

    @property
    def model(self) -> str:
        """Name of the model: "gaussian", "cauchy", "kajiya-kay", "chiang" or "d-eon"."""
        return self._material.model

    @property
    def choice(self) -> str | None:
        """Word of "sampler" or "select", which decides how directions are sampled; None if the model has no choice."""
        return self._material.choice

    @property
    def fields(self) -> dict[str, Any]:
        """Values of the fields by name: arrays as they were given, numbers, and words."""
        return {**self._material.fields, **self._given}

    def __repr__(self) -> str:
        arrays = "".join(f", {name}={value!r}" for name, value in self._given.items())
        return f"{type(self).__module__}.material({self._material!r}{arrays})"

    def eval(self, wo: Array, wi: Array, h: Array = 0.0) -> Array:
        """Evaluates S without the cosine, linear RGB, per steradian, in the fibre's frame, at offsets `h` across the fibre."""
        return self.eval_pdf(wo, wi, h)[0]

    def pdf(self, wo: Array, wi: Array, h: Array = 0.0) -> Array:
        """Evaluates the density with which `sample` draws directions, per steradian."""
        return self.eval_pdf(wo, wi, h)[1]

    def eval_pdf(self, wo: Array, wi: Array, h: Array = 0.0) -> Pair:
        """Evaluates what `eval` and `pdf` return, in one call."""
        raise NotImplementedError

    def sample(self, wo: Array, xi: Array, h: Array = 0.0) -> Samples:
        """Draws directions with uniform numbers in [0, 1): a dict of "wi", "value", "pdf", "weight" and "lobe", as `Material.sample` does."""
        raise NotImplementedError

    def eval_sample(self, wo: Array, wi: Array, xi: Array, h: Array = 0.0) -> tuple[Pair, Samples]:
        """Evaluates a direction and draws another one: what `eval_pdf` and `sample` return."""
        return self.eval_pdf(wo, wi, h), self.sample(wo, xi, h)
