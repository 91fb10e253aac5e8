"""Notice: people who have noticed a robot, and since when."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.contact.robot_contact import (
    RobotRecord,
    corners_of,
    extent_of,
    overlap,
)
from crowdbot.core.crowd.response.parameters import DecisionResponse, Human
from crowdbot.core.crowd.response.standing import FAR, stands
from crowdbot.core.crowd.state import (
    PRESENT,
    UNAWARE,
    People,
)
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import Rows
from crowdbot.core.types.arrays import Array

#: No person comes nearer to a robot faster than this, m/s.
_FASTEST = 5.0
#: A bound times this stays one after rounding.
_ROUNDED = 1.0 + 1e-9


@kernel
def reacts(
    agents: People,
    i: int,
    radius: float,
    late: bool,
    robots: Rows[RobotRecord],
    outlines: Array,
    response: DecisionResponse,
    now: float,
) -> bool:
    """Return True if agent i noticed robots longer ago than its reaction time; updates its state.

    An agent that has noticed one robot watches all, until none is within sight.

    Args:
        radius: of the agent, m.
        late: True if the agent notices late.
        robots, outlines: as in `crowdbot.core.crowd.contact.robot_contact`.
        response: `crowdbot.core.crowd.response.parameters.Human.by_decision`.
        now: time since the start, s.
    """
    near, found = False, False
    agents[i].beside = 0.0
    if agents[i].waiting == PRESENT:
        for r in range(robots.shape[0]):
            dx, dy = robots[r].x - agents[i].x, robots[r].y - agents[i].y
            reach, outline = robots[r].body + radius, outlines[r][: corners_of(outlines, r)]
            away2, around = dx * dx + dy * dy, extent_of(outline) + reach
            if away2 < (FAR + _FASTEST * response.decision + around) ** 2:
                agents[i].beside = 1.0
            if away2 > (_farthest_sight(agents, i, robots[r], response) + around) ** 2:
                continue
            sight = _sight(agents, i, robots[r], response)
            if away2 > (sight + around) ** 2:
                continue
            depth, nx, ny, _, _ = overlap(robots[r].yaw, outline, dx, dy, reach)
            if depth < -sight:
                continue
            near = True
            if agents[i].noticed == UNAWARE and not found:
                found = _sees(agents, i, late, robots[r], -depth, nx, ny, response)
    if not near:
        agents[i].noticed = UNAWARE
    elif found:
        agents[i].noticed = now
    noticed: float = agents[i].noticed
    return noticed != UNAWARE and now - noticed >= float(response.reaction_time)


@kernel
def _farthest_sight(
    agents: People, i: int, robot: RobotRecord, response: DecisionResponse
) -> float:
    """Return an upper bound of `_sight`, computed without a square root, m."""
    speed = abs(robot.vx) + abs(robot.vy) + abs(agents[i].vx) + abs(agents[i].vy)
    return max(float(response.sight), float(_ROUNDED * response.sight_time * speed))


@kernel
def _sight(agents: People, i: int, robot: RobotRecord, response: DecisionResponse) -> float:
    """Return the gap within which agent i may notice a robot, m: farther the faster both move."""
    if response.sight_time == 0.0:
        return response.sight
    speed = math.hypot(robot.vx, robot.vy) + math.hypot(agents[i].vx, agents[i].vy)
    return max(float(response.sight), float(response.sight_time * speed))


@kernel
def _sees(
    agents: People,
    i: int,
    late: bool,
    robot: RobotRecord,
    gap: float,
    nx: float,
    ny: float,
    response: DecisionResponse,
) -> bool:
    """Return True if agent i notices a robot within sight, in the direction n, now."""
    closing = (agents[i].vx - robot.vx) * nx + (agents[i].vy - robot.vy) * ny
    if nx * agents[i].dir_x + ny * agents[i].dir_y < response.view_cosine:
        # what is behind is not seen, but vehicles are heard
        loud = math.hypot(robot.vx, robot.vy) > response.clearance_speed
        return loud and gap < response.hearing_time * closing
    if not late:
        return True
    share = stands(robot, 0.0, response.seen_standing, response.seen_moving)
    time = response.late_time + share * (response.late_time_standing - response.late_time)
    return gap < max(float(response.late_gap), float(time * closing))


def notice_time(agents: Agents, response: Human) -> Array:
    """Return (N,) the time to contact from which people respond to a robot that moves, s.

    Infinite for those who notice it as soon as it is within sight, 0 for those who never do.
    """
    late = np.where(agents.late, max(0.0, response.late_time - response.reaction_time), math.inf)
    return np.where(agents.ignores_robot, 0.0, late)
