"""The dynamic window: velocities that a robot can reach next, as candidates; compiled."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, array_kernel, kernel
from crowdbot.plugins.planners.dwa.rollouts_build import slewed_planar

#: Directions that a robot which goes sideways tries, from the wanted one, rad.
_ASIDE = tuple(math.radians(a) for a in (0.0, 20.0, -20.0, 45.0, -45.0, 90.0, -90.0, 180.0))


@kernel
def _evenly(first: float, last: float, values: Array) -> None:
    """Fill (N,) with even steps from the first to the last value, N > 1."""
    steps = values.shape[0] - 1
    for k in range(steps):
        values[k] = k * ((last - first) / steps) + first
    values[steps] = last


@array_kernel
def candidates(
    low: float, high: float, speeds: int, left: float, right: float, rates: int, wish: float
) -> Array:
    """Return target velocities (C, 2): every speed with every yaw rate, slow to fast.

    Args:
        low, high: limits of the speeds, m/s; 0 or the value closest to it is included.
        speeds, rates: how many of each, > 1.
        left, right: limits of the yaw rates, rad/s; 0 or the value closest to it is included.
        wish: one more yaw rate, rad/s.
    """
    v, w = np.empty(speeds + 1), np.empty(rates + 2)
    _evenly(low, high, v[:speeds])
    v[speeds] = max(low, min(0.0, high))
    for k in range(speeds, 0, -1):  # to its place; v.sort() takes a second to compile
        if v[k - 1] <= v[k]:
            break
        v[k - 1], v[k] = v[k], v[k - 1]
    _evenly(left, right, w[:rates])
    w[rates], w[rates + 1] = wish, max(left, min(right, 0.0))
    out = np.empty((len(v) * len(w), 2))
    count = 0
    for k in range(len(v)):
        if k > 0 and v[k] == v[k - 1]:
            continue
        for j in range(len(w)):
            out[count, 0], out[count, 1] = v[k], w[j]
            count += 1
    return out[:count]


@array_kernel
def candidates_aside(
    now: tuple[float, float], change: float, top: float, speeds: int, direction: float, rates: Array
) -> Array:
    """Return target velocities (C, 3), v, w and vy, of an omnidirectional robot.

    Every speed in the desired direction, beside it and away from it, with every yaw rate, limited
    by the possible change.

    Args:
        now: present v and vy, m/s.
        change: largest change of that vector, m/s.
        top: highest speed, m/s.
        speeds: how many, > 1; the lowest is 0.
        direction: desired direction, rad.
        rates: (R,) yaw rates, rad/s.
    """
    out = np.empty((((speeds - 1) * len(_ASIDE) + 1) * rates.shape[0], 3))
    count = 0
    for k in range(speeds):
        for j in range(len(_ASIDE) if k > 0 else 1):
            speed, angle = top * k / (speeds - 1), direction + _ASIDE[j]
            v, vy = speed * math.cos(angle), speed * math.sin(angle)
            v, vy = slewed_planar(now[0], now[1], v, vy, change)
            for i in range(rates.shape[0]):
                out[count, 0], out[count, 1], out[count, 2] = v, rates[i], vy
                count += 1
    return out
