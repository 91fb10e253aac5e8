"""How people stop short of a robot that stands, whether they have looked at it or not.

Who would have to brake harder than people do by choice is braked as hard as it takes, no harder:
a last step. Who is pushed against the robot by others leans back, the harder the nearer.
"""

from __future__ import annotations

import math

from crowdbot.core.crowd.contact.robot_contact import (
    R_BODY,
    R_W,
    RVX,
    RVY,
    RX,
    RY,
    corners_of,
    extent_of,
    overlap,
)
from crowdbot.core.crowd.response.parameters import (
    LEAST_BRAKING,
    MOVING_SPEED,
    STANDING_GAP,
    STANDING_SPEED,
    STANDING_STIFFNESS,
)
from crowdbot.core.crowd.state import AX, AY, VX, VY, X, Y
from crowdbot.core.support.compile import kernel
from crowdbot.core.types.arrays import Array

#: Farther from the outline nobody has to brake yet, m: 2.4 m/s at 3 m/s^2.
FAR = 1.0
#: The gap in which somebody has to stop is never taken for less than this, m.
_ROOM = 0.02


@kernel
def stop_short(
    agents: Array, i: int, radius: Array, robots: Array, outlines: Array, response: Array
) -> tuple[float, float]:
    """What agent i adds to its own will beside robots that stand, m/s^2.

    Args:
        robots, outlines: as in `crowdbot.core.crowd.contact.robot_contact`.
        response: `crowdbot.core.crowd.response.parameters.Human.by_tick`.
    """
    ax = ay = 0.0
    for r in range(robots.shape[0]):
        dx, dy = robots[r, RX] - agents[i, X], robots[r, RY] - agents[i, Y]
        reach = robots[r, R_BODY] + radius[i]
        outline = outlines[r][: corners_of(outlines, r)]
        extent = extent_of(outline)
        far = FAR + extent + reach
        if dx * dx + dy * dy > far * far:
            continue
        share = stands(robots[r], extent, response[STANDING_SPEED], response[MOVING_SPEED])
        if share == 0.0:
            continue
        depth, nx, ny, _, _ = overlap(robots[r], outline, dx, dy, reach)
        away = _away(agents, i, nx, ny, -depth, response)
        if away > 0.0:  # what own will does in the same direction counts, what it undoes does not
            away = share * max(0.0, away + agents[i, AX] * nx + agents[i, AY] * ny)
            ax -= away * nx
            ay -= away * ny
    return ax, ay


@kernel
def stands(robot: Array, extent: float, standing: float, moving: float) -> float:
    """1 for a robot that stands, 0 for one that moves, between the two in between.

    Args:
        extent: distance of its farthest corner from the base, m.
        standing, moving: speeds below and above which it does, m/s.
    """
    speed = math.hypot(robot[RVX], robot[RVY]) + abs(robot[R_W]) * extent
    share: float = (moving - speed) / (moving - standing)
    return min(1.0, max(0.0, share))


@kernel
def _away(agents: Array, i: int, nx: float, ny: float, gap: float, response: Array) -> float:
    """Least acceleration away from a standing robot that ``n`` points to, m/s^2; 0: none."""
    closing = agents[i, VX] * nx + agents[i, VY] * ny
    room = gap - response[STANDING_GAP]
    lean = response[STANDING_STIFFNESS] * max(0.0, -room)
    brake = 0.5 * closing * closing / max(room, _ROOM) if closing > 0.0 else 0.0
    if brake <= response[LEAST_BRAKING] or room < _ROOM:
        brake = 0.0
    away: float = max(lean, brake)
    return away
