"""The method ``global``: the velocity with the lowest cost, in closed form or by a fine search."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.velocity_search.agent_costs import (
    OPTIMA,
    PARAMS,
    WORK,
    Functions,
    prepare,
)
from crowdbot.core.crowd.velocity_search.broken import check_numbers
from crowdbot.core.crowd.velocity_search.candidates import EVERYWHERE
from crowdbot.core.crowd.velocity_search.cost_calls import call_optimum
from crowdbot.core.crowd.velocity_search.neighbours import DiscRecord, Starts
from crowdbot.core.crowd.velocity_search.records import AgentRecord, NeighbourRecord, WallRecord
from crowdbot.core.crowd.velocity_search.sampling import Sampler
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


class Optimum:
    """The closed form if the costs are one function that has one; otherwise `EVERYWHERE`."""

    def __init__(self, costs: WeightedCosts) -> None:
        self.costs = costs
        self.is_closed = (
            len(costs.compiled) == 1 and not costs.vectorised and costs.functions[0, OPTIMA] != 0
        )
        self.search = Sampler(EVERYWHERE, costs)

    def choose(self, view: CrowdView) -> Array:
        """Return chosen velocities (N, 2), m/s; zero for agents that are absent or have arrived."""
        if not self.is_closed:
            return self.search.choose(view)
        costs, around = self.costs, self.costs.surroundings(view)
        chosen, unknown = np.zeros_like(view.position), np.zeros(len(view.position), np.bool_)
        _solve(*around, costs.functions, costs.weights, costs.active, np.zeros(2), unknown, chosen)
        check_numbers(costs, view, around)
        if np.any(unknown):
            chosen[unknown] = self.search.choose(replace(view, decides=unknown))[unknown]
        return chosen


@kernel
def _solve(
    table: Rows[DiscRecord], starts: Starts, low: float, height: float, who: Mask, goal: Array,
    walls: Array, grid_frame: Array, grid_first: Indices, grid_cells: Indices, reach: float,
    traits: Rows[DecisionTraitsRecord], settings: Rows[SettingsRecord],
    random: Array, near: Rows[NeighbourRecord], found: Rows[WallRecord],
    deciding: Rows[AgentRecord], functions: Functions, weights: Array,
    active: Indices, out: Array, unknown: Mask, chosen: Array,
) -> None:  # fmt: skip
    """Write velocities (N, 2) with the lowest cost to ``chosen``, or mark them ``unknown`` (N,).

    Args:
        table to deciding: fields of `Surroundings`.
        functions, weights: see `AgentCosts`; only one function.
        active, out: (1,), (2,) scratch.
    """
    around = Surroundings(
        table, starts, low, height, who, goal, walls, grid_frame, grid_first, grid_cells,
        reach, traits, settings, random, near, found, deciding,
    )  # fmt: skip
    agent = deciding[0]
    for b in range(table.shape[0]):
        i = describe(around, b)
        if i < 0:
            continue
        prepare(around, b, functions, weights, active)
        known = call_optimum(
            functions[0, OPTIMA], agent, functions[0, WORK], functions[0, PARAMS],
            out,
        )  # fmt: skip
        random[i] = agent.random
        if known == 0:
            unknown[i] = True
        else:
            if math.isnan(out[0]) or math.isnan(out[1]):
                agent.broken = 1.0
            chosen[i, 0], chosen[i, 1] = out[0], out[1]
