"""Gradient descent in velocity space: the acceleration is minus the gradient of the total cost."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from crowdbot.core.crowd.calls import call_gradient
from crowdbot.core.crowd.cost import DESCENDS, FASTEST, RANDOM, VX, VY, Array
from crowdbot.core.crowd.evaluate import Evaluator
from crowdbot.core.crowd.mix import Addresses, Mix, cost_of, describe, prepare
from crowdbot.core.crowd.neighbours import INDEX, WANTED_X, WANTED_Y, Starts
from crowdbot.core.crowd.policy import CrowdView

#: Half the span of central differences, m/s.
STEP = 0.1
_AROUND = STEP * np.array([[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]])


class Descent:
    """A mix of costs whose gradient is followed."""

    def __init__(self, mix: Mix) -> None:
        self.mix = mix

    def accelerations(self, view: CrowdView) -> Array:
        """Minus the gradient (N, 2) at the current velocity, m/s^2.

        Infinite away from a forbidden velocity within `STEP`; zero for agents that are absent or
        have arrived. Never NaN.
        """
        mix, scene = self.mix, self.mix.scene(view)
        found = np.zeros_like(view.position)
        _descend(
            scene.table, scene.starts, scene.low, scene.height, scene.who, scene.goal, scene.walls,
            scene.reach, scene.agent, scene.near, scene.found, mix.traits, mix.settings(view),
            mix.random, mix.bases, mix.prepares, mix.excesses, mix.gradients, mix.params_at,
            mix.weights, mix.work_at, found,
        )  # fmt: skip
        if mix.vectorised:
            points = view.velocity[:, np.newaxis] + _AROUND
            total = Evaluator(mix).total(view, points, compiled=False)
            for axis in (0, 1):
                low, high = total[:, 2 * axis], total[:, 2 * axis + 1]
                both = np.isinf(low) & np.isinf(high)
                with np.errstate(invalid="ignore"):
                    slope = np.where(both, 0.0, (high - low) / (2.0 * STEP))
                    summed = found[:, axis] - slope
                found[:, axis] = np.where(np.isnan(summed), 0.0, summed)
        return found


@njit(cache=True, error_model="numpy")
def _descend(
    table: Array,
    starts: Starts,
    low: float,
    height: float,
    who: NDArray[np.bool_],
    goal: Array,
    walls: Array,
    reach: float,
    agent: Array,
    near: Array,
    found: Array,
    traits: Array,
    settings: Array,
    random: Array,
    bases: Addresses,
    prepares: Addresses,
    excesses: Addresses,
    gradients: Addresses,
    params_at: Addresses,
    weights: Array,
    work_at: Addresses,
    result: Array,
) -> None:
    active = np.empty(weights.shape[0], np.int64)
    out = np.zeros(2)
    for b in range(table.shape[0]):
        i = int(table[b, INDEX])
        if i < 0 or not who[i] or (table[b, WANTED_X] == 0.0 and table[b, WANTED_Y] == 0.0):
            continue
        describe(table, b, traits, goal, settings, random, i, agent)
        vx, vy, agent[DESCENDS] = agent[VX], agent[VY], 1.0
        agent[FASTEST] = (1.0 + 1e-9) * math.hypot(vx, vy) + 1.5 * STEP
        terms = prepare(
            table, starts, low, height, b, walls, reach, agent, near, found, prepares, params_at,
            weights, work_at, active,
        )  # fmt: skip
        gx = gy = 0.0
        for k in range(weights.shape[0]):
            if weights[k] == 0.0:
                continue
            out[0] = out[1] = 0.0
            if gradients[k] != 0:
                call_gradient(
                    gradients[k], vx, vy, agent.ctypes.data, work_at[k], params_at[k],
                    out.ctypes.data,
                )  # fmt: skip
            else:
                has_excess = False
                for term in range(terms):
                    has_excess = has_excess or active[term] == k
                _differences(k, vx, vy, agent, bases, excesses, has_excess, params_at, work_at, out)
            gx += weights[k] * out[0]
            gy += weights[k] * out[1]
        result[i, 0] = 0.0 if math.isnan(gx) else -gx  # two functions may forbid opposite sides
        result[i, 1] = 0.0 if math.isnan(gy) else -gy
        random[i] = agent[RANDOM]


@njit(cache=True, error_model="numpy")
def _differences(
    k: int,
    vx: float,
    vy: float,
    agent: Array,
    bases: Addresses,
    excesses: Addresses,
    has_excess: bool,
    params_at: Addresses,
    work_at: Addresses,
    out: Array,
) -> None:
    """Central differences of one function; infinite where one side is forbidden."""
    for axis in range(2):
        dx, dy = (STEP, 0.0) if axis == 0 else (0.0, STEP)
        low = cost_of(k, vx - dx, vy - dy, agent, bases, excesses, has_excess, params_at, work_at)
        high = cost_of(k, vx + dx, vy + dy, agent, bases, excesses, has_excess, params_at, work_at)
        both = low == math.inf and high == math.inf
        out[axis] = 0.0 if both else (high - low) / (2.0 * STEP)
