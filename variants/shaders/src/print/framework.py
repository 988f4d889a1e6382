class Framework:
    """Operations on arrays of float32 for one call. Another framework is a subclass with the operations that have no body here."""

    array: Any
    result: Any
    select: Any
    root: Any
    abs: Any
    exp2: Any
    log2: Any
    bits: Any
    number: Any
    shape: tuple[int, ...] = ()
    differentiates = True

    def __init__(self, values: list[Array]) -> None:
        pass

    def quiet(self) -> Any:
        return nullcontext()

    @classmethod
    def components(cls, value: Vector, count: int) -> list[Array]:
        return [value[i] for i in range(count)]

    def inputs(self, arrays: list[Array]) -> list[Array]:
        return arrays

    def results(self, *numbers: Array) -> Vector:
        return tuple(self.result(a) for a in numbers)

    def stop(self, a: Array) -> Array:
        return a

    def fma(self, a: Array, b: Array, c: Array) -> Array:
        return a * b + c

    # A sum with a constant so large that it rounds the number to an integer: a step, whose derivative is 0.
    def rounded(self, large: float, a: Array) -> Array:
        return self.stop(large + a)

    # The second operand where either is NaN.
    def min(self, a: Array, b: Array) -> Array:
        return self.select(a < b, a, b)

    def max(self, a: Array, b: Array) -> Array:
        return self.select(a > b, a, b)

    def times_sign(self, a: Array, b: Array) -> Array:
        return self.select(self.bits(b) < 0, -a, a)

    def negate_if(self, m: Array, a: Array) -> Array:
        return self.select(m, -a, a)

    def sqrt(self, a: Array) -> Array:
        if not self.differentiates:
            return self.root(a)
        # The derivative is 0 where it would be infinite.
        low = a < 1e-36
        return self.select(low, self.stop(self.root(a)), self.root(self.select(low, 1.0, a)))

    # A power of two from an integer in the low bits, biased as an exponent is.
    def shift_left_23(self, a: Array) -> Array:
        return self.number(self.bits(a) << 23)

    # The high half has no derivative: the low half, which is the difference, has that of the whole.
    def upper(self, a: Array) -> Array:
        return self.number(self.bits(a) & -4096)

    # Mantissa from sqrt(1/2) to sqrt(2), and exponent.
    def exponent_bits(self, a: Array) -> Array:
        return ((self.bits(a) + 0x004AFB0D) >> 23) & 0x1FF

    def mantissa(self, a: Array) -> Array:
        rest = self.number(self.bits(a) + 0x3F800000 - (self.exponent_bits(a) << 23))
        if not self.differentiates:
            return rest
        return self.select((a > 0.0) & (a < inf), a * self.stop(rest / a), rest)

    def exponent(self, a: Array) -> Array:
        return self.number(self.exponent_bits(a) | 0x4B000000) - 8388735.0


class NumPy(Framework):
    differentiates = False

    def __init__(self, values: list[Array]) -> None:
        import numpy

        self.np: Any = numpy

    def quiet(self) -> Any:
        return self.np.errstate(all="ignore")

    def array(self, a: Array) -> Array:
        return self.np.asarray(a, self.np.float32)

    # With a dimension, NumPy 1 keeps float32 in sums with numbers of Python.
    def inputs(self, arrays: list[Array]) -> list[Array]:
        return [self.np.atleast_1d(a) for a in arrays]

    def result(self, a: Array) -> Array:
        a = self.np.asarray(a, self.np.float32)
        return self.np.broadcast_to(a, self.shape) if self.shape else a.reshape(())

    def select(self, m: Array, a: Array, b: Array) -> Array:
        return self.np.where(m, self.array(a), self.array(b))

    def root(self, a: Array) -> Array:
        return self.np.sqrt(a)

    def abs(self, a: Array) -> Array:
        return self.np.abs(a)

    def exp2(self, a: Array) -> Array:
        return self.np.exp2(a)

    def log2(self, a: Array) -> Array:
        return self.np.log2(a)

    def bits(self, a: Array) -> Array:
        return self.np.ascontiguousarray(a, self.np.float32).view(self.np.int32)

    def number(self, bits: Array) -> Array:
        return self.np.ascontiguousarray(bits, self.np.int32).view(self.np.float32)


class Jax(Framework):
    def __init__(self, values: list[Array]) -> None:
        import jax

        self.np: Any = jax.numpy
        self.lax, self.finite = jax.lax, _jax_finite(jax)

    def array(self, a: Array) -> Array:
        return self.np.asarray(a, self.np.float32)

    def inputs(self, arrays: list[Array]) -> list[Array]:
        # Each number has an entry per hit, also under vmap, so that a derivative is dropped at its hit alone.
        one = reduce(lambda m, a: m & (a == a), arrays[1:], arrays[0] == arrays[0])
        return list(self.finite([self.np.where(one, a, a) for a in arrays]))

    def result(self, a: Array) -> Array:
        return self.np.broadcast_to(self.array(a), self.shape)

    def stop(self, a: Array) -> Array:
        return self.lax.stop_gradient(a)

    # XLA takes the sum apart.
    def rounded(self, large: float, a: Array) -> Array:
        return self.stop(large + self.np.round(a))

    def select(self, m: Array, a: Array, b: Array) -> Array:
        return self.np.where(m, self.array(a), self.array(b))

    def root(self, a: Array) -> Array:
        return self.np.sqrt(a)

    def abs(self, a: Array) -> Array:
        return self.np.abs(a)

    def exp2(self, a: Array) -> Array:
        return self.np.exp2(a)

    def log2(self, a: Array) -> Array:
        return self.np.log2(a)

    def bits(self, a: Array) -> Array:
        return self.lax.bitcast_convert_type(self.stop(self.array(a)), self.np.int32)

    def number(self, bits: Array) -> Array:
        return self.lax.bitcast_convert_type(bits, self.np.float32)


@lru_cache(None)
def _jax_finite(jax: Any) -> Any:
    """Returns the identity whose derivative is 0 where it would be infinite or NaN."""
    identity: Any = jax.custom_vjp(lambda numbers: numbers)

    def finite(g: Array) -> Array:
        return jax.numpy.where(jax.numpy.isfinite(g), g, 0.0)

    identity.defvjp(lambda numbers: (numbers, None), lambda _, gs: ([finite(g) for g in gs],))
    return identity


class Torch(Framework):
    def __init__(self, values: list[Array]) -> None:
        import torch

        tensors = [a for a in values if isinstance(a, torch.Tensor)]
        self.torch, self.device = torch, tensors[0].device if tensors else None

    def array(self, a: Array) -> Array:
        return self.torch.as_tensor(a, dtype=self.torch.float32, device=self.device)

    def inputs(self, arrays: list[Array]) -> list[Array]:
        self.differentiates = self.torch.is_grad_enabled() and any(a.requires_grad for a in arrays)
        if not self.differentiates:
            return arrays
        one = reduce(lambda m, a: m & (a == a), arrays[1:], arrays[0] == arrays[0])
        return list(_torch_finite(self.torch)(*(self.torch.where(one, a, a) for a in arrays)))

    def result(self, a: Array) -> Array:
        return self.array(a).expand(self.shape)

    def stop(self, a: Array) -> Array:
        return a.detach()

    def select(self, m: Array, a: Array, b: Array) -> Array:
        return self.torch.where(m, self.array(a), self.array(b))

    def root(self, a: Array) -> Array:
        return self.torch.sqrt(a)

    def abs(self, a: Array) -> Array:
        return self.torch.abs(a)

    def exp2(self, a: Array) -> Array:
        return self.torch.exp2(a)

    def log2(self, a: Array) -> Array:
        return self.torch.log2(a)

    def bits(self, a: Array) -> Array:
        return self.array(a).detach().view(self.torch.int32)

    def number(self, bits: Array) -> Array:
        return bits.view(self.torch.float32)


@lru_cache(None)
def _torch_finite(torch: Any) -> Any:
    """Returns the identity whose derivative is 0 where it would be infinite or NaN."""

    def finite(g: Array) -> Array:
        return None if g is None else torch.where(torch.isfinite(g), g, 0.0)

    class Finite(torch.autograd.Function):  # type: ignore[misc]
        generate_vmap_rule = True
        forward = staticmethod(lambda *numbers: tuple(a.view_as(a) for a in numbers))
        setup_context = staticmethod(lambda ctx, inputs, output: None)
        backward = staticmethod(lambda ctx, *gs: tuple(finite(g) for g in gs))
        jvp = staticmethod(lambda ctx, *gs: tuple(finite(g) for g in gs))

    return Finite.apply


class DrJit(Framework):
    def __init__(self, values: list[Array]) -> None:
        import drjit

        leaves = [type(a) for a in values if drjit.is_array_v(a)]
        if not leaves:
            raise TypeError("arguments must have an array of Dr.Jit, got numbers alone")
        self.dr: Any = drjit
        self.real: Any = drjit.float32_array_t(leaves[0])
        self.whole: Any = drjit.int32_array_t(self.real)

    @classmethod
    def components(cls, value: Vector, count: int) -> list[Array]:
        import drjit

        if drjit.is_dynamic_v(value) and drjit.depth_v(value) == 1:
            return [drjit.gather(type(value), value, i) for i in range(count)]
        return [value[i] for i in range(count)]

    def array(self, a: Array) -> Array:
        return self.real(a)

    def inputs(self, arrays: list[Array]) -> list[Array]:
        self.differentiates = any(self.dr.grad_enabled(a) for a in arrays)
        if not self.differentiates:
            return arrays
        # A sum with -0 has an entry per hit, so that a derivative is dropped at its hit alone.
        one, finite = self.dr.full(self.real, -0.0, *self.shape), _drjit_finite(self.dr)
        return [self.dr.custom(finite, a + one) if self.dr.grad_enabled(a) else a for a in arrays]

    def result(self, a: Array) -> Array:
        return self.real(a)

    def stop(self, a: Array) -> Array:
        return self.dr.detach(a)

    def fma(self, a: Array, b: Array, c: Array) -> Array:
        return self.dr.fma(self.real(a), self.real(b), self.real(c))

    def select(self, m: Array, a: Array, b: Array) -> Array:
        return self.dr.select(m, self.real(a), self.real(b))

    def root(self, a: Array) -> Array:
        return self.dr.sqrt(a)

    def abs(self, a: Array) -> Array:
        return self.dr.abs(a)

    def exp2(self, a: Array) -> Array:
        return self.dr.exp2(a)

    def log2(self, a: Array) -> Array:
        return self.dr.log2(a)

    def bits(self, a: Array) -> Array:
        return self.dr.reinterpret_array(self.whole, self.dr.detach(self.real(a)))

    def number(self, bits: Array) -> Array:
        return self.dr.reinterpret_array(self.real, bits)


@lru_cache(None)
def _drjit_finite(drjit: Any) -> Any:
    """Returns the identity whose derivative is 0 where it would be infinite or NaN."""

    class Finite(drjit.CustomOp):  # type: ignore[misc]
        def eval(self, a: Array) -> Array:
            return a

        def finite(self, g: Array) -> Array:
            return drjit.select(drjit.isfinite(g), g, 0.0)

        def forward(self) -> None:
            self.set_grad_out(self.finite(self.grad_in("a")))

        def backward(self) -> None:
            self.set_grad_in("a", self.finite(self.grad_out()))

    return Finite


_FRAMEWORKS = {"numpy": NumPy, "jax": Jax, "jaxlib": Jax, "torch": Torch, "drjit": DrJit}
_SIZES: dict[Any, tuple[int, ...]] = {}


def _numbers(value: Any) -> Iterator[Any]:
    """Yields the entries of lists and tuples, and other values as they are."""
    if isinstance(value, list | tuple):
        for entry in value:
            yield from _numbers(entry)
    else:
        yield value


def _choose(values: list[Any]) -> Any:
    """Returns the framework of the arrays: NumPy unless one is of another. Arrays of Dr.Jit's scalar modes hold numbers."""
    roots: set[Any] = set()
    for value in _numbers(values):
        kinds = {_FRAMEWORKS.get(kind.__module__.split(".")[0], NumPy) for kind in type(value).__mro__}
        if DrJit not in kinds or sys.modules["drjit"].is_jit_v(value):
            roots |= kinds
    roots.discard(NumPy)
    if len(roots) > 1:
        names = ", ".join(sorted(root.__name__ for root in roots))
        raise TypeError(f"arguments must be arrays of one framework, got {names}")
    return roots.pop() if roots else NumPy


def _fields(name: str, value: Any, form: Any) -> Iterator[tuple[str, Any, int]]:
    """Yields name, value and count of components for each field of an argument; a count of 0 is a number."""
    if isinstance(form, int):
        yield name, value, form
        return
    for field, size in zip(form._fields, _SIZES[form]):
        if not hasattr(value, field):
            raise TypeError(f"{name} must be a {form.__name__}, got {reprlib.repr(value)}, which has no field {field}")
        yield f"{name}.{field}", getattr(value, field), size


def _count(value: Any) -> int:
    """Returns the length of the first dimension, which a number lacks."""
    try:
        return len(value)
    except TypeError:
        return 1


def _make(form: Any, numbers: Iterator[Any]) -> Any:
    """Makes an argument of the next numbers."""
    if isinstance(form, int):
        return tuple(next(numbers) for _ in range(form)) if form else next(numbers)
    return form(*(_make(size, numbers) for size in _SIZES[form]))


def _shape(names: list[str], arrays: list[Any]) -> tuple[int, ...]:
    """Returns the shape that all arrays broadcast to."""
    whole: list[int] = []
    for name, array in zip(names, arrays):
        shape = list(array.shape)
        whole = [1] * (len(shape) - len(whole)) + whole
        for i in range(-len(shape), 0):
            if shape[i] != 1 and whole[i] != 1 and shape[i] != whole[i]:
                raise ValueError(f"{name} must broadcast with the arguments before it, of shape {tuple(whole)}, got {tuple(shape)}")
            whole[i] = shape[i] if whole[i] == 1 else whole[i]
    return tuple(whole)


def _start(framework: Any, **arguments: tuple[Any, Any]) -> Any:
    """Returns the operations, and the arguments as arrays of float32 whose derivatives are finite."""
    fields = [field for name, (value, form) in arguments.items() for field in _fields(name, value, form)]
    module = getattr(framework, "__name__", "").split(".")[0]
    framework = _FRAMEWORKS.get(module, framework) or _choose([value for _, value, _ in fields])
    names: list[str] = []
    values: list[Any] = []
    for name, value, size in fields:
        if size:
            if _count(value) != size:
                raise ValueError(f"{name} must have {size} components in its first dimension, got {_count(value)}")
        names += [name] * max(size, 1)
        values += framework.components(value, size) if size else [value]
    o, arrays = framework(values), []
    with o.quiet():
        for name, value in zip(names, values):
            try:
                # NumPy reads text, and takes None for NaN.
                if value is None or isinstance(value, str | bytes):
                    raise TypeError
                arrays.append(o.array(value))
            except (TypeError, ValueError, RuntimeError):
                raise TypeError(f"{name} must be a number or an array of numbers, got {reprlib.repr(value)}") from None
        o.shape = _shape(names, arrays)
        numbers = iter(o.inputs(arrays))
    return o, *(_make(form, numbers) for _, form in arguments.values())


