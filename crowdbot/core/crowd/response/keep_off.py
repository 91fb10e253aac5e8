"""The response to robots before 2026-11-22: a force inside the perceived disc."""

from __future__ import annotations

import math

from crowdbot.core.crowd.contact.robot_contact import R_SEEN, RVX, RVY, RX, RY
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
    agents: Array, i: int, radius: Array, robots: Array, response: Array
) -> tuple[float, float]:
    """Steering away from robots (m/s^2): behaviour of people who heed them, felt by them alone.

    Args:
        response: `crowdbot.core.crowd.response.parameters.KeepOff.by_tick`.
    """
    ax = ay = 0.0
    for r in range(robots.shape[0]):
        dx, dy = agents[i, X] - robots[r, RX], agents[i, Y] - robots[r, RY]
        reach = robots[r, R_SEEN] + radius[i]
        d2 = dx * dx + dy * dy
        if d2 >= reach * reach or d2 == 0.0:
            continue
        distance = math.sqrt(d2)
        moving = min(1.0, math.hypot(robots[r, RVX], robots[r, RVY]) / response[SLOW_SPEED])
        stopped, most = response[STIFFNESS_STOPPED], response[STIFFNESS_MOVING]
        push = (stopped + (most - stopped) * moving) * (reach - distance)
        ax += push * dx / distance
        ay += push * dy / distance
    return ax, ay
