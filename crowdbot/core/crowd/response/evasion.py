"""Evasion of robots that people have noticed: sideways where time allows, and by braking.

Computed at each decision, so that the desired acceleration plus evasion stays within human limits.
"""

from __future__ import annotations

import math

from crowdbot.core.crowd.contact.robot_contact import (
    ROBOT,
    RobotRecord,
    corners_of,
    extent_of,
    overlap,
)
from crowdbot.core.crowd.response.notice import reacts
from crowdbot.core.crowd.response.parameters import DecisionResponse
from crowdbot.core.crowd.state import (
    People,
)
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import Rows, as_rows
from crowdbot.core.types.arrays import Array, Mask

#: No person expects to be clear in less than this, s: one step.
_SOONEST = 0.25
#: Share of a distance by which rounding may change its sign.
_ROUNDING = 1e-9
#: Relative speed below which nothing happens, m/s.
_STILL = 1e-3
#: No person wants less than this, m.
_LEAST = 0.02
#: People who hurry to pass first walk at most this much faster than they prefer: 90 % of those
#: recorded who crossed before a robot of 1 m/s (NavWareSet).
_HURRY = 1.3
#: People wait in full for vehicles that are faster than `Human.waiting_speed` by this, m/s.
_FULLY = 0.1
#: From 45 degrees between both ways on people wait, from 60 degrees on in full.
_CROSSING = 2.0
#: The gap in which a person has to stop is never taken for less than this, m.
_ROOM = 0.05


@kernel
def evade_robots(
    agents: People,
    radius: Array,
    heeds: Mask,
    late: Mask,
    room: Array,
    preferred: Array,
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
        room: (N,) from -1 to 1: how much of the range of clearances each keeps.
        preferred: (N,) preferred speeds, m/s.
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
                agents, i, radius[i], room[i], preferred[i], seen[r],
                outlines[r][: corners_of(outlines, r)], own,
            )  # fmt: skip
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
    room: float,
    preferred: float,
    robot: RobotRecord,
    outline: Array,
    response: DecisionResponse,
) -> tuple[float, float]:
    """Return the acceleration with which agent i evades a robot on a constant course, m/s^2."""
    if response.speeding_up == math.inf:
        return _sidestep(agents, i, radius, room, robot, outline, response, 0.0)
    fx, fy = agents[i].dir_x, agents[i].dir_y
    forward = max(0.0, response.intent * (agents[i].ax * fx + agents[i].ay * fy))
    ex, ey = _sidestep(agents, i, radius, room, robot, outline, response, forward)
    own = max(0.0, agents[i].vx * fx + agents[i].vy * fy)
    along = ex * fx + ey * fy
    if along * response.decision < -own:  # a step back, but not from a robot that passes by
        ex, ey = _sidestep(agents, i, radius, room, robot, outline, response, 0.0)
        if ex == 0.0 and ey == 0.0:
            ex, ey = -own / response.decision * fx, -own / response.decision * fy
        return ex, ey
    most = response.speeding_up if own < _HURRY * preferred else 0.0
    spare = max(0.0, along - most)
    return ex - spare * fx, ey - spare * fy


@kernel
def _sidestep(
    agents: People,
    i: int,
    radius: float,
    room: float,
    robot: RobotRecord,
    outline: Array,
    response: DecisionResponse,
    forward: float,
) -> tuple[float, float]:
    """Return the acceleration that brings agent i past a robot on a constant course, m/s^2.

    The agent's path relative to the robot is a ray. Each corner of the outline (a disc: its centre)
    has a position along and across it. The agent shifts until the outline, expanded by both radii
    and the clearance, lies beside the ray; it takes the shorter side, or gives way.

    Args:
        forward: speed that the agent is about to gain, m/s: a waiting agent expects to walk on.
    """
    wx, wy = agents[i].vx - robot.vx, agents[i].vy - robot.vy
    if forward > 0.0:
        wx += forward * agents[i].dir_x
        wy += forward * agents[i].dir_y
    if _recedes(agents, i, robot, outline, wx, wy):
        return 0.0, 0.0
    speed = math.hypot(wx, wy)
    if speed < _STILL:
        return 0.0, 0.0
    ux, uy = wx / speed, wy / speed
    gap, extra = clearance(room, robot, response)
    clear = robot.body + radius + gap
    give_way, behind = _give_way(robot, ux, uy, extra, response)
    waits = math.copysign(_waits(agents, i, robot, response), give_way)
    shift, along, first, last, left = _way_round(
        agents, i, robot, outline, ux, uy, clear, give_way, behind, waits
    )
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
def _recedes(
    agents: People, i: int, robot: RobotRecord, outline: Array, wx: float, wy: float
) -> bool:
    """Return True if all of a robot is behind agent i on its relative way; takes no square root.

    Args:
        wx, wy: velocity relative to the robot, m/s.
    """
    dx, dy = robot.x - agents[i].x, robot.y - agents[i].y
    behind = extent_of(outline) + _ROUNDING * (abs(dx) + abs(dy))
    return dx * wx + dy * wy < -behind * (abs(wx) + abs(wy))


@kernel
def clearance(room: float, robot: RobotRecord, response: DecisionResponse) -> tuple[float, float]:
    """Return the gap that a person wants to a robot, and the part of it for its speed, m.

    Args:
        room: from -1 to 1, the person's share of the range.
    """
    gap: float = response.clearance
    if response.clearance_range != 0.0:
        gap = max(_LEAST, gap + room * float(response.clearance_range))
    if response.clearance_growth == 0.0:
        return gap, 0.0
    speed = math.hypot(robot.vx, robot.vy)
    extra = response.clearance_growth * max(0.0, speed - response.clearance_speed)
    extra = min(extra, max(0.0, float(response.most_clearance - gap)))
    return gap + extra, extra


@kernel
def _give_way(
    robot: RobotRecord, ux: float, uy: float, extra: float, response: DecisionResponse
) -> tuple[float, float]:
    """Return the longer way that a person accepts to pass behind a crossing robot, m.

    Args:
        ux, uy: direction of the person relative to the robot.
        extra: clearance for the robot's speed, m.

    Returns:
        the extra way, positive if behind is on the left, negative if on the right; and by how much
        the clearance behind the robot exceeds that in front, m: people wait for vehicles.
    """
    if response.yield_time == 0.0:
        return 0.0, 0.0
    speed = max(math.hypot(robot.vx, robot.vy), _STILL)
    across = (robot.vx * uy - robot.vy * ux) / speed
    way = response.yield_time * speed
    behind = response.yield_time * max(0.0, speed - response.clearance_speed)
    return across * (way + 2.0 * extra), abs(across) * behind


@kernel
def _waits(agents: People, i: int, robot: RobotRecord, response: DecisionResponse) -> float:
    """Return how far agent i waits for a fast crossing robot whatever its length, 0 to 1.

    This is the share of the robot's extent that does not count as a detour; 0 for slow robots, and
    for paths within 45 degrees of parallel.
    """
    speed2 = robot.vx * robot.vx + robot.vy * robot.vy
    if speed2 <= response.waiting_speed * response.waiting_speed:
        return 0.0
    along = robot.vx * agents[i].dir_x + robot.vy * agents[i].dir_y
    crossing = 1.0 - 2.0 * along * along / speed2
    fast = (math.sqrt(speed2) - response.waiting_speed) / _FULLY
    return min(1.0, fast) * min(1.0, max(0.0, _CROSSING * crossing))


@kernel
def _way_round(
    agents: People,
    i: int,
    robot: RobotRecord,
    outline: Array,
    ux: float,
    uy: float,
    clear: float,
    give_way: float,
    behind: float,
    waits: float,
) -> tuple[float, float, float, float, bool]:
    """Return where a robot's outline lies beside the ray of agent i, and the shift to pass it.

    Args:
        ux, uy: direction of the ray.
        clear: required distance of the outline's corners from the ray, m.
        give_way: extra way, m, that the agent accepts to pass on the left; negative: on the right.
        behind: extra distance if it passes on the side where it gives way, m.
        waits: share of the outline's extent that is added to ``give_way``, with its sign.

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
        first = min(first, along - math.sqrt(max(0.0, clear * clear - across * across)))
        last = max(last, along)
    if left < right + give_way + waits * (left + right):
        return left + clear + (behind if give_way > 0.0 else 0.0), abreast_left, first, last, True
    return right + clear + (behind if give_way < 0.0 else 0.0), abreast_right, first, last, False


@kernel
def _braking(
    agents: People,
    i: int,
    radius: float,
    robot: RobotRecord,
    outline: Array,
    response: DecisionResponse,
) -> tuple[float, float]:
    """Return the braking of agent i in front of a robot on its way, m/s^2; never a step back."""
    dx, dy = robot.x - agents[i].x, robot.y - agents[i].y
    depth, nx, ny, _, _ = overlap(robot.yaw, outline, dx, dy, robot.body + radius)
    own = agents[i].vx * nx + agents[i].vy * ny
    if own <= 0.0:
        return 0.0, 0.0
    closing = own + max(0.0, -(robot.vx * nx + robot.vy * ny))
    need = 0.5 * closing * closing / max(-depth - response.stop_gap, _ROOM)
    brake = min(response.braking, need, own / response.decision)
    return -brake * nx, -brake * ny
