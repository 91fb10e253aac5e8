"""The weighted cost functions of one agent, called from compiled loops."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.velocity_search.cost import MORE_WALLS
from crowdbot.core.crowd.velocity_search.cost_calls import call_base, call_excess, call_prepare
from crowdbot.core.crowd.velocity_search.neighbours import gather, gather_walls_in
from crowdbot.core.crowd.velocity_search.records import AgentRecord
from crowdbot.core.crowd.velocity_search.surroundings import Surroundings, wall_distance
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.types.arrays import Array, Indices

#: Table (K, 8) of addresses: a row per cost function, columns as below.
Functions = NDArray[np.intp]
# Columns of `Functions`: the parts of a function in the order of `cost.SIGNATURES`, 0 if missing;
# its parameters; its scratch table.
BASES, PREPARES, EXCESSES, LOWER_BOUNDS, GRADIENTS, OPTIMA, PARAMS, WORK = range(8)
FUNCTION_COLUMNS = 8


class AgentCosts(NamedTuple):
    """The cost functions of one agent, prepared for its decision.

    Attributes:
        agent: the agent.
        functions: (K, `FUNCTION_COLUMNS`) addresses.
        weights: (K,) of the functions.
        active: (T,) indices of the functions with an excess.
    """

    agent: AgentRecord
    functions: Functions
    weights: Array
    active: Indices


@inline_kernel
def prepare(
    around: Surroundings, b: int, functions: Functions, weights: Array, active: Indices
) -> int:
    """Prepare all cost functions for the agent in row b of the table; call `describe` first.

    Returns:
        number of functions with an excess; their indices are in ``active`` (K,).
    """
    agent, near, found = around.deciding[0], around.near, around.found
    near_count = gather(
        around.table, around.starts, around.low, around.height, b, around.reach, near
    )
    distance = wall_distance(around)
    wall_count, terms = _walls_within(around, distance), 0
    for k in range(weights.shape[0]):
        items = call_prepare(
            functions[k, PREPARES], agent, near, near_count, found, wall_count,
            functions[k, PARAMS], functions[k, WORK],
        )  # fmt: skip
        if items == MORE_WALLS:
            every = _walls_within(around, around.reach)
            items = call_prepare(
                functions[k, PREPARES], agent, near, near_count, found, every,
                functions[k, PARAMS], functions[k, WORK],
            )  # fmt: skip
            wall_count = _walls_within(around, distance)
        if items > 0 and weights[k] != 0.0:
            active[terms] = k
            terms += 1
    return terms


@inline_kernel
def _walls_within(around: Surroundings, distance: float) -> int:
    """Write the walls within a distance (m) of the agent that decides; return their number."""
    settings, agent = around.settings[0], around.deciding[0]
    all_given = settings.wall_more == 0.0 or distance >= around.reach
    agent.walls_within = 0.0 if all_given else distance
    left = low = -distance
    right = high = distance
    if settings.wall_way != 0.0 and agent.descends != 0.0:
        near, seconds = settings.wall_metres, settings.wall_seconds
        x, y = seconds * agent.vx, seconds * agent.vy
        left, right = min(0.0, x) - near, max(0.0, x) + near
        low, high = min(0.0, y) - near, max(0.0, y) + near
    return int(
        gather_walls_in(
            around.walls, around.grid_frame, around.grid_first, around.grid_cells,
            settings.wall_grid, agent.px, agent.py, distance, left, low, right, high, around.found,
        )
    )  # fmt: skip


@kernel
def in_preferred_frame(ux: float, uy: float, agent: AgentRecord) -> tuple[float, float]:
    """Return a world velocity in the frame of the preferred velocity, m/s."""
    preferred = agent.preferred
    return (
        (ux * agent.pvx + uy * agent.pvy) / preferred,
        (uy * agent.pvx - ux * agent.pvy) / preferred,
    )


@kernel
def base_cost(
    along: float,
    across: float,
    preferred: float,
    max_speed: float,
    functions: Functions,
    weights: Array,
) -> float:
    """Return the weighted sum of the bases for a candidate in the preferred frame."""
    total = 0.0
    for k in range(weights.shape[0]):
        if weights[k] != 0.0:
            total += weights[k] * call_base(
                functions[k, BASES], along, across, preferred, max_speed, functions[k, PARAMS]
            )
    return total


@kernel
def excess_of(costs: AgentCosts, k: int, ux: float, uy: float, budget: float) -> float:
    """Return the excess of function k at a world velocity, or anything above ``budget``."""
    functions = costs.functions
    return float(
        call_excess(
            functions[k, EXCESSES], ux, uy, budget, costs.agent, functions[k, WORK],
            functions[k, PARAMS],
        )
    )  # fmt: skip


@kernel
def cost_of(costs: AgentCosts, k: int, ux: float, uy: float) -> float:
    """Return the unweighted cost of a world velocity by function k alone."""
    agent, functions = costs.agent, costs.functions
    along, across = in_preferred_frame(ux, uy, agent)
    cost = call_base(
        functions[k, BASES], along, across, agent.preferred, agent.max_speed,
        functions[k, PARAMS],
    )  # fmt: skip
    for term in range(costs.active.shape[0]):
        if costs.active[term] == k:
            cost += excess_of(costs, k, ux, uy, math.inf)
    return float(cost)
