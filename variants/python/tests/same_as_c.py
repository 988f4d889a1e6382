"""Compares the wheel with the C library by ctypes: both must have the same bits; prints the time of each. same_as_c.py LIBRARY"""

from __future__ import annotations

import ctypes as C
import sys
import timeit
from collections.abc import Callable

import hairis
import numpy as np
from conftest import bits, directions
from numpy.typing import NDArray

Rows = C.c_void_p * 3


class Params(C.Structure):
    _fields_ = [("model", C.c_uint32), ("given", C.c_uint32), ("numbers", C.c_float * 48)]


class Evals(C.Structure):
    _fields_ = [("value", Rows), ("pdf", C.c_void_p)]


class Hits(C.Structure):
    _fields_ = [("wo", Rows), ("h", C.c_void_p), ("index", C.c_void_p)]


def room(size: int) -> NDArray[np.uint8]:
    block = np.zeros(size + 16, np.uint8)
    start = -block.ctypes.data % 16
    return block[start : start + size]


def rows(a: NDArray[np.float32]) -> C.Array[C.c_void_p]:
    return Rows(*(a.ctypes.data + 4 * a.shape[1] * row for row in range(3)))


def nanoseconds(call: Callable[[], object], n: int) -> float:
    repeats = max(1, 20_000 // n)
    return min(timeit.repeat(call, number=repeats, repeat=7)) / repeats / n * 1e9


def main() -> None:
    library = C.CDLL(sys.argv[1])
    params, material, bsdf = Params(), room(1536), room(1024)
    assert library.hairis_params_init(C.byref(params), b"gaussian", b"matched", b"brown", None) == 0
    assert library.hairis_material_init(C.c_void_p(material.ctypes.data), C.byref(params), 0, None) == 0
    library.hairis_prepare.argtypes = [C.c_void_p, C.c_void_p, C.c_float, C.c_float, C.c_float, C.c_float]
    library.hairis_prepare.restype = None
    library.hairis_prepare(bsdf.ctypes.data, material.ctypes.data, 0.6, 0.8, 0.0, 0.0)
    library.hairis_eval_columns.argtypes = [C.c_void_p, C.c_size_t, C.c_void_p, C.c_void_p]
    library.hairis_eval_hits.argtypes = [C.c_void_p, C.c_size_t, C.c_size_t, C.c_void_p, C.c_void_p, C.c_void_p]

    hair = hairis.Material("gaussian", "brown", sampler="matched", energy="raw")
    one = hair.prepare((0.6, 0.8, 0.0))
    print(f"ns per direction on {hairis.level()}: wheel with out=, C by ctypes")
    for n in (1, 1000, 1_000_000):
        wo, wi = directions(n, 1), directions(n, 2)
        value, pdf = np.empty((3, n), np.float32), np.empty(n, np.float32)
        evals, wi_rows = Evals(rows(value), pdf.ctypes.data), rows(wi)
        hits, out = Hits(rows(wo), None, None), {"value": np.empty((3, n), np.float32), "pdf": np.empty(n, np.float32)}

        def c_columns() -> None:
            assert library.hairis_eval_columns(bsdf.ctypes.data, n, C.byref(wi_rows), C.byref(evals)) == 0

        def c_hits() -> None:
            assert library.hairis_eval_hits(
                material.ctypes.data, 1, n, C.byref(hits), C.byref(wi_rows), C.byref(evals)
            ) == 0

        calls: list[tuple[str, Callable[[], object], Callable[[], object]]] = [
            ("columns", lambda: one.eval_columns(wi, out=out), c_columns),
            ("hits", lambda: hair.eval_hits(wo, wi, out=out), c_hits),
        ]
        for name, wheel, c in calls:
            wheel()
            c()
            same = (bits(out["value"]) == bits(value)).all() and (bits(out["pdf"]) == bits(pdf)).all()
            assert same, f"{name} of {n} differ"
            print(f"{name:8} {n:8} {nanoseconds(wheel, n):9.2f} {nanoseconds(c, n):9.2f}", flush=True)


main()
