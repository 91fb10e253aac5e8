"""Gradient descent in velocity space: the acceleration is minus the gradient of the total cost."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.velocity_search.agent_costs import (
    GRADIENTS,
    PARAMS,
    WORK,
    AgentCosts,
    Functions,
    cost_of,
    prepare,
)
from crowdbot.core.crowd.velocity_search.broken import check_numbers
from crowdbot.core.crowd.velocity_search.cost_calls import call_gradient
from crowdbot.core.crowd.velocity_search.evaluate import Evaluator
from crowdbot.core.crowd.velocity_search.neighbours import DiscRecord, Starts
from crowdbot.core.crowd.velocity_search.records import AgentRecord, NeighbourRecord, WallRecord
from crowdbot.core.crowd.velocity_search.surroundings import (
    DecisionTraitsRecord,
    SettingsRecord,
    Surroundings,
    describe,
)
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import Rows
from crowdbot.core.types.arrays import Array, Indices, Mask

#: Half the width of central differences, m/s.
STEP = 0.1
#: Costs are asked for at most so far from the present velocity, m/s.
_FARTHEST = 1.5 * STEP
_AROUND = STEP * np.array([[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]])


class Descent:
    """Weighted costs with gradient descent."""

    def __init__(self, costs: WeightedCosts) -> None:
        self.costs = costs
        costs.around = _FARTHEST

    def accelerations(self, view: CrowdView) -> Array:
        """Return minus the gradient (N, 2) at the current velocity, m/s^2.

        Infinite away from a forbidden velocity within `STEP`; zero for agents that are absent or
        have arrived. Never NaN.
        """
        costs, around = self.costs, self.costs.surroundings(view)
        found = np.zeros_like(view.position)
        _descend(*around, costs.functions, costs.weights, costs.active, np.zeros(2), found)
        check_numbers(costs, view, around)
        if costs.vectorised:
            points = view.velocity[:, np.newaxis] + _AROUND
            total = Evaluator(costs).total(view, points, compiled=False)
            for axis in (0, 1):
                low, high = total[:, 2 * axis], total[:, 2 * axis + 1]
                both = np.isinf(low) & np.isinf(high)
                with np.errstate(invalid="ignore"):
                    slope = np.where(both, 0.0, (high - low) / (2.0 * STEP))
                    summed = found[:, axis] - slope
                found[:, axis] = np.where(np.isnan(summed), 0.0, summed)
        return found


@kernel
def _descend(
    table: Rows[DiscRecord], starts: Starts, low: float, height: float, decides: Mask, goal: Array,
    walls: Array, grid_frame: Array, grid_first: Indices, grid_cells: Indices, reach: float,
    traits: Rows[DecisionTraitsRecord], settings: Rows[SettingsRecord],
    random: Array, near: Rows[NeighbourRecord], found: Rows[WallRecord],
    deciding: Rows[AgentRecord], functions: Functions, weights: Array, active: Indices, out: Array,
    result: Array,
) -> None:  # fmt: skip
    """Write minus the gradient (N, 2) of the compiled costs to ``result``.

    Args:
        table to deciding: fields of `Surroundings`.
        functions, weights: see `AgentCosts`.
        active, out: (K,), (2,) scratch.
    """
    around = Surroundings(
        table, starts, low, height, decides, goal, walls, grid_frame, grid_first, grid_cells,
        reach, traits, settings, random, near, found, deciding,
    )  # fmt: skip
    agent = deciding[0]
    for b in range(table.shape[0]):
        i = describe(around, b)
        if i < 0:
            continue
        vx, vy, agent.descends = agent.vx, agent.vy, 1.0
        agent.fastest = (1.0 + 1e-9) * math.hypot(vx, vy) + _FARTHEST
        agent.asked_radius = agent.fastest
        terms = prepare(around, b, functions, weights, active)
        costs = AgentCosts(agent, functions, weights, active[:terms])
        gx = gy = 0.0
        for k in range(weights.shape[0]):
            if weights[k] == 0.0:
                continue
            out[0] = out[1] = 0.0
            if functions[k, GRADIENTS] != 0:
                call_gradient(
                    functions[k, GRADIENTS], vx, vy, agent, functions[k, WORK],
                    functions[k, PARAMS], out,
                )  # fmt: skip
            else:
                _differences(costs, k, vx, vy, out)
            if math.isnan(out[0]) or math.isnan(out[1]):
                agent.broken = 1.0
            gx += weights[k] * out[0]
            gy += weights[k] * out[1]
        result[i, 0] = 0.0 if math.isnan(gx) else -gx  # two functions may forbid opposite sides
        result[i, 1] = 0.0 if math.isnan(gy) else -gy
        random[i] = agent.random


@kernel
def _differences(costs: AgentCosts, k: int, vx: float, vy: float, out: Array) -> None:
    """Write central differences of one function; infinite if one side is forbidden."""
    for axis in range(2):
        dx, dy = (STEP, 0.0) if axis == 0 else (0.0, STEP)
        low = cost_of(costs, k, vx - dx, vy - dy)
        high = cost_of(costs, k, vx + dx, vy + dy)
        both = low == math.inf and high == math.inf
        out[axis] = 0.0 if both else (high - low) / (2.0 * STEP)
