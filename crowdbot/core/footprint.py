"""The outline of a robot that is no disc: a polygon or a capsule, in the robot's own frame, m."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from crowdbot.core.trajectory import Array, Trajectories


@dataclass(frozen=True, slots=True)
class Footprint:
    """All points within ``radius`` of a filled polygon, or of a segment.

    Attributes:
        corners: (K, 2), m; K = 2 is a segment.
        radius: m; 0 for a polygon.
    """

    corners: Array
    radius: float

    def gap(self, x: Array, y: Array) -> Array:
        """Distance of points from the outline, m; negative inside. NaN where unknown."""
        nearest = np.full(np.shape(x), np.inf)
        inside = np.zeros(np.shape(x), dtype=bool)
        for (ax, ay), (bx, by) in self._edges():
            nearest = np.minimum(nearest, _to_segment(x - ax, y - ay, bx - ax, by - ay))
            if ay != by and len(self.corners) > 2:  # even-odd rule
                between = (ay > y) != (by > y)
                inside ^= between & (x < ax + (y - ay) * (bx - ax) / (by - ay))
        return np.where(inside, -nearest, nearest) - self.radius

    def first_touch(self, x: Array, y: Array, dx: Array, dy: Array, reach: Array) -> Array:
        """Least s >= 0 at which a disc of radius ``reach`` at (x + s dx, y + s dy) touches.

        inf where it never does; meaningless where it touches at s = 0 already.
        """
        limit = np.broadcast_to(reach + self.radius, x.shape)
        first = np.full(x.shape, np.inf)
        with np.errstate(over="ignore", invalid="ignore"):  # all but standing still: never
            for (ax, ay), (bx, by) in self._edges():
                for px, py in ((ax, ay), (bx, by)):
                    first = np.minimum(first, _to_disc(x - px, y - py, dx, dy, limit))
                edge = bx - ax, by - ay
                first = np.minimum(first, _to_side(x - ax, y - ay, dx, dy, limit, edge))
        return first

    def _edges(self) -> Iterator[tuple[Array, Array]]:
        last = len(self.corners) if len(self.corners) > 2 else 1
        for i in range(last):
            yield self.corners[i], self.corners[(i + 1) % len(self.corners)]


def footprint_of(run: Trajectories) -> Footprint | None:
    """The outline of a run's robot; None for a disc, or without robot."""
    if run.robot is None or run.robot_footprint is None:
        return None
    capsule = len(run.robot_footprint) == 2
    return Footprint(run.robot_footprint, run.robot.radius if capsule else 0.0)


def into_frame(theta: Array, x: Array, y: Array) -> tuple[Array, Array]:
    """World vectors (N, M) in frames with headings ``theta`` (N,), rad."""
    c, s = np.cos(theta)[:, None], np.sin(theta)[:, None]
    return c * x + s * y, c * y - s * x


def _to_segment(x: Array, y: Array, ex: float, ey: float) -> Array:
    """Distance of points from the segment (0, 0) to (ex, ey), m."""
    square = ex * ex + ey * ey
    along = np.clip((x * ex + y * ey) / square, 0.0, 1.0) if square > 0 else np.zeros(np.shape(x))
    distance: Array = np.hypot(x - along * ex, y - along * ey)
    return distance


def _to_disc(x: Array, y: Array, dx: Array, dy: Array, radius: Array) -> Array:
    """When a moving point reaches a disc around the origin; inf if never."""
    approach = -(x * dx + y * dy)
    under = radius**2 * (dx**2 + dy**2) - (x * dy - y * dx) ** 2
    distance = np.hypot(x, y)
    hits = (approach > 0) & (under >= 0)
    root = np.sqrt(np.where(hits, under, 0.0))
    gap = (distance - radius) * (distance + radius)
    out = np.full(x.shape, np.inf)
    np.divide(gap, approach + root, out=out, where=hits & (gap >= 0))
    return out


def _to_side(
    x: Array, y: Array, dx: Array, dy: Array, radius: Array, edge: tuple[float, float]
) -> Array:
    """When a moving point reaches a side ``radius`` off an edge from the origin; inf if never."""
    length = float(np.hypot(*edge))
    if length == 0:
        return np.full(x.shape, np.inf)
    ex, ey = edge[0] / length, edge[1] / length
    off, speed = ex * y - ey * x, ex * dy - ey * dx
    out = np.full(x.shape, np.inf)
    approaches = (off * speed < 0) & (np.abs(off) >= radius)
    s = np.divide(np.abs(off) - radius, np.abs(speed), out=out, where=approaches)
    along = (x + np.where(approaches, s, 0.0) * dx) * ex + (
        y + np.where(approaches, s, 0.0) * dy
    ) * ey
    return np.where((along >= 0) & (along <= length), s, np.inf)
