"""Random floor plans: rooms with doors in a grid."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SIZE, DOOR, THICK = 5.0, 1.4, 0.2


def outline(x0: float, y0: float, x1: float, y1: float) -> list[list[float]]:
    """Sides of a solid box, the free side on their left."""
    return [[x0, y0, x0, y1], [x0, y1, x1, y1], [x1, y1, x1, y0], [x1, y0, x0, y0]]


def rooms(rng: np.random.Generator, columns: int, rows: int, doors: float = 0.8) -> Array:
    """Walls (S, 4) of rooms; each wall between two of them has a door with some probability."""
    width, height = columns * SIZE, rows * SIZE
    walls = [[0, 0, width, 0], [width, 0, width, height], [width, height, 0, height]]
    walls.append([0, height, 0, 0])
    for i in range(columns):
        for j in range(rows):
            x, y = i * SIZE, j * SIZE
            for flip, inner in ((False, i > 0), (True, j > 0)):
                if not inner:
                    continue
                at = rng.uniform(0.5, SIZE - DOOR - 0.5)
                ends = [(0.0, at), (at + DOOR, SIZE)] if rng.random() < doors else [(0.0, SIZE)]
                for low, high in ends:
                    box = (
                        (x + low, y - THICK / 2, x + high, y + THICK / 2)
                        if flip
                        else (x - THICK / 2, y + low, x + THICK / 2, y + high)
                    )
                    walls += outline(*box)
    return np.array(walls, np.float64)


def crossings(walls: Array, before: Array, after: Array) -> int:
    """How often steps (N, 2) -> (N, 2) cross walls."""
    step, count = after - before, 0
    for x0, y0, x1, y1 in walls:
        ex, ey = x1 - x0, y1 - y0
        one = step[:, 0] * (y0 - before[:, 1]) - step[:, 1] * (x0 - before[:, 0])
        two = step[:, 0] * (y1 - before[:, 1]) - step[:, 1] * (x1 - before[:, 0])
        begin = ex * (before[:, 1] - y0) - ey * (before[:, 0] - x0)
        end = ex * (after[:, 1] - y0) - ey * (after[:, 0] - x0)
        count += int(np.sum((one * two < 0.0) & (begin * end < 0.0)))
    return count
