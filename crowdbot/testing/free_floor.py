"""Free floor of an environment, where a robot could stand and drive."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np
from scipy.ndimage import label

from crowdbot.core.types.arrays import Array
from crowdbot.core.types.environment import EnvironmentParts

#: Side of a grid cell; radius of the robot for the check, m.
CELL = 0.1
#: Largest number of cells along a side; larger places get larger cells.
_MOST = 600
_BEAMS = 360


class FreeFloorGrid:
    """Grid cells of the floor within the walls that stop a robot, and a margin around them."""

    def __init__(self, parts: EnvironmentParts) -> None:
        self._parts = parts
        self._walls = parts.walls[parts.stops_robot]
        points = [self._walls.reshape(-1, 2), *parts.solids, parts.pillars[:, :2]]
        points += [np.asarray(zone) for zone in parts.zones.values()]
        if parts.periodic_boundary is not None:
            points.append(np.reshape(parts.periodic_boundary, (2, 2)).T)
        found = np.concatenate(points) if points else np.zeros((0, 2))
        self._low = found.min(axis=0) if len(found) else np.zeros(2)
        self._high = found.max(axis=0) if len(found) else np.zeros(2)
        self._cell = max(CELL, float(np.max(self._high - self._low)) / _MOST)

    def clearance(self, points: Array) -> Array:
        """Return distances (N,) from points (N, 2) to all obstacles, m; negative inside."""
        gap = np.full(len(points), np.inf)
        for x0, y0, x1, y1 in self._walls:
            gap = np.minimum(gap, _to_segment(points, (x0, y0), (x1, y1)))
        for x, y, radius in self._parts.pillars:
            gap = np.minimum(gap, np.hypot(points[:, 0] - x, points[:, 1] - y) - radius)
        for outline in self._parts.solids:
            ends = np.roll(outline, -1, axis=0)
            edges = np.array(
                [_to_segment(points, a, b) for a, b in zip(outline, ends, strict=True)]
            )
            inside = np.all(
                [_left_of(points, a, b) > 0.0 for a, b in zip(outline, ends, strict=True)], axis=0
            )
            gap = np.minimum(gap, np.where(inside, -1.0, 1.0) * edges.min(axis=0))
        return gap

    def is_free(self, point: Array) -> bool:
        """Return True if a point lies outside of all obstacles."""
        return bool(self.clearance(np.asarray(point)[None])[0] > 0.0)

    def holds(self, point: Array) -> bool:
        """Return True if a point is within the bounding box of all walls that stop a robot."""
        if not len(self._walls):
            return True
        ends = self._walls.reshape(-1, 2)
        return bool(np.all(point > ends.min(axis=0)) and np.all(point < ends.max(axis=0)))

    def cells(self) -> tuple[Array, tuple[int, int]]:
        """Return the centres (K, 2) of all cells, and their numbers along x and y."""
        margin = 3.0 * self._cell
        axes = [
            np.arange(low - margin, high + margin, self._cell)
            for low, high in zip(self._low, self._high, strict=True)
        ]
        centres = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 2)
        return centres, (len(axes[0]), len(axes[1]))

    def widest(self) -> tuple[float, float]:
        """Return the point within the walls with the most room around it."""
        centres, _ = self.cells()
        inside = np.all((centres > self._low) & (centres < self._high), axis=1)
        border = np.minimum(centres - self._low, self._high - centres).min(axis=1)
        gap = np.where(inside, np.minimum(self.clearance(centres), border), -np.inf)
        x, y = centres[int(np.argmax(gap))].tolist()
        return x, y

    @cached_property
    def _areas(self) -> tuple[Array, Array]:
        """Return the centres (nx, ny, 2) of all cells, and a number for each connected free area.

        Zero where something stands.
        """
        centres, shape = self.cells()
        numbers, _ = label((self.clearance(centres) > CELL).reshape(shape))
        return centres.reshape(*shape, 2), np.asarray(numbers)

    def way_out(self, x: float, y: float) -> tuple[float, float] | None:
        """Return where a robot that starts at a point leaves the walls' box; None if it cannot."""
        centres, areas = self._areas
        distance = np.hypot(centres[..., 0] - x, centres[..., 1] - y)
        nearest = int(np.argmin(np.where(areas > 0, distance, np.inf)))
        border = np.ones(areas.shape, np.bool_)
        border[1:-1, 1:-1] = False
        outside = border & (areas > 0) & (areas == areas.flat[nearest])
        if not outside.any():
            return None
        out = centres.reshape(-1, 2)[int(np.argmin(np.where(outside, distance, np.inf)))]
        return float(out[0]), float(out[1])


def viewpoints(parts: EnvironmentParts) -> list[tuple[float, float]]:
    """Return the centres of all zones; without zones, the point with the most room around it."""
    if parts.zones:
        return [tuple(zone.mean(axis=0).tolist()) for zone in parts.zones.values()]
    return [FreeFloorGrid(parts).widest()]


def seen_sides(parts: EnvironmentParts, x: float, y: float) -> dict[int, bool]:
    """Return row of each wall visible from a point -> True if its left side is visible."""
    sides: dict[int, bool] = {}
    angles = (np.arange(_BEAMS) + 0.5) * (2.0 * math.pi / _BEAMS)
    point = np.array([[x, y]])
    for angle in angles.tolist():
        distances = _along(parts.walls, x, y, math.cos(angle), math.sin(angle))
        if len(distances) and np.isfinite(distances.min()):
            s = int(np.argmin(distances))
            wall = parts.walls[s]
            sides[s] = bool(_left_of(point, wall[:2], wall[2:])[0] > 0.0)
    return sides


def _along(walls: Array, x: float, y: float, c: float, s: float) -> Array:
    """Return the distance (S,) along a ray to each wall, m; inf if the ray misses it."""
    ax, ay = walls[:, 0] - x, walls[:, 1] - y
    ex, ey = walls[:, 2] - walls[:, 0], walls[:, 3] - walls[:, 1]
    cross = c * ey - s * ex
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (ax * ey - ay * ex) / cross
        u = (ax * s - ay * c) / cross
        hit = (cross != 0.0) & (t > 0.0) & (u >= 0.0) & (u <= 1.0)
    return np.where(hit, t, np.inf)


def _to_segment(
    points: Array, a: Array | tuple[float, float], b: Array | tuple[float, float]
) -> Array:
    start, way = np.asarray(a), np.asarray(b) - np.asarray(a)
    share = np.clip((points - start) @ way / max(float(way @ way), 1e-300), 0.0, 1.0)
    return np.asarray(np.hypot(*(points - start - share[:, None] * way).T))


def _left_of(points: Array, a: Array, b: Array) -> Array:
    """Return positive values for points on the left of the line from a to b."""
    (ex, ey), off = b - a, points - a
    return np.asarray(ex * off[:, 1] - ey * off[:, 0])
