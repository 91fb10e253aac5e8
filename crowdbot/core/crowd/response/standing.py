"""Stopping in front of a standing robot, even if it was not noticed.

If stopping needs more than a person's usual braking, exactly the needed braking is applied. A
person whom others push against the robot leans back, the more the nearer it is.
"""

from __future__ import annotations

import math

from crowdbot.core.crowd.contact.robot_contact import (
    RobotRecord,
    corners_of,
    extent_of,
    overlap,
)
from crowdbot.core.crowd.response.parameters import TickResponse
from crowdbot.core.crowd.state import (
    People,
)
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import Rows
from crowdbot.core.types.arrays import Array

#: Farther from the outline no one has to brake yet, m: 2.4 m/s at 3 m/s^2.
FAR = 1.0
#: The gap in which a person has to stop is never taken for less than this, m.
_ROOM = 0.02


@kernel
def stop_short(
    agents: People,
    i: int,
    radius: float,
    robots: Rows[RobotRecord],
    outlines: Array,
    response: TickResponse,
) -> tuple[float, float]:
    """Return the acceleration that keeps agent i from walking into robots that stand, m/s^2.

    Args:
        robots, outlines: as in `crowdbot.core.crowd.contact.robot_contact`.
        response: `crowdbot.core.crowd.response.parameters.Human.by_tick`.
    """
    ax = ay = 0.0
    for r in range(robots.shape[0]):
        dx, dy = robots[r].x - agents[i].x, robots[r].y - agents[i].y
        reach = robots[r].body + radius
        outline = outlines[r][: corners_of(outlines, r)]
        extent = extent_of(outline)
        far = FAR + extent + reach
        if dx * dx + dy * dy > far * far:
            continue
        share = stands(robots[r], extent, response.standing_speed, response.moving_speed)
        if share == 0.0:
            continue
        depth, nx, ny, _, _ = overlap(robots[r].yaw, outline, dx, dy, reach)
        away = _away(agents, i, nx, ny, -depth, response)
        if away > 0.0:  # the desired acceleration counts where it also brakes, not where it opposes
            away = share * max(0.0, away + agents[i].ax * nx + agents[i].ay * ny)
            ax -= away * nx
            ay -= away * ny
    return ax, ay


@kernel
def stands(robot: RobotRecord, extent: float, standing: float, moving: float) -> float:
    """Return 1 for a standing robot, 0 for a moving one; slow robots have values in between.

    Args:
        extent: distance of its farthest corner from the base, m.
        standing, moving: speed limits of standing and moving, m/s.
    """
    speed = math.hypot(robot.vx, robot.vy) + abs(robot.turning) * extent
    share: float = (moving - speed) / (moving - standing)
    return min(1.0, max(0.0, share))


@kernel
def _away(
    agents: People, i: int, nx: float, ny: float, gap: float, response: TickResponse
) -> float:
    """Return the acceleration away from a standing robot in direction ``n``, m/s^2, at least 0."""
    closing = agents[i].vx * nx + agents[i].vy * ny
    room = gap - response.standing_gap
    lean = response.standing_stiffness * max(0.0, -room)
    brake = 0.5 * closing * closing / max(room, _ROOM) if closing > 0.0 else 0.0
    if brake <= response.least_braking or room < _ROOM:
        brake = 0.0
    away: float = max(lean, brake)
    return away
