"""Dynamic time warping of two paths: their distance regardless of time."""

from __future__ import annotations

import numpy as np

from crowdbot.core.types.arrays import Array, Mask


def spaced(x: Array, y: Array, valid: Mask, spacing: float) -> Array:
    """Return points (P, 2) at equal spacing along a path, m; first and last included.

    So the number of points depends on the path's length, not on sampling or standstill.

    Args:
        x, y: (N,) positions, NaN where unknown.
        valid: (N-1,) steps without a teleport; others are straight and add no length.
        spacing: m.
    """
    known = np.isfinite(x) & np.isfinite(y)
    x, y = x[known], y[known]
    if not len(x):
        return np.empty((0, 2))
    steps = np.hypot(np.diff(x), np.diff(y))
    steps = np.where(valid, steps, 0.0) if known.all() else steps
    way = np.concatenate([[0.0], np.cumsum(steps)])
    grows = np.concatenate([[True], steps > 0.0])
    count = max(2, round(float(way[-1]) / spacing) + 1) if way[-1] > 0.0 else 1
    at = np.linspace(0.0, way[-1], count)
    return np.column_stack([np.interp(at, way[grows], p[grows]) for p in (x, y)])


def least_warping(a: Array, b: Array) -> float:
    """Return the smallest sum of distances (m) over monotone assignments of (A, 2) and (B, 2).

    Both ends are matched. The table is filled along its diagonals, whose cells are independent.
    """
    n, m = len(a), len(b)
    apart = np.hypot(*(a[:, None, i] - b[None, :, i] for i in (0, 1)))
    before = np.full(n + 1, np.inf)  # the diagonal before the last one, by row + 1
    last = np.full(n + 1, np.inf)
    for d in range(n + m - 1):
        rows = np.arange(max(0, d - m + 1), min(n, d + 1))
        least = np.minimum(np.minimum(last[rows + 1], last[rows]), before[rows])
        now = np.full(n + 1, np.inf)
        now[rows + 1] = apart[rows, d - rows] + (least if d else 0.0)
        before, last = last, now
    return float(last[n])
