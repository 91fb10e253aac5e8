"""Prepare numba for compilation in fork servers, for planners that use it.

Numba loads most of itself on the first compilation, which takes longer than its import.
"""

from __future__ import annotations

import numba
import numpy as np


@numba.njit
def _warm(values: np.ndarray) -> float:
    return float(values[0]) * 0.5


_warm(np.ones(2))
