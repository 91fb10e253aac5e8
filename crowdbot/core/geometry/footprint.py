"""The outline of a robot that is not a disc: a polygon or a capsule, in the robot's frame, m."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from crowdbot.core.types.arrays import Array

if TYPE_CHECKING:
    from crowdbot.core.types.robot import RobotModel

_STRAIGHT = 1e-12  # rad; a corner on an edge may turn back by rounding


@dataclass(frozen=True, slots=True)
class Footprint:
    """All points within ``radius`` of a filled polygon, of a segment, or of the origin.

    Attributes:
        corners: (K, 2), m; K = 2 is a segment, K = 0 the origin, which makes a disc.
        radius: m; 0 for a polygon.
    """

    corners: Array
    radius: float

    @property
    def reach(self) -> float:
        """Return the distance of its farthest point from the origin, m."""
        return float(np.max(np.hypot(*self.corners.T), initial=0.0)) + self.radius

    def outline(self, x: float, y: float, yaw: float, steps: int = 24) -> Array:
        """Return points (N, 2) of the outline at a pose, m, counter-clockwise; none for a disc.

        Args:
            steps: points on the circle that the rounding of a capsule is made of.
        """
        points = self.corners
        if len(points) == 2:
            (ax, ay), (bx, by) = points
            across = math.atan2(by - ay, bx - ax) + 0.5 * math.pi
            half = np.linspace(across, across + math.pi, steps // 2 + 1)
            arc = self.radius * np.column_stack([np.cos(half), np.sin(half)])
            points = np.concatenate([points[0] + arc, points[1] - arc])
        c, s = math.cos(yaw), math.sin(yaw)
        placed: Array = np.array([x, y]) + points @ np.array([[c, s], [-s, c]])
        return placed

    def gap(self, x: Array, y: Array) -> Array:
        """Return distances of points from the outline, m; negative inside, NaN for NaN."""
        nearest = np.full(np.shape(x), np.inf)
        inside = np.zeros(np.shape(x), dtype=bool)
        for (ax, ay), (bx, by) in self._edges():
            nearest = np.minimum(nearest, _to_segment(x - ax, y - ay, bx - ax, by - ay))
            if ay != by and len(self.corners) > 2:  # even-odd rule
                between = (ay > y) != (by > y)
                inside ^= between & (x < ax + (y - ay) * (bx - ax) / (by - ay))
        return np.where(inside, -nearest, nearest) - self.radius

    def first_touch(self, x: Array, y: Array, dx: Array, dy: Array, reach: Array) -> Array:
        """Return the least s >= 0 at which a moving disc of radius ``reach`` touches; inf if never.

        Its centre is (x + s dx, y + s dy). The result is undefined if it touches at s = 0 already.
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
        """Yield the ends of each edge; of a disc, its centre twice."""
        corners = self.corners if len(self.corners) else np.zeros((1, 2))
        last = len(corners) if len(corners) > 2 else 1
        for i in range(last):
            yield corners[i], corners[(i + 1) % len(corners)]


def footprint_of_model(robot: RobotModel) -> Footprint:
    """Return the outline of a robot, corners of a polygon counter-clockwise; a disc has none.

    Raises:
        ValueError: it is neither a segment nor a convex polygon.
    """
    if robot.footprint is None:
        return Footprint(np.zeros((0, 2)), robot.footprint_radius)
    corners = np.ascontiguousarray(robot.footprint, np.float64)
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 2:
        raise ValueError(f"a footprint has shape (K, 2), K >= 2, not {corners.shape}")
    if not np.all(np.isfinite(corners)):
        raise ValueError("the footprint has corners that are not finite")
    if len(corners) == 2:
        return Footprint(corners, robot.footprint_radius)
    turns = _turns(corners)
    if np.sum(turns) < 0.0:
        corners, turns = np.ascontiguousarray(corners[::-1]), -turns[::-1]
    # One that crosses itself may turn left at all corners, but then goes round more than once.
    onwards = np.all((turns > -_STRAIGHT) & (turns < math.pi - _STRAIGHT))
    if not (onwards and math.isclose(np.sum(turns), 2.0 * math.pi)):
        raise ValueError("the footprint is not a convex polygon: its edges turn back or cross")
    return Footprint(corners, 0.0)


def _turns(corners: Array) -> Array:
    """Return the turn after each edge, rad, positive to the left; 0 for edges without length."""
    edge = np.roll(corners, -1, axis=0) - corners
    edge = edge[np.any(edge != 0.0, axis=1)]
    following = np.roll(edge, -1, axis=0)
    across = edge[:, 0] * following[:, 1] - edge[:, 1] * following[:, 0]
    along = np.sum(edge * following, axis=1)
    return np.asarray(np.arctan2(across, along))


def body_side(bearing: float) -> str:
    """Return the side of a robot in a direction: front, left, right or rear; of NaN, unknown.

    Args:
        bearing: of a point in the robot's frame, rad; each side has a quarter of the circle.
    """
    if not math.isfinite(bearing):
        return "unknown"
    angle = math.remainder(bearing, 2.0 * math.pi)
    if abs(angle) <= 0.25 * math.pi:
        return "front"
    if abs(angle) >= 0.75 * math.pi:
        return "rear"
    return "left" if angle > 0.0 else "right"


def into_frame(theta: Array, x: Array, y: Array) -> tuple[Array, Array]:
    """Return world vectors (N, M) in frames with headings ``theta`` (N,), rad."""
    c, s = np.cos(theta)[:, None], np.sin(theta)[:, None]
    return c * x + s * y, c * y - s * x


def _to_segment(x: Array, y: Array, ex: float, ey: float) -> Array:
    """Return the distance of points from the segment (0, 0) to (ex, ey), m."""
    square = ex * ex + ey * ey
    along = np.clip((x * ex + y * ey) / square, 0.0, 1.0) if square > 0 else np.zeros(np.shape(x))
    distance: Array = np.hypot(x - along * ex, y - along * ey)
    return distance


def _to_disc(x: Array, y: Array, dx: Array, dy: Array, radius: Array) -> Array:
    """Return when a moving point reaches a disc around the origin; inf if never."""
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
    """Return when a moving point is ``radius`` away from an edge at the origin; inf if never."""
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
