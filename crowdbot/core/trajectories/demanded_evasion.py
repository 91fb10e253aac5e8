"""Demanded evasion: the acceleration that people would need to pass a robot at some distance.

It is computed from velocities, so neither a person's reaction nor noise of accelerations matters. N
samples, M people; world frame, SI units.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.trajectories.encounters import encounter, relative_velocity, robot_velocities
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array

#: No evasion is planned in less than this, s.
_SOONEST = 0.5
#: Largest evasion that people reach, m/s^2: it stops a walker in one or two steps
#: (Hase, Stein 1998).
MOST = 3.0
#: Lower relative speeds bring no one nearer, m/s.
_STILL = 1e-3


def demanded_evasion(run: Trajectories, time: float, room: float, jump_speed: float) -> Array:
    """Return the acceleration (N-1, M) that each person needs on each step, m/s^2.

    The person would have to shift by the missing part of its smallest gap to a robot on a constant
    course, within the time until that gap; 0 later than ``time``, for people who part from the
    robot or are absent.

    Args:
        time: people need not evade earlier before the smallest gap, s.
        room: gap that people have to get, m.
        jump_speed: m/s, detects teleports.
    """
    key = "demanded_evasion", time, room, jump_speed
    return run.cached(key, lambda: _demanded(run, time, room, jump_speed))


def robot_approach(run: Trajectories, jump_speed: float) -> Array:
    """Return the robot's speed towards each person (N-1, M), m/s; never negative, 0 if absent."""
    return run.cached(("robot_approach", jump_speed), lambda: _approach(run, jump_speed))


def _demanded(run: Trajectories, time: float, room: float, jump_speed: float) -> Array:
    pair = encounter(run, jump_speed)
    need = np.zeros(pair.px.shape)
    velocity = relative_velocity(run, jump_speed)
    _needs((pair.px, pair.py), velocity, pair.gap, pair.distance, time, room, need)
    return np.asarray((need[1:] + need[:-1]) / 2.0)


@kernel
def _needs(
    at: tuple[Array, Array], velocity: tuple[Array, Array], gap: Array, distance: Array,
    time: float, room: float, need: Array,
) -> None:  # fmt: skip
    """Write the acceleration that each person needs at each sample (N, M), m/s^2."""
    (px, py), (vx, vy) = at, velocity
    for k in range(px.shape[0]):
        for m in range(px.shape[1]):
            x, y, wx, wy = px[k, m], py[k, m], vx[k, m], vy[k, m]
            square = wx * wx + wy * wy
            until = -(x * wx + y * wy) / max(square, _STILL * _STILL)
            if not 0.0 < until < time:  # nor for NaN
                continue
            shift = distance[k, m] - gap[k, m] + room - math.hypot(x + until * wx, y + until * wy)
            if shift > 0.0:
                needed = 2.0 * shift / max(until, _SOONEST) ** 2
                need[k, m] = min(needed, MOST) if needed < math.inf else 0.0


def _approach(run: Trajectories, jump_speed: float) -> Array:
    pair = encounter(run, jump_speed)
    rx, ry = robot_velocities(run, jump_speed)
    distance = pair.distance
    towards = rx[:, None] * pair.px + ry[:, None] * pair.py
    known = np.isfinite(towards) & (distance > 0.0)
    speed = np.divide(towards, distance, out=np.zeros(distance.shape), where=known)
    speed = np.maximum(0.0, np.where(known, speed, 0.0))
    return np.asarray((speed[1:] + speed[:-1]) / 2.0)
