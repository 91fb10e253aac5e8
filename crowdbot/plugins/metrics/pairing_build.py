"""Samples of two runs that were taken at the same time after the start."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array

#: Times closer than this are treated as equal, s.
SAME_TIME = 1e-6


def paired_samples(a: Array, b: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the rows of ``a`` and of ``b`` that have the same time since the start."""
    since_a, since_b = a - a[0], b - b[0]
    at = np.searchsorted(since_b, since_a - SAME_TIME)
    inside = at < len(b)
    same = inside & (np.abs(since_b[np.minimum(at, len(b) - 1)] - since_a) <= SAME_TIME)
    return np.flatnonzero(same), at[same]
