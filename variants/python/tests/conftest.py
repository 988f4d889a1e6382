"""Names that the examples of docstrings use, and directions for tests."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray


def directions(n: int, seed: int) -> NDArray[np.float32]:
    """Returns unit vectors, uniform over the sphere."""
    v = np.random.default_rng(seed).normal(size=(3, n))
    return np.ascontiguousarray(v / np.linalg.norm(v, axis=0), np.float32)


def bits(a: NDArray[Any]) -> NDArray[np.uint32]:
    """Returns the bits of floats, by which NaN equals NaN, and 0 differs from -0."""
    return a.view(np.uint32)


def unaligned(n: int) -> NDArray[np.float32]:
    """Returns a C-contiguous column of shape (3, n) that starts at an odd address."""
    return np.zeros(12 * n + 1, np.uint8)[1:].view(np.float32).reshape(3, n)


@pytest.fixture
def xi() -> NDArray[np.float32]:
    """Returns uniform numbers for sampling."""
    return np.random.default_rng(3).random((3, 1000), np.float32)
