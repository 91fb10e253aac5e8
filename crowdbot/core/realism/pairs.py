"""Pair correlation: frequency of distances between two people, over the frequency by chance.

Chance pairs are the same people at different times: a person in a window now, and a person in view
some seconds apart. So walls and the window's shape cancel out.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from crowdbot.core.realism.bins import CELLS, DENSITY_EDGES, PAIR_EDGES
from crowdbot.core.realism.tracks import CorridorTracks
from crowdbot.core.support.compiling.compile import array_kernel
from crowdbot.core.types.arrays import Array

#: Time shifts for chance pairs, as shares of the compared frames.
_SHIFTS = (0.31, 0.5, 0.69)


def pair_correlation(tracks: Sequence[CorridorTracks]) -> Array:
    """Return (cells, B) by `PAIR_EDGES` per density; NaN without chance pairs."""
    now = np.zeros((len(CELLS), len(PAIR_EDGES) - 1))
    chance = np.zeros_like(now)
    for t in tracks:
        args = (
            np.ascontiguousarray(t.position), t.width, np.asarray(t.windows, np.float64),
            t.period, DENSITY_EDGES, float(PAIR_EDGES[1]), t.first, t.last,
        )  # fmt: skip
        _count(*args, 0, now)
        for share in _SHIFTS:
            _count(*args, max(1, round(share * (t.last - t.first))), chance)
    # Chance pairs have the same number of people in windows; each shift counts its own pairs.
    with np.errstate(invalid="ignore", divide="ignore"):
        found = np.where(chance > 0.0, now / (chance / len(_SHIFTS)), np.nan)
        found /= (now.sum(1) / (chance.sum(1) / len(_SHIFTS)))[:, np.newaxis]
    return np.asarray(found)


@array_kernel
def _count(
    position: Array, width: float, windows: Array, period: float, edges: Array, bin_width: float,
    first: int, last: int, shift: int, counts: Array,
) -> None:  # fmt: skip
    """Count pairs of a person in a window in frame k and any person in frame k + shift."""
    for k in range(first, last):
        other = first + (k - first + shift) % (last - first)
        for w in range(windows.shape[0]):
            low, high, inside = windows[w, 0], windows[w, 1], 0
            for i in range(position.shape[1]):
                if low <= position[k, i, 0] < high:
                    inside += 1
            cell = np.searchsorted(edges, inside / ((high - low) * width), side="right") - 1
            if cell < 0 or cell >= counts.shape[0]:
                continue
            for i in range(position.shape[1]):
                if not low <= position[k, i, 0] < high:
                    continue
                for j in range(position.shape[1]):
                    if j == i or math.isnan(position[other, j, 0]):
                        continue
                    dx = position[k, i, 0] - position[other, j, 0]
                    dy = position[k, i, 1] - position[other, j, 1]
                    if period > 0.0:
                        dx -= period * round(dx / period)
                    b = int(math.sqrt(dx * dx + dy * dy) / bin_width)
                    if b < counts.shape[1]:
                        counts[cell, b] += 1.0
