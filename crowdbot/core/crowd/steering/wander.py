"""Wander: a slow random acceleration of each person, from its own random stream.

It is a function of time: two normal numbers at knots are mixed with constant variance. So it needs
no state, and a run continued from any state is the same. Each person has individual knot times.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.crowd.velocity_search.counter_rng import WANDER, uniform
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array, Indices, Mask

#: Lag at which the correlation is 1/e, in knots: of (1 - l/2) cos(pi l/2) + sin(pi l/2)/pi.
E_FOLD = 0.93929


@kernel
def wander_all(
    decides: Mask, ids: Indices, knots: float, deviation: float, key: np.uint64, desired: Array
) -> None:
    """Add the random acceleration of people who decide, in place.

    Args:
        ids: (N,) that the draws depend on.
        knots: the time in knots.
        deviation: see `WanderSpec`.
        key: as in `Steering`.
        desired: (N, 2) accelerations, m/s^2.
    """
    for i in range(desired.shape[0]):
        if decides[i]:
            x, y = wandering(ids[i], knots, key)
            desired[i, 0] += deviation * x
            desired[i, 1] += deviation * y


@kernel
def wandering(agent: int, knots: float, key: np.uint64) -> tuple[float, float]:
    """Return two independent numbers with mean 0 and variance 1, slow in ``knots``."""
    at = knots + uniform(key, agent, 0, WANDER, 2)
    knot = math.floor(at)
    angle = 0.5 * math.pi * (at - knot)
    x0, y0 = _normal(agent, knot, key)
    x1, y1 = _normal(agent, knot + 1, key)
    c, s = math.cos(angle), math.sin(angle)
    return c * x0 + s * x1, c * y0 + s * y1


@kernel
def _normal(agent: int, knot: int, key: np.uint64) -> tuple[float, float]:
    """Return two normal numbers (Box and Muller 1958)."""
    u = 1.0 - uniform(key, agent, knot, WANDER, 0)
    v = uniform(key, agent, knot, WANDER, 1)
    size = math.sqrt(-2.0 * math.log(u))
    return size * math.cos(2.0 * math.pi * v), size * math.sin(2.0 * math.pi * v)
