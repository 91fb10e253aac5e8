"""Distances to the nearest lidar point, on a small grid around the robot; compiled.

Rollouts look up thousands of places, so the distance is computed once for each cell: exactly, as
the lower envelope of parabolas along rows and then columns (Felzenszwalb, Huttenlocher, "Distance
transforms of sampled functions", Theory of Computing 8, 2012).
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, kernel

#: Width of a cell, m; cells along each side.
CELL, CELLS = 0.06, 128
_FAR = 1e6


class DistanceField:
    """A grid of distances; ``values`` is (`CELLS`, `CELLS`), m, ``corner`` its lowest x and y."""

    def __init__(self) -> None:
        self.values = np.zeros((CELLS, CELLS))
        self.corner = (0.0, 0.0)
        self._line, self._knots = np.zeros((2, CELLS)), np.zeros((2, CELLS + 1))
        self.fill(np.ones((1, 2)), 0.0, 0.0)

    def fill(self, points: Array, x: float, y: float) -> None:
        """Compute the distances around a position.

        Args:
            points: (P, 2) m.
            x, y: middle of the grid, m.
        """
        half = 0.5 * CELL * CELLS
        self.corner = (x - half, y - half)
        _fill(points, self.corner[0], self.corner[1], self.values, self._line, self._knots)


@kernel
def distance_at(values: Array, corner: tuple[float, float], x: float, y: float) -> float:
    """Return the distance at a position, m, by linear interpolation; large outside the grid."""
    u, v = (x - corner[0]) / CELL - 0.5, (y - corner[1]) / CELL - 0.5
    i, j = math.floor(u), math.floor(v)
    if i < 0 or j < 0 or i >= CELLS - 1 or j >= CELLS - 1:
        return _FAR
    a, b = u - i, v - j
    low = (1.0 - b) * values[i, j] + b * values[i, j + 1]
    high = (1.0 - b) * values[i + 1, j] + b * values[i + 1, j + 1]
    return float((1.0 - a) * low + a * high)


@kernel
def _fill(points: Array, x0: float, y0: float, out: Array, line: Array, knots: Array) -> None:
    for i in range(CELLS):
        for j in range(CELLS):
            out[i, j] = _FAR
    for k in range(points.shape[0]):
        i, j = math.floor((points[k, 0] - x0) / CELL), math.floor((points[k, 1] - y0) / CELL)
        if 0 <= i < CELLS and 0 <= j < CELLS:
            out[i, j] = 0.0
    for i in range(CELLS):
        _transform(out[i], line, knots)
    for j in range(CELLS):
        _transform(out[:, j], line, knots)
    for i in range(CELLS):
        for j in range(CELLS):
            out[i, j] = CELL * math.sqrt(out[i, j])


@kernel
def _transform(values: Array, line: Array, knots: Array) -> None:
    """Replace squared distances along a line by their least sum with squared steps, in place.

    Args:
        values: (N,) whole cells squared.
        line: (2, N) scratch: a copy of the values, and the parabolas' places.
        knots: (2, N + 1) scratch: where one parabola takes over from another.
    """
    count, n = 0, values.shape[0]
    copy, place, start = line[0], line[1], knots[0]
    for q in range(n):
        copy[q] = values[q]
    for q in range(n):
        if copy[q] >= _FAR:
            continue
        at = -math.inf
        while count > 0:
            p = int(place[count - 1])
            at = ((copy[q] + q * q) - (copy[p] + p * p)) / (2.0 * q - 2.0 * p)
            if at > start[count - 1]:
                break
            count -= 1
        place[count] = q
        start[count] = at if count > 0 else -math.inf
        count += 1
    if count == 0:
        return
    k = 0
    for q in range(n):
        while k + 1 < count and start[k + 1] < q:
            k += 1
        p = int(place[k])
        values[q] = (q - p) * (q - p) + copy[p]
