"""Align one path with another, and find the longest valid part of a trip: compiled loops."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array, Mask

#: Points closer than this coincide (squared, m²).
_SAME = 1e-18
#: Tolerance for skipping segments, m: rounding must not skip the nearest.
_NEAR = 1e-6


@kernel
def longest_parts(
    valid: Mask,
    first: NDArray[np.int64],
    last: NDArray[np.int64],
    column: NDArray[np.int64],
    parts: NDArray[np.int64],
) -> None:
    """Write start and end of each trip's longest part over valid steps.

    Args:
        valid: (N-1, M) steps.
        first, last, column: (K,) samples and person of each trip; -1: unknown person.
        parts: (K, 3) output: its first sample, and the one after its last.
    """
    for k in range(column.shape[0]):
        begin, end = first[k], last[k] + 1 if column[k] >= 0 else first[k]
        for sample in range(begin, end):
            if sample - begin >= parts[k, 1] - parts[k, 0]:
                parts[k, 0], parts[k, 1] = begin, sample + 1
            if sample + 1 < end and not valid[sample, column[k]]:
                begin = sample + 1


@kernel
def follow(one: Array, other: Array, window: int, beside: Array, late: Array) -> None:
    """Align one path with another, from start to end.

    The other path is extended by a step at both ends, since samples rarely coincide with its ends.

    Args:
        one, other: (3, K) and (3, L) x, y (m) and time (s), L >= 2.
        window: number of samples from the last match in which to search the next.
        beside: (K,) output: distance from the other path, m.
        late: (K,) output: delay at the matched position, s.
    """
    x, y, t = one[0], one[1], one[2]
    wx, wy, wt = other[0], other[1], other[2]
    longest = 0.0
    for s in range(wx.shape[0] - 1):
        longest = max(longest, math.hypot(wx[s + 1] - wx[s], wy[s + 1] - wy[s]))
    at = 0
    for k in range(x.shape[0]):
        best, near, behind = math.inf, at, 0.0
        # Start with the last match: farther positions cannot be nearest.
        dx, dy = x[k] - wx[at], y[k] - wy[at]
        far = (math.sqrt(dx * dx + dy * dy) + 3.0 * longest + _NEAR) ** 2
        for s in range(max(0, at - window), min(wx.shape[0] - 1, at + window + 1)):
            px, py = x[k] - wx[s], y[k] - wy[s]
            if px * px + py * py > far:
                continue
            ex, ey = wx[s + 1] - wx[s], wy[s + 1] - wy[s]
            square = ex * ex + ey * ey
            u = (px * ex + py * ey) / square if square > 0.0 else 0.0
            u = max(u, -1.0 if s == 0 else 0.0)
            u = min(u, 2.0 if s == wx.shape[0] - 2 else 1.0)
            apart = (px - u * ex) ** 2 + (py - u * ey) ** 2
            lag = t[k] - wt[s] - u * (wt[s + 1] - wt[s])
            if apart < best - _SAME or (apart <= best + _SAME and abs(lag) < abs(behind)):
                best, near, behind = min(apart, best), s, lag
        at = near
        beside[k], late[k] = math.sqrt(best), behind
