"""Demanded evasion: the acceleration that people would need to pass a robot at some distance.

It is computed from velocities, so neither a person's reaction nor noise of accelerations matters. N
samples, M people; world frame, SI units.
"""

from __future__ import annotations

import numpy as np

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
    wx, wy = relative_velocity(run, jump_speed)
    square = wx * wx + wy * wy
    with np.errstate(invalid="ignore", divide="ignore"):
        until = -(pair.px * wx + pair.py * wy) / np.maximum(square, _STILL * _STILL)
        distance = np.hypot(pair.px, pair.py)
        miss = np.hypot(pair.px + until * wx, pair.py + until * wy)
        shift = np.maximum(0.0, distance - pair.gap + room - miss)
        need = 2.0 * shift / np.maximum(until, _SOONEST) ** 2
        counts = (until > 0.0) & (until < time) & np.isfinite(need)
    need = np.where(counts, np.minimum(need, MOST), 0.0)
    return np.asarray((need[1:] + need[:-1]) / 2.0)


def _approach(run: Trajectories, jump_speed: float) -> Array:
    pair = encounter(run, jump_speed)
    rx, ry = robot_velocities(run, jump_speed)
    distance = np.hypot(pair.px, pair.py)
    towards = rx[:, None] * pair.px + ry[:, None] * pair.py
    known = np.isfinite(towards) & (distance > 0.0)
    speed = np.divide(towards, distance, out=np.zeros(distance.shape), where=known)
    speed = np.maximum(0.0, np.where(known, speed, 0.0))
    return np.asarray((speed[1:] + speed[:-1]) / 2.0)
