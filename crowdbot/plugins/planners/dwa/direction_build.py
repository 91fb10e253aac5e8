"""Choice of a direction for dwa: towards the goal, free for long, like the last one; compiled."""

from __future__ import annotations

import math

from crowdbot.plugin import Array, kernel
from crowdbot.plugins.planners.shared.points_build import unsigned, wrapped

#: Directions that are tried on either side of the goal's.
_HALF = 24


@kernel
def free_time(
    points: Array, velocities: Array, vx: float, vy: float, radius: float, limit: float
) -> float:
    """Return the time until a disc at the origin with velocity (vx, vy) meets a moving point, s.

    At most ``limit``. Points inside the disc count only while they come closer.
    """
    best = limit
    for i in range(points.shape[0]):
        x, y = points[i, 0], points[i, 1]
        rx, ry = vx - velocities[i, 0], vy - velocities[i, 1]
        speed2 = rx * rx + ry * ry
        closing = x * rx + y * ry
        if closing <= 0.0:
            continue
        gap = x * x + y * y - radius * radius
        if gap <= 0.0:
            return 0.0
        room = closing * closing - speed2 * gap
        if room > 0.0:
            best = min(best, (closing - math.sqrt(room)) / speed2)
    return best


@kernel
def choose_direction(
    points: Array,
    velocities: Array,
    goal: float,
    previous: float,
    speed: float,
    radius: float,
    limit: float,
    detour: float,
    swerve: float,
    hold: float,
) -> tuple[float, float]:
    """Choose a direction towards the goal that stays free for long and is close to the last one.

    Args:
        points: (K, 2) base frame, m.
        velocities: (K, 2) base frame, m/s.
        goal: bearing of the goal, rad.
        previous: bearing chosen last, rad.
        speed: the robot's speed, m/s.
        radius: radius of the disc that must stay free, m.
        limit: time beyond which a direction counts as free, s.
        detour: cost of the opposite direction; 1 is the cost of being blocked at once.
        swerve: largest angle from the goal's bearing, rad.
        hold: cost of a full reversal of the last choice.

    Returns:
        bearing (rad, not wrapped) and the time for which it is free (s).
    """
    best, angle, time = math.inf, goal, 0.0
    # One that is likely: no other need be looked at that costs more even if it is free.
    likely = round(_HALF * max(-1.0, min(1.0, wrapped(previous - goal) / swerve)))
    enough = math.inf
    for n in range(-1, 2 * _HALF + 1):
        off = swerve * (n - _HALF if n >= 0 else likely) / _HALF
        theta = goal + off
        swing = unsigned(theta - previous) / math.pi
        turn = unsigned(theta) / math.pi
        least = detour * abs(off) / math.pi + hold * swing + 0.15 * turn
        if least >= best or least > enough:
            continue
        t = free_time(
            points, velocities, speed * math.cos(theta), speed * math.sin(theta), radius, limit
        )
        cost = detour * abs(off) / math.pi + (1.0 - t / limit) + hold * swing + 0.15 * turn
        if n < 0:
            enough = cost
        elif cost < best:
            best, angle, time = cost, theta, t
    return angle, time
