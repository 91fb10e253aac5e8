"""Wander: a slow random acceleration of each person, from its own random stream.

It is a function of time: two normal numbers at knots are mixed with constant variance. So it needs
no state, only a memory of what was drawn, and a run continued from any state is the same. Each
person has individual knot times.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.crowd.velocity_search.counter_rng import WANDER, uniform
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array, Indices, Mask

#: Lag at which the correlation is 1/e, in knots: of (1 - l/2) cos(pi l/2) + sin(pi l/2)/pi.
E_FOLD = 0.93929


#: Columns of `no_draws`: a person's shift of the knots, the last knot, and the numbers at it and at
#: the next one. A shift or a knot that is NaN is still to be drawn.
SHIFT, KNOT, X0, Y0, X1, Y1 = range(6)


def no_draws(people: int) -> Array:
    """Return (N, 6) the memory of people's draws, which are drawn at each knot only."""
    return np.full((people, 6), np.nan)


@kernel
def wander_all(
    decides: Mask, ids: Indices, knots: float, deviation: float, key: np.uint64, draws: Array,
    desired: Array,
) -> None:  # fmt: skip
    """Add the random acceleration of people who decide, in place.

    Args:
        ids: (N,) that the draws depend on.
        knots: the time in knots.
        deviation: see `WanderSpec`.
        key: as in `Steering`.
        draws: (N, 6) from `no_draws`, for the same people and key each time.
        desired: (N, 2) accelerations, m/s^2.
    """
    for i in range(desired.shape[0]):
        if decides[i]:
            x, y = wandering(ids[i], knots, key, draws[i])
            desired[i, 0] += deviation * x
            desired[i, 1] += deviation * y


@kernel
def wandering(agent: int, knots: float, key: np.uint64, draws: Array) -> tuple[float, float]:
    """Return two independent numbers with mean 0 and variance 1, slow in ``knots``.

    Args:
        draws: (6,) row of this agent, from `no_draws`.
    """
    if math.isnan(draws[SHIFT]):
        draws[SHIFT] = uniform(key, agent, 0, WANDER, 2)
    at = knots + draws[SHIFT]
    knot = math.floor(at)
    if draws[KNOT] != knot:
        draws[KNOT] = knot
        draws[X0], draws[Y0] = _normal(agent, knot, key)
        draws[X1], draws[Y1] = _normal(agent, knot + 1, key)
    angle = 0.5 * math.pi * (at - knot)
    c, s = math.cos(angle), math.sin(angle)
    return c * draws[X0] + s * draws[X1], c * draws[Y0] + s * draws[Y1]


@kernel
def _normal(agent: int, knot: int, key: np.uint64) -> tuple[float, float]:
    """Return two normal numbers (Box and Muller 1958)."""
    u = 1.0 - uniform(key, agent, knot, WANDER, 0)
    v = uniform(key, agent, knot, WANDER, 1)
    size = math.sqrt(-2.0 * math.log(u))
    return size * math.cos(2.0 * math.pi * v), size * math.sin(2.0 * math.pi * v)
