"""The joint density of paths of robot, user, planner and people; compiled."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, array_kernel, kernel
from crowdbot.plugins.planners.shared.follow_velocity_build import slewed

#: Time between the points of a way at which densities are compared, s.
STEP = 0.25
#: Indices into the parameter vector.
(
    HORIZON,
    AGREEABILITY,
    USER_SPREAD,
    ROBOT_SPREAD,
    PEOPLE_SPREAD,
    AVOIDANCE,
    SAFETY,
    FRONT,
    A_MAX,
    ALPHA_MAX,
    STANDING,
) = range(11)
PARAMETERS = 11
#: Velocities of a person in each direction, and how many spreads they reach from the present one.
_WAYS, _SPAN = 5, 2.0
#: Gaps beyond this multiple of `SAFETY` play no part; the smallest density of people.
_FAR, _TINY = 4.0, 1e-300
#: From this speed of the robot on, m/s, a contact counts whole.
_GOING = 0.5


@kernel
def _advanced(
    x: float, y: float, yaw: float, v: float, w: float, vy: float
) -> tuple[float, float, float]:
    """Return the pose one step later on the arc of a command."""
    middle = yaw + 0.5 * w * STEP
    c, s = math.cos(middle), math.sin(middle)
    return x + (c * v - s * vy) * STEP, y + (s * v + c * vy) * STEP, yaw + w * STEP


@kernel
def _apart(one: Array, other: Array, front: float) -> float:
    """Return the squared distance of the robot's front at two poses, m^2: turns count, too."""
    dx = one[0] - other[0] + front * (math.cos(one[2]) - math.cos(other[2]))
    dy = one[1] - other[1] + front * (math.sin(one[2]) - math.sin(other[2]))
    return float(dx * dx + dy * dy)


@kernel
def _nearest(discs: Array, x: float, y: float, radius: float, far: float) -> tuple[float, float]:
    """Return the gap of robot and body, at most ``far``, and how far the robot moved there; m.

    Args:
        discs: (K, 4) as in `_placed`.
        x, y, radius: of the body, m.
        far: m.
    """
    gap, moved = far, 0.0
    for k in range(discs.shape[0]):
        dx, dy = x - discs[k, 0], y - discs[k, 1]
        near = gap + discs[k, 2] + radius
        if dx * dx + dy * dy < near * near:
            gap = math.sqrt(dx * dx + dy * dy) - discs[k, 2] - radius
            moved = discs[k, 3]
    return gap, moved


@kernel
def _free(gap: float, p: Array) -> float:
    """Return 1 less the interaction at a gap, m: almost 0 from the touch on."""
    return float(1.0 - p[AVOIDANCE] * math.exp(-0.5 * (max(gap, 0.0) / p[SAFETY]) ** 2))


@kernel
def _passing(body: Array, discs: Array, aside: tuple[float, float], p: Array) -> float:
    """Return the interaction of the robot's path with one path of a person: a product over time.

    Bodies do not pass through each other: once in contact, they count as in contact until the path
    ends. Otherwise a path would be the more likely the faster it leads through a person. Where the
    robot stands a contact counts less, since people walk round it.

    Args:
        body: (5,) x, y, vx, vy, radius.
        discs: (T, K, 4) as in `_placed`.
        aside: by how much the person goes otherwise than now, m/s.
        p: parameters.
    """
    product, touching, far = 1.0, 0.0, _FAR * p[SAFETY]
    for i in range(discs.shape[0]):
        free = touching
        if touching == 0.0:
            t = (i + 1) * STEP
            x, y = body[0] + t * (body[2] + aside[0]), body[1] + t * (body[3] + aside[1])
            gap, moved = _nearest(discs[i], x, y, body[4], far)
            if gap >= far:
                continue
            free = _free(gap, p)
            if gap <= 0.0:
                going = min(1.0, moved / (_GOING * STEP))
                free = touching = math.pow(free, p[STANDING] + (1.0 - p[STANDING]) * going)
        product *= free
    return product


@kernel
def _can_meet(body: Array, discs: Array, p: Array) -> bool:
    """Return True if one of a person's possible paths comes near the robot's."""
    for i in range(discs.shape[0]):
        t = (i + 1) * STEP
        wide = _FAR * p[SAFETY] + math.sqrt(2.0) * _SPAN * p[PEOPLE_SPREAD] * t + body[4]
        for k in range(discs.shape[1]):
            dx = body[0] + t * body[2] - discs[i, k, 0]
            dy = body[1] + t * body[3] - discs[i, k, 1]
            if dx * dx + dy * dy < (wide + discs[i, k, 2]) ** 2:
                return True
    return False


@kernel
def _person(body: Array, discs: Array, p: Array) -> float:
    """Return the log of the interaction of a way with a person: the mean over the person's ways.

    Their velocities have a Gaussian around the present one. So a way on which the person can still
    step aside is likely, the less so the farther, and one that none of the person's ways leaves
    free is not.
    """
    if not _can_meet(body, discs, p):
        return 0.0
    total, weights = 0.0, 0.0
    for j in range(_WAYS):
        for k in range(_WAYS):
            a, b = _SPAN * (2.0 * j / (_WAYS - 1) - 1.0), _SPAN * (2.0 * k / (_WAYS - 1) - 1.0)
            weight = math.exp(-0.5 * (a * a + b * b))
            aside = (a * p[PEOPLE_SPREAD], b * p[PEOPLE_SPREAD])
            total += weight * _passing(body, discs, aside, p)
            weights += weight
    return math.log(max(total / weights, _TINY))


@kernel
def _still(bodies: Array, discs: Array, p: Array) -> float:
    """Return the log of the interaction of a path with the nearest static obstacle in each step."""
    total, least, touched = 0.0, 1.0 - p[AVOIDANCE], False
    for i in range(discs.shape[0]):
        free = least if touched else 1.0
        for k in range(bodies.shape[0]):
            if bodies[k, 4] == 0.0 and not touched:
                gap, _ = _nearest(discs[i], bodies[k, 0], bodies[k, 1], 0.0, _FAR * p[SAFETY])
                if gap < _FAR * p[SAFETY]:
                    free = min(free, _free(gap, p))
        touched = free <= least
        total += math.log(free)
    return total


@kernel
def _placed(robot: Array, own: Array, discs: Array) -> None:
    """Fill (T, K, 4) with x, y, radius of the robot's discs at each pose, and how far they moved.

    Args:
        robot: (K, 3) discs, m.
        own: (T, 3) poses of a way from the origin.
        discs: filled.
    """
    for k in range(robot.shape[0]):
        x, y = robot[k, 0], robot[k, 1]
        for i in range(own.shape[0]):
            c, s = math.cos(own[i, 2]), math.sin(own[i, 2])
            discs[i, k, 0] = own[i, 0] + c * robot[k, 0] - s * robot[k, 1]
            discs[i, k, 1] = own[i, 1] + s * robot[k, 0] + c * robot[k, 1]
            discs[i, k, 2] = robot[k, 2]
            discs[i, k, 3] = math.hypot(discs[i, k, 0] - x, discs[i, k, 1] - y)
            x, y = discs[i, k, 0], discs[i, k, 1]


@array_kernel
def way(twist: Array, command: Array, p: Array) -> Array:
    """Return the poses (T, 3) of a robot that accelerates to a command as fast as it can.

    Args:
        twist: (3,) v, w, vy at present.
        command: (3,) the same of the command.
        p: parameters.
    """
    count = max(1, int(p[HORIZON] / STEP + 1e-9))
    out = np.empty((count, 3))
    v, w, vy = twist[0], twist[1], twist[2]
    x, y, yaw = 0.0, 0.0, 0.0
    for k in range(count):
        v = slewed(v, command[0], p[A_MAX] * STEP)
        w = slewed(w, command[1], p[ALPHA_MAX] * STEP)
        vy = slewed(vy, command[2], p[A_MAX] * STEP)
        x, y, yaw = _advanced(x, y, yaw, v, w, vy)
        out[k, 0], out[k, 1], out[k, 2] = x, y, yaw
    return out


@array_kernel
def log_densities(
    candidates: Array,
    user: Array,
    planner: Array,
    bodies: Array,
    robot: Array,
    twist: Array,
    p: Array,
) -> Array:
    """Return the log density of each candidate's path, up to a constant; (C,).

    Args:
        candidates: (C, 3) commands v, w, vy; m/s, rad/s, m/s.
        user, planner: (3,) their commands, the means of their ways.
        bodies: (N, 5) x, y, vx, vy, radius in the base frame; of radius 0: they stand.
        robot: (K, 3) discs that hold the robot, m.
        twist: (3,) v, w, vy of the robot at present, from which all ways begin.
        p: parameters.
    """
    out = np.empty(candidates.shape[0])
    user_way, planned = way(twist, user, p), way(twist, planner, p)
    discs = np.empty((user_way.shape[0], robot.shape[0], 4))
    agree = p[AGREEABILITY] * p[AGREEABILITY]
    for k in range(candidates.shape[0]):
        total, own = 0.0, way(twist, candidates[k], p)
        for i in range(own.shape[0]):
            t = (i + 1) * STEP
            total -= (
                0.5 * _apart(own[i], user_way[i], p[FRONT]) / (agree + (p[USER_SPREAD] * t) ** 2)
            )
            total -= 0.5 * _apart(own[i], planned[i], p[FRONT]) / (p[ROBOT_SPREAD] * t) ** 2
        _placed(robot, own, discs)
        total += _still(bodies, discs, p)
        for i in range(bodies.shape[0]):
            if bodies[i, 4] > 0.0:
                total += _person(bodies[i], discs, p)
        out[k] = total
    return out
