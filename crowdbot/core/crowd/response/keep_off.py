"""The response to robots before 2026-11-22: a force within a margin around the outline."""

from __future__ import annotations

import math

from crowdbot.core.crowd.contact.robot_contact import (
    R_SEEN,
    RVX,
    RVY,
    RX,
    RY,
    corners_of,
    extent_of,
    overlap,
)
from crowdbot.core.crowd.response.parameters import (
    SLOW_SPEED,
    STIFFNESS_MOVING,
    STIFFNESS_STOPPED,
)
from crowdbot.core.crowd.state import X, Y
from crowdbot.core.support.compile import kernel
from crowdbot.core.types.arrays import Array


@kernel
def keep_off(
    agents: Array, i: int, radius: Array, robots: Array, outlines: Array, response: Array
) -> tuple[float, float]:
    """Steering away from robots (m/s^2): behaviour of people who heed them, felt by them alone.

    Args:
        robots, outlines: as in `crowdbot.core.crowd.contact.robot_contact`. The margin is what
            the perceived disc has beyond the disc that holds the robot.
        response: `crowdbot.core.crowd.response.parameters.KeepOff.by_tick`.
    """
    ax = ay = 0.0
    for r in range(robots.shape[0]):
        dx, dy = agents[i, X] - robots[r, RX], agents[i, Y] - robots[r, RY]
        reach = robots[r, R_SEEN] + radius[i]
        d2 = dx * dx + dy * dy
        outline = outlines[r][: corners_of(outlines, r)]
        if d2 >= reach * reach or (d2 == 0.0 and outline.shape[0] == 0):
            continue
        if outline.shape[0] == 0:
            length = math.sqrt(d2)
            depth = reach - length
        else:
            # The row's reach is from the base: to the farthest corner, its rounding, the margin.
            depth, nx, ny, _, _ = overlap(robots[r], outline, -dx, -dy, reach - extent_of(outline))
            dx, dy, length = -nx, -ny, 1.0
        if depth <= 0.0:
            continue
        moving = min(1.0, math.hypot(robots[r, RVX], robots[r, RVY]) / response[SLOW_SPEED])
        stopped, most = response[STIFFNESS_STOPPED], response[STIFFNESS_MOVING]
        push = (stopped + (most - stopped) * moving) * depth
        ax += push * dx / length
        ay += push * dy / length
    return ax, ay
