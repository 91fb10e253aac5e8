"""The robot's size for planners: from their spec if given, else from the robot."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, RobotBody, kernel

#: TurtleBot2 in m, used if the planner gets no information about the robot.
ROBOT_RADIUS = 0.178


def disc_radius(spec_radius: float | None, body: RobotBody | None) -> float:
    """Return the radius of the smallest disc around the drive axis that contains the robot, m.

    Args:
        spec_radius: radius from the planner's spec, m, or None.
        body: the robot's outline.
    """
    if spec_radius is not None:
        return spec_radius
    return ROBOT_RADIUS if body is None else body.reach


def half_width_and_front(spec_radius: float | None, body: RobotBody | None) -> tuple[float, float]:
    """Return the robot's extent to either side and ahead, m; arguments as for `disc_radius`."""
    if spec_radius is not None or body is None:
        radius = disc_radius(spec_radius, body)
        return radius, radius
    return body.half_width, body.front


def swept_half_width(spec_radius: float | None, body: RobotBody | None) -> float:
    """Return half of the width that the robot sweeps, m.

    A robot that cannot go sideways turns first.

    Arguments as for `disc_radius`.
    """
    if spec_radius is not None or body is None:
        return disc_radius(spec_radius, body)
    if body.drive == "holonomic":
        return max(body.front, body.back, body.half_width)
    return body.half_width


def core_of(spec_radius: float | None, body: RobotBody | None) -> tuple[Array, float]:
    """Return the outline without its rounding, and the rounding radius, m.

    Arguments as for `disc_radius`.

    Returns:
        (K, 2) in the robot's frame: empty for a disc, the segment of a capsule, or the corners of a
        convex polygon, counter-clockwise; radius, which is 0 for a polygon.
    """
    if spec_radius is not None or body is None or body.footprint is None:
        return np.zeros((0, 2)), disc_radius(spec_radius, body)
    corners = np.array(body.footprint, dtype=np.float64)
    if len(corners) == 2:
        return corners, body.radius
    x, y = corners.T
    clockwise = float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) < 0.0
    return np.ascontiguousarray(corners[::-1] if clockwise else corners), 0.0


@kernel
def core_gap(core: Array, x: float, y: float) -> float:
    """Return the distance from a point in the robot's frame to a core, m; negative inside."""
    square, inside = math.inf, core.shape[0] > 2
    for i in range(core.shape[0] if inside else 1):
        j = (i + 1) % core.shape[0]
        ex, ey = core[j, 0] - core[i, 0], core[j, 1] - core[i, 1]
        dx, dy = x - core[i, 0], y - core[i, 1]
        if ex * dy - ey * dx < 0.0:
            inside = False
        length = ex * ex + ey * ey
        along = min(1.0, max(0.0, (dx * ex + dy * ey) / length)) if length > 0.0 else 0.0
        dx, dy = dx - along * ex, dy - along * ey
        square = min(square, dx * dx + dy * dy)
    return -math.sqrt(square) if inside else math.sqrt(square)


@kernel
def nearest_to_core(
    points: Array, core: Array, x: float, y: float, angle: float, reach: float
) -> float:
    """Return the distance from a core at a pose to the nearest of K points, m; inf without any.

    Args:
        points: (2, K) m.
        core: from `core_of`, K > 0.
        x, y, angle: the robot's pose in the frame of the points: m, rad.
        reach: distance of the core's farthest corner from its origin, m.
    """
    best, c, s = math.inf, math.cos(angle), math.sin(angle)
    for i in range(points.shape[1]):
        dx, dy = points[0, i] - x, points[1, i] - y
        far = best + reach
        if dx * dx + dy * dy < far * far:  # no other point is nearer
            best = min(best, core_gap(core, c * dx + s * dy, c * dy - s * dx))
    return best
