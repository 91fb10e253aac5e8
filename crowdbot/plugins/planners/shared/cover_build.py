"""The robot's outline as a few discs, which rollouts test against people and walls; compiled."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, RobotBody
from crowdbot.plugins.planners.shared.robot_outline_build import ROBOT_RADIUS

#: Most discs.
_MOST = 5


def covering_discs(spec_radius: float | None, body: RobotBody | None) -> Array:
    """Return discs (K, 3) that together cover the robot: x, y of the centre and radius, m.

    One disc for a round robot; otherwise discs along the longer side of the box around its outline,
    which exceed the box by a few centimetres.

    Args:
        spec_radius: radius from the planner's spec, m, or None.
        body: the robot's outline, or None.
    """
    if spec_radius is not None or body is None:
        return np.array([[0.0, 0.0, ROBOT_RADIUS if spec_radius is None else spec_radius]])
    if body.footprint is None:
        return np.array([[0.0, 0.0, body.radius]])
    if len(body.footprint) == 2:
        return _along(np.asarray(body.footprint), body.radius)
    long, wide = body.front + body.back, 2.0 * body.half_width
    middle = 0.5 * (body.front - body.back)
    swap = wide > long
    if swap:
        long, wide = wide, long
    count = min(_MOST, max(1, math.ceil(1.6 * long / wide)))
    piece = long / count
    at = (np.arange(count) + 0.5) * piece - 0.5 * long
    radius = np.full(count, math.hypot(0.5 * piece, 0.5 * wide))
    if swap:
        return np.column_stack([np.full(count, middle), at, radius])
    return np.column_stack([middle + at, np.zeros(count), radius])


def _along(segment: Array, radius: float) -> Array:
    """Return discs along the segment of a capsule, as wide as it and a little more."""
    long = float(np.hypot(*(segment[1] - segment[0])))
    count = min(_MOST, max(2, math.ceil(long / radius) + 1))
    share = np.linspace(0.0, 1.0, count)[:, None]
    gap = long / (count - 1)
    wide = math.hypot(radius, 0.5 * gap) if gap > 0.0 else radius
    return np.column_stack([segment[0] + share * (segment[1] - segment[0]), np.full(count, wide)])
