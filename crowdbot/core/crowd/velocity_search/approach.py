"""Accelerations that lead to the velocities chosen by a search."""

from __future__ import annotations

import math

from crowdbot.core.crowd.contact.geometry import is_clearly_longer, is_clearly_shorter
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array


@kernel
def approach(
    found: Array,
    descend: bool,
    position: Array,
    velocity: Array,
    goal: Array,
    radius: Array,
    preferred: Array,
    limit: Array,
    relaxation: float,
    dt: float,
) -> None:
    """Convert chosen velocities to accelerations, in place; agents that have arrived stop.

    Args:
        found: (N, 2) velocities to approach, m/s; or accelerations, m/s^2, if ``descend``.
        descend: True for the result of a descent: infinite away from forbidden velocities.
        position, velocity, goal: (N, 2), m, m/s, m.
        radius, preferred, limit: (N,) body, preferred speed, largest acceleration.
        relaxation: time in which a velocity is approached, s.
        dt: time between decisions, s.
    """
    for i in range(found.shape[0]):
        gx, gy = goal[i, 0] - position[i, 0], goal[i, 1] - position[i, 1]
        arrived = not is_clearly_longer(gx, gy, radius[i]) and math.hypot(gx, gy) <= radius[i]
        ax, ay = found[i, 0], found[i, 1]
        if arrived or preferred[i] == 0.0:
            ax, ay = -velocity[i, 0] / dt, -velocity[i, 1] / dt
        elif not descend:
            ax, ay = (ax - velocity[i, 0]) / relaxation, (ay - velocity[i, 1]) / relaxation
        elif math.isinf(ax) or math.isinf(ay):  # away from forbidden velocities at once
            ax = math.copysign(limit[i], ax) if math.isinf(ax) else 0.0
            ay = math.copysign(limit[i], ay) if math.isinf(ay) else 0.0
        scale = 1.0
        if not is_clearly_shorter(ax, ay, limit[i]):
            norm = math.hypot(ax, ay)
            scale = limit[i] / norm if norm > limit[i] else 1.0
        found[i, 0], found[i, 1] = ax * scale, ay * scale
