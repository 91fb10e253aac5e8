"""Evasion of robots that people have noticed: sideways in time, and by braking.

Computed at each decision, so that the desired acceleration plus evasion stays within human limits.
"""

from __future__ import annotations

import math

from crowdbot.core.crowd.contact.robot_contact import (
    ROBOT,
    RobotRecord,
    corners_of,
    overlap,
)
from crowdbot.core.crowd.response.notice import reacts
from crowdbot.core.crowd.response.parameters import DecisionResponse
from crowdbot.core.crowd.state import (
    People,
)
from crowdbot.core.support.compile import kernel
from crowdbot.core.support.records import Rows, as_rows
from crowdbot.core.types.arrays import Array, Mask

#: No person expects to be clear in less than this, s: one step.
_SOONEST = 0.25
#: Relative speed below which nothing happens, m/s.
_STILL = 1e-3
#: The gap in which a person has to stop is never taken for less than this, m.
_ROOM = 0.05


@kernel
def evade_robots(
    agents: People,
    radius: Array,
    heeds: Mask,
    late: Mask,
    robots: Array,
    outlines: Array,
    response: Rows[DecisionResponse],
    now: float,
) -> None:
    """Change people's desired accelerations to evade robots, in place.

    Args:
        agents: (N,) of the state; ``ax`` and ``ay`` hold what each wants without robots.
        radius: (N,) of the agents, m.
        heeds, late: (N,) True for people who notice robots at all, and for those who do late.
        robots, outlines: (R, 8), (R, K, 2) as people see them, see
            `crowdbot.core.crowd.contact.robot_contact`.
        response: `crowdbot.core.crowd.response.parameters.Human.by_decision`.
        now: time since the start, s.
    """
    seen, own = as_rows(robots, ROBOT), response[0]
    for i in range(agents.shape[0]):
        if not heeds[i]:
            if own.all_stop != 0.0:  # only of standing robots
                reacts(agents, i, radius[i], late[i], seen, outlines, own, now)
            continue
        if not reacts(agents, i, radius[i], late[i], seen, outlines, own, now):
            continue
        ex = ey = 0.0
        for r in range(seen.shape[0]):
            x, y = evasion(
                agents, i, radius[i], seen[r], outlines[r][: corners_of(outlines, r)], own
            )
            ex += x
            ey += y
        if ex != 0.0 or ey != 0.0:
            _put_first(agents, i, ex, ey, own.total)


@kernel
def _put_first(agents: People, i: int, ex: float, ey: float, most: float) -> None:
    """Add evasion to the desired acceleration.

    Opposing parts are dropped, and the sum is limited.
    """
    wx, wy = agents[i].ax, agents[i].ay
    against = min(0.0, wx * ex + wy * ey) / (ex * ex + ey * ey)
    wx += ex - against * ex
    wy += ey - against * ey
    size = math.hypot(wx, wy)
    share = most / size if size > most else 1.0
    agents[i].ax, agents[i].ay = wx * share, wy * share


@kernel
def evasion(
    agents: People,
    i: int,
    radius: float,
    robot: RobotRecord,
    outline: Array,
    response: DecisionResponse,
) -> tuple[float, float]:
    """Return the acceleration with which agent i evades a robot on a constant course, m/s^2.

    The agent's path relative to the robot is a ray. Each corner of the outline (a disc: its centre)
    has a position along and across it. The agent shifts until the outline, expanded by both radii
    and the clearance, lies beside the ray; it takes the shorter side.
    """
    wx, wy = agents[i].vx - robot.vx, agents[i].vy - robot.vy
    speed = math.hypot(wx, wy)
    if speed < _STILL:
        return 0.0, 0.0
    ux, uy = wx / speed, wy / speed
    wanted = robot.body + radius + response.clearance
    shift, along, first, last, left = _way_round(agents, i, robot, outline, ux, uy, wanted)
    if shift <= 0.0 or last <= 0.0 or first >= response.horizon * speed:
        return 0.0, 0.0
    time = max(along / speed, _SOONEST)
    need = 2.0 * shift / (time * time)
    sideways = min(need, response.lateral) * (1.0 if left else -1.0)
    ex, ey = -sideways * uy, sideways * ux
    if need > response.lateral:
        bx, by = _braking(agents, i, radius, robot, outline, response)
        ex += bx
        ey += by
    return ex, ey


@kernel
def _way_round(
    agents: People,
    i: int,
    robot: RobotRecord,
    outline: Array,
    ux: float,
    uy: float,
    wanted: float,
) -> tuple[float, float, float, float, bool]:
    """Place of an outline beside the ray of agent i.

    Args:
        ux, uy: direction of the ray.
        wanted: required distance of the outline's corners from the ray, m.

    Returns:
        required shift; position along the ray of the decisive corner; start of the expanded outline
        and position of its last corner, m; True for a shift to the left.
    """
    c, s = math.cos(robot.yaw), math.sin(robot.yaw)
    dx, dy = robot.x - agents[i].x, robot.y - agents[i].y
    left = right = last = -math.inf
    first = math.inf
    abreast_left = abreast_right = 0.0
    for k in range(max(1, outline.shape[0])):
        qx, qy = dx, dy
        if outline.shape[0] > 0:
            qx += c * outline[k, 0] - s * outline[k, 1]
            qy += s * outline[k, 0] + c * outline[k, 1]
        along, across = qx * ux + qy * uy, ux * qy - uy * qx
        if across > left:
            left, abreast_left = across, along
        if -across > right:
            right, abreast_right = -across, along
        first = min(first, along - math.sqrt(max(0.0, wanted * wanted - across * across)))
        last = max(last, along)
    if left < right:
        return left + wanted, abreast_left, first, last, True
    return right + wanted, abreast_right, first, last, False


@kernel
def _braking(
    agents: People,
    i: int,
    radius: float,
    robot: RobotRecord,
    outline: Array,
    response: DecisionResponse,
) -> tuple[float, float]:
    """Braking of agent i in front of a robot that it walks towards, m/s^2; never a step back."""
    dx, dy = robot.x - agents[i].x, robot.y - agents[i].y
    depth, nx, ny, _, _ = overlap(robot.yaw, outline, dx, dy, robot.body + radius)
    own = agents[i].vx * nx + agents[i].vy * ny
    if own <= 0.0:
        return 0.0, 0.0
    closing = own + max(0.0, -(robot.vx * nx + robot.vy * ny))
    need = 0.5 * closing * closing / max(-depth - response.stop_gap, _ROOM)
    brake = min(response.braking, need, own / response.decision)
    return -brake * nx, -brake * ny
