"""A fingerprint of this machine's rounding, which decides if trajectories are reproducible.

IEEE arithmetic is the same everywhere; the last digits of sine, exponential and matrix products are
not. They depend on the C library, on the instructions chosen by numpy and BLAS, and on process
settings, so the processor's name is not enough. A fingerprint of results is.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable
from functools import cache

import numpy as np

_COUNT = 2000
_OF_ONE: tuple[Callable[[float], float], ...] = (
    math.sin, math.cos, math.tan, math.exp, math.atan, math.tanh, math.erf, math.cbrt,
)  # fmt: skip
_POSITIVE: tuple[Callable[[float], float], ...] = (math.log, math.sqrt, math.log2)
_OF_TWO: tuple[Callable[[float, float], float], ...] = (math.atan2, math.hypot, math.pow)


@cache
def fingerprint() -> str:
    """Return 16 hex digits, equal on machines that round simulation functions alike."""
    # no random generator: the points must not depend on what is tested
    place = (np.arange(1, _COUNT + 1) * 0.6180339887498949) % 1.0
    other = (np.arange(1, _COUNT + 1) * 0.4142135623730951) % 1.0
    x, y = 8.0 * place - 4.0, 8.0 * other - 4.0
    found = [[f(v) for v in x.tolist()] for f in _OF_ONE]
    found += [[f(v) for v in (4.0 * other + 1e-3).tolist()] for f in _POSITIVE]
    pairs = list(zip((x + 4.001).tolist(), y.tolist(), strict=True))
    found += [[f(a, b) for a, b in pairs] for f in _OF_TWO]
    matrix = x[:1600].reshape(40, 40)
    arrays = [np.array(found), np.sin(x), np.cos(x), np.exp(x), np.arctan2(x, y), np.hypot(x, y),
              matrix @ y[:1600].reshape(40, 40), matrix @ y[:40], np.cumsum(x), np.array(x.sum()),
              np.linalg.solve(matrix + 9.0 * np.eye(40), y[:40])]  # fmt: skip
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()[:16]
