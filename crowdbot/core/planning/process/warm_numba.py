"""Imported by fork servers for planners that use numba: makes it ready to compile.

Numba loads most of itself when it compiles for the first time, which takes longer than its import.
"""

from __future__ import annotations

import numba
import numpy as np


@numba.njit
def _warm(values: np.ndarray) -> float:
    return float(values[0]) * 0.5


_warm(np.ones(2))
