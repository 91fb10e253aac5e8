"""The shortest time to the goal among people whose ways are known, from every place; compiled.

Values are found backwards in time on a grid of places along the goal's direction: of all places
that a disc reaches within a step, the one from which the goal is nearest in time (dynamic
programming). It turns and starts at once, so the times are those of plans without such limits.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, kernel
from crowdbot.plugins.planners.people_mpc.plan_world_build import STEP
from crowdbot.plugins.planners.shared.distance_field_build import distance_at

#: Steps of a plan for a layer; cells that the robot crosses in a layer.
LAYER, _CELLS = 2, 3
#: Extent of the grid behind, and to each side, m.
_BEHIND, _BESIDE = 1.0, 2.5
#: Seconds that a second within a person or a wall costs.
_BLOCKED = 10.0


def blank(horizon: float, speed: float) -> tuple[Array, Array, float]:
    """Return room for values and costs (T, I, J), and the width of a cell, m.

    Args:
        horizon: s.
        speed: the robot's largest, m/s.
    """
    cell = LAYER * STEP * speed / _CELLS
    layers = int(horizon / (LAYER * STEP))
    rows = math.ceil((horizon * speed + _BEHIND) / cell) + 1
    columns = 2 * math.ceil(_BESIDE / cell) + 1
    return np.zeros((layers + 1, rows, columns)), np.zeros((rows, columns)), cell


def corner_of(x: float, y: float, way: tuple[float, float], cell: float) -> tuple[float, float]:
    """Return the place of the first node of a grid around a robot, m."""
    ahead, left = -round(_BEHIND / cell) * cell, -math.ceil(_BESIDE / cell) * cell
    return x + way[0] * ahead - way[1] * left, y + way[1] * ahead + way[0] * left


@kernel
def fill(
    values: Array,
    cost: Array,
    places: Array,
    people: Array,
    grid: tuple[float, float, float, float, float],
    goal: tuple[float, float],
    robot: tuple[float, float],
    walls: tuple[Array, tuple[float, float]],
) -> None:
    """Write the time to the goal from each node at each layer, s.

    Args:
        values: (T, I, J) written.
        cost: (I, J) scratch.
        places: (L, N, 2) of people after each `STEP`, m.
        people: (N, 2) radius, m, and what a second within the person costs, s.
        grid: x and y of the first node, cosine and sine of the direction, width of a cell.
        goal: m.
        robot: its radius with what is kept clear, m, and its speed, m/s.
        walls: distances to what stands, and the corner of their grid.
    """
    x0, y0, c, s, cell = grid
    last = values.shape[0] - 1
    for i in range(values.shape[1]):
        for j in range(values.shape[2]):
            x, y = x0 + cell * (c * i - s * j), y0 + cell * (s * i + c * j)
            values[last, i, j] = math.sqrt((x - goal[0]) ** 2 + (y - goal[1]) ** 2) / robot[1]
    for k in range(last - 1, -1, -1):
        n = min(LAYER * (k + 1), places.shape[0]) - 1
        _costs(cost, places[n], people, grid, robot[0], walls)
        _back(values[k], values[k + 1], cost, LAYER * STEP)
        for i in range(values.shape[1]):
            for j in range(values.shape[2]):
                x, y = x0 + cell * (c * i - s * j), y0 + cell * (s * i + c * j)
                if (x - goal[0]) ** 2 + (y - goal[1]) ** 2 < (2.0 * cell) ** 2:
                    values[k, i, j] = 0.0


@kernel
def _costs(
    cost: Array,
    places: Array,
    people: Array,
    grid: tuple[float, float, float, float, float],
    radius: float,
    walls: tuple[Array, tuple[float, float]],
) -> None:
    """Write what a second at each node costs beside itself, s."""
    x0, y0, c, s, cell = grid
    for i in range(cost.shape[0]):
        for j in range(cost.shape[1]):
            x, y = x0 + cell * (c * i - s * j), y0 + cell * (s * i + c * j)
            cost[i, j] = _BLOCKED if distance_at(walls[0], walls[1], x, y) < radius else 0.0
    for n in range(people.shape[0]):
        dx, dy = places[n, 0] - x0, places[n, 1] - y0
        u, w = (c * dx + s * dy) / cell, (c * dy - s * dx) / cell
        r = (radius + people[n, 0]) / cell
        if not (-r < u < cost.shape[0] + r and -r < w < cost.shape[1] + r):
            continue
        for i in range(max(0, math.ceil(u - r)), min(cost.shape[0], math.floor(u + r) + 1)):
            for j in range(max(0, math.ceil(w - r)), min(cost.shape[1], math.floor(w + r) + 1)):
                if (i - u) ** 2 + (j - w) ** 2 < r * r:
                    cost[i, j] = max(cost[i, j], people[n, 1])


@kernel
def _back(now: Array, later: Array, cost: Array, step: float) -> None:
    """Write the times of a layer from those of the next one."""
    rows, columns = now.shape
    for i in range(rows):
        for j in range(columns):
            best = math.inf
            for di in range(-_CELLS, _CELLS + 1):
                for dj in range(-_CELLS, _CELLS + 1):
                    a, b = i + di, j + dj
                    if di * di + dj * dj > _CELLS * _CELLS:
                        continue
                    if not (0 <= a < rows and 0 <= b < columns):
                        continue
                    best = min(best, later[a, b] + step * cost[a, b])
            now[i, j] = step + best


__all__ = ["LAYER", "blank", "corner_of", "fill"]
