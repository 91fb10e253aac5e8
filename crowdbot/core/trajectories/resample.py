"""Tracks at other times than those they were recorded at."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

#: Samples of one run: a day at 1000 Hz.
_MOST = 1e8


def steady_times(begin: float, end: float, rate: float) -> Array:
    """(N,) times from ``begin`` on, 1 / ``rate`` apart, none after ``end``; s, Hz.

    Raises:
        InputError: the rate is not positive, or makes more samples than can be held.
    """
    if not (math.isfinite(rate) and rate > 0.0):
        raise InputError(f"resample: a rate is positive, in Hz, not {rate!r}")
    if (end - begin) * rate > _MOST:
        raise InputError(
            f"resample: {end - begin:g} s at {rate:g} Hz are {(end - begin) * rate:.3g} samples, "
            f"more than {_MOST:g}"
        )
    count = math.floor((end - begin) * rate + 1e-9) + 1
    times: Array = begin + np.arange(count) / rate
    return times


def interpolated(known: Array, values: Array, t: Array, max_gap: float = math.inf) -> Array:
    """(N,) values at other times, on straight lines; NaN outside, and where nothing is known.

    Args:
        known: (K,) times of the values, increasing, s.
        values: (K,) with NaN where they are not known.
        t: (N,) wanted times, s.
        max_gap: no line is drawn over a longer time, s.
    """
    there = np.isfinite(values)
    known, values = known[there], values[there]
    if not len(known):
        return np.full(len(t), np.nan)
    made: Array = np.interp(t, known, values, left=np.nan, right=np.nan)
    after = np.clip(np.searchsorted(known, t), 0, len(known) - 1)
    before = np.clip(np.searchsorted(known, t, side="right") - 1, 0, len(known) - 1)
    made[known[after] - known[before] > max_gap * (1.0 + 1e-9)] = np.nan
    return made
