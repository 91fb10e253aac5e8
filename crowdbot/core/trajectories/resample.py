"""Resample tracks at other times."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

#: Largest number of samples of a run: a day at 1000 Hz.
_MOST = 1e8


def steady_times(begin: float, end: float, rate: float) -> Array:
    """Return (N,) times from ``begin``, 1 / ``rate`` apart, up to ``end``; s, Hz.

    Raises:
        InputError: the rate is not positive, or gives too many samples.
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
    """Interpolate linearly at other times (N,); NaN outside and where values are unknown.

    Args:
        known: (K,) times of the values, increasing, s.
        values: (K,) values, NaN if unknown.
        t: (N,) requested times, s.
        max_gap: longest gap to interpolate over, s.
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
