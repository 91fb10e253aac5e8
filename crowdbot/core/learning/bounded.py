"""Clip vectors to bounds and check that they are finite, in one compiled pass."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.support.compiling.compile import kernel

Vectors = NDArray[np.float32]


@kernel
def write_bounded(vectors: Vectors, low: Vectors, high: Vectors, out: Vectors) -> bool:
    """Write vectors (W, N), clipped to bounds (N,); return True if all are finite."""
    finite = True
    for w in range(vectors.shape[0]):
        for n in range(vectors.shape[1]):
            value = vectors[w, n]
            if not math.isfinite(value):
                finite = False
            out[w, n] = low[n] if value < low[n] else high[n] if value > high[n] else value
    return finite
