"""The method ``global``: the velocity with the lowest cost, in closed form or by a fine search."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.velocity_search.agent_costs import (
    OPTIMA,
    PARAMS,
    PREPARES,
    WORK,
    Functions,
    prepare,
)
from crowdbot.core.crowd.velocity_search.broken import check_numbers
from crowdbot.core.crowd.velocity_search.candidates import EVERYWHERE
from crowdbot.core.crowd.velocity_search.cost import MORE_WALLS
from crowdbot.core.crowd.velocity_search.cost_calls import call_optimum, call_prepare
from crowdbot.core.crowd.velocity_search.neighbours import (
    DiscRecord,
    Starts,
    gather,
    gather_walls_in,
)
from crowdbot.core.crowd.velocity_search.records import AgentRecord, NeighbourRecord, WallRecord
from crowdbot.core.crowd.velocity_search.sampling import Sampler
from crowdbot.core.crowd.velocity_search.surroundings import (
    DecisionTraitsRecord,
    SettingsRecord,
    Surroundings,
    describe,
)
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts
from crowdbot.core.geometry.segment_grid import SegmentGrid
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.support.records import Rows
from crowdbot.core.types.arrays import Array, Indices, Mask

#: Most decisions change the velocity by less than the first, nearly all by less than the last, m/s.
_CHANGES = (0.25, 1.0)
_NO_GRID = SegmentGrid(np.zeros(5), np.zeros(2, np.int64), np.zeros(0, np.int64))


class Optimum:
    """The closed form if there is one cost function that has one; otherwise a fine search."""

    def __init__(self, costs: WeightedCosts) -> None:
        self.costs = costs
        self.is_closed = (
            len(costs.compiled) == 1 and not costs.vectorised and costs.functions[0, OPTIMA] != 0
        )
        self.nearby = self.is_closed and costs.compiled[0].optimum_by_nearby_walls
        self.search = Sampler(EVERYWHERE, costs)

    def choose(self, view: CrowdView) -> Array:
        """Return chosen velocities (N, 2), m/s; zero for agents that are absent or have arrived."""
        if not self.is_closed:
            return self.search.choose(view)
        costs, around = self.costs, self.costs.surroundings(view)
        chosen, unknown = np.zeros_like(view.position), np.zeros(len(view.position), np.bool_)
        grid, covered = (
            costs.nearby_walls(view.walls, _CHANGES[-1]) if self.nearby else (_NO_GRID, 0.0)
        )
        _solve(
            *around, costs.functions, costs.weights, *grid, covered, costs.active, np.zeros(2),
            unknown, chosen,
        )  # fmt: skip
        check_numbers(costs, view, around)
        if np.any(unknown):
            chosen[unknown] = self.search.choose(replace(view, decides=unknown))[unknown]
        return chosen


@kernel
def _solve(
    table: Rows[DiscRecord], starts: Starts, low: float, height: float, decides: Mask, goal: Array,
    walls: Array, grid_frame: Array, grid_first: Indices, grid_cells: Indices, reach: float,
    traits: Rows[DecisionTraitsRecord], settings: Rows[SettingsRecord],
    random: Array, near: Rows[NeighbourRecord], found: Rows[WallRecord],
    deciding: Rows[AgentRecord], functions: Functions, weights: Array,
    nearby_frame: Array, nearby_first: Indices, nearby_cells: Indices, covered: float,
    active: Indices, out: Array, unknown: Mask, chosen: Array,
) -> None:  # fmt: skip
    """Write velocities (N, 2) with the lowest cost to ``chosen``, or mark them ``unknown`` (N,).

    Args:
        table to deciding: fields of `Surroundings`.
        functions, weights: see `AgentCosts`; only one function.
        nearby_frame to covered: `SegmentGrid` of the walls that are tried first, and its reach;
            0: all are tried at once.
        active, out: (1,), (2,) scratch.
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
        known = 0
        if covered > 0.0:
            people = gather(table, starts, low, height, b, reach, near)
            for change in _CHANGES:
                if known == 0:
                    grid = SegmentGrid(nearby_frame, nearby_first, nearby_cells)
                    known = _nearby_optimum(around, functions, people, grid, covered, change, out)
            agent.asked_x, agent.asked_y, agent.asked_radius = 0.0, 0.0, agent.fastest
        if known == 0:
            prepare(around, b, functions, weights, active)
            known = _optimum_of(agent, functions, out)
        random[i] = agent.random
        if known == 0:
            unknown[i] = True
        else:
            if math.isnan(out[0]) or math.isnan(out[1]):
                agent.broken = 1.0
            chosen[i, 0], chosen[i, 1] = out[0], out[1]


@inline_kernel
def _nearby_optimum(
    around: Surroundings, functions: Functions, people: int, grid: SegmentGrid, covered: float,
    change: float, out: Array,
) -> int:  # fmt: skip
    """Write the optimum that walls near the agent's way lead to; return 0 if others may matter.

    Args:
        people: number of neighbours in ``around.near``.
        grid, covered: grid of the walls, and its reach, m.
        change: see `CompiledCost.optimum_by_nearby_walls`, m/s.
    """
    agent, settings = around.deciding[0], around.settings[0]
    speed, seconds = math.hypot(agent.vx, agent.vy), settings.wall_seconds
    far = settings.wall_metres + seconds * (speed + change)
    if far > covered:
        return 0
    here, beside = settings.wall_metres + speed + change, settings.wall_metres + seconds * change
    x, y = seconds * agent.vx, seconds * agent.vy
    agent.asked_x, agent.asked_y, agent.asked_radius = agent.vx, agent.vy, change
    agent.walls_within = 0.0
    walls = gather_walls_in(
        around.walls, grid.frame, grid.first, grid.near, covered, agent.px, agent.py, far,
        min(-here, x - beside), min(-here, y - beside), max(here, x + beside),
        max(here, y + beside), around.found,
    )  # fmt: skip
    items = call_prepare(
        functions[0, PREPARES], agent, around.near, people, around.found, walls,
        functions[0, PARAMS], functions[0, WORK],
    )  # fmt: skip
    if items == MORE_WALLS or _optimum_of(agent, functions, out) == 0:
        return 0
    return int(math.hypot(out[0] - agent.vx, out[1] - agent.vy) < change)


@inline_kernel
def _optimum_of(agent: AgentRecord, functions: Functions, out: Array) -> int:
    """Write the optimum of the only function, which is prepared; return 0 if it is unknown."""
    return int(
        call_optimum(functions[0, OPTIMA], agent, functions[0, WORK], functions[0, PARAMS], out)
    )
