"""Samples of two runs that were taken at the same time after the start."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array

#: Two times closer than this are the same, s.
SAME_TIME = 1e-6


def paired_samples(a: Array, b: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows of ``a`` and of ``b`` whose times since the start are the same."""
    since_a, since_b = a - a[0], b - b[0]
    at = np.searchsorted(since_b, since_a - SAME_TIME)
    inside = at < len(b)
    same = inside & (np.abs(since_b[np.minimum(at, len(b) - 1)] - since_a) <= SAME_TIME)
    return np.flatnonzero(same), at[same]
