"""Total cost of given velocities, without shortcuts."""

from __future__ import annotations

from typing import Any

import numpy as np

from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.velocity_search.agent_costs import (
    AgentCosts,
    Functions,
    cost_of,
    prepare,
)
from crowdbot.core.crowd.velocity_search.cost import AgentView, Neighbours, NumpyCost
from crowdbot.core.crowd.velocity_search.neighbours import DiscRecord, Starts, gather, gather_walls
from crowdbot.core.crowd.velocity_search.records import AgentRecord, NeighbourRecord, WallRecord
from crowdbot.core.crowd.velocity_search.surroundings import (
    DecisionTraitsRecord,
    SettingsRecord,
    Surroundings,
    describe,
)
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.immutable import immutable, immutable_fields
from crowdbot.core.support.records import Rows
from crowdbot.core.types.arrays import Array, Indices, Mask


class Evaluator:
    """Weighted costs of any velocities, by compiled and vectorised functions."""

    def __init__(self, costs: WeightedCosts) -> None:
        self.costs = costs

    def total(self, view: CrowdView, velocities: Array, *, compiled: bool = True) -> Array:
        """Return weighted sums (N, S) of all costs at velocities (N, S, 2), m/s.

        Zero for agents that are absent or have arrived, ``inf`` for forbidden velocities.

        Args:
            compiled: False to exclude the compiled functions.

        Raises:
            ValueError: a vectorised function returned NaN or a wrong number of costs.
        """
        costs, around = self.costs, self.costs.surroundings(view)
        total = np.zeros(velocities.shape[:2])
        if compiled and costs.compiled:
            _evaluate(
                *around, costs.functions, costs.weights, costs.active,
                np.ascontiguousarray(velocities), total,
            )  # fmt: skip
        if costs.vectorised:
            self._add_vectorised(around, velocities, total)
        return total

    def _add_vectorised(self, around: Surroundings, velocities: Array, total: Array) -> None:
        agent = around.deciding
        for b in range(around.table.shape[0]):
            i = describe(around, b)
            if i < 0:
                continue
            count = gather(
                around.table, around.starts, around.low, around.height, b, around.reach, around.near
            )
            px, py, radius = (float(agent[name][0]) for name in ("px", "py", "radius"))
            walls = gather_walls(
                around.walls, around.grid_frame, around.grid_first, around.grid_cells,
                around.reach, px, py, around.reach, around.found,
            )  # fmt: skip
            seen, tried = immutable_fields(_agent_view(agent)), immutable(velocities[i])
            for cost in self.costs.vectorised:
                others = immutable_fields(
                    _neighbours(cost, radius, around.near[:count], around.found[:walls])
                )
                found = np.asarray(cost.evaluate(tried, seen, others), np.float64)
                if found.shape != total[i].shape or np.any(np.isnan(found)):
                    raise ValueError(
                        f"a cost function returned {found.shape} numbers with "
                        f"{np.count_nonzero(np.isnan(found))} NaN for {len(velocities[i])} "
                        "candidates"
                    )
                if cost.weight > 0.0:
                    total[i] += cost.weight * found


def _agent_view(deciding: Rows[AgentRecord]) -> AgentView:
    def pair(x: str, y: str) -> Array:
        return np.array([deciding[x][0], deciding[y][0]])

    def number(name: str) -> float:
        return float(deciding[name][0])

    return AgentView(
        position=pair("px", "py"),
        velocity=pair("vx", "vy"),
        preferred_velocity=pair("pvx", "pvy"),
        goal=pair("gx", "gy"),
        radius=number("radius"),
        preferred_speed=number("preferred"),
        max_speed=number("max_speed"),
        max_acceleration=number("max_acceleration"),
        time_step=number("time_step"),
        relaxation_time=number("relaxation"),
    )


def _neighbours(
    cost: NumpyCost, radius: float, near: Rows[NeighbourRecord], walls: Rows[WallRecord]
) -> Neighbours:
    surface = float(cost.from_surface)
    close = near["d2"] < (cost.range + surface * near["reach"]) ** 2
    beside = walls["d2"] <= (cost.range + surface * radius) ** 2
    return Neighbours(
        offset=_columns(near, close, "rx", "ry"),
        velocity=_columns(near, close, "nvx", "nvy"),
        preferred_velocity=_columns(near, close, "npx", "npy"),
        radius=near["reach"][close] - radius,
        fixed=near["static"][close] != 0.0,
        walls=_columns(walls, beside, "ax", "ay", "bx", "by"),
    )


def _columns(rows: Rows[Any], chosen: Mask, *names: str) -> Array:
    """Return some fields of the chosen rows, side by side."""
    return np.column_stack([rows[name][chosen] for name in names])


@kernel
def _evaluate(
    table: Rows[DiscRecord], starts: Starts, low: float, height: float, decides: Mask, goal: Array,
    walls: Array, grid_frame: Array, grid_first: Indices, grid_cells: Indices, reach: float,
    traits: Rows[DecisionTraitsRecord], settings: Rows[SettingsRecord],
    random: Array, near: Rows[NeighbourRecord], found: Rows[WallRecord],
    deciding: Rows[AgentRecord], functions: Functions, weights: Array,
    active: Indices, velocities: Array, total: Array,
) -> None:  # fmt: skip
    """Add compiled costs of velocities (N, S, 2) to ``total`` (N, S).

    Args:
        table to deciding: fields of `Surroundings`.
        functions, weights: see `AgentCosts`.
        active: (K,) scratch.
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
        for s in range(velocities.shape[1]):
            speed = np.hypot(velocities[i, s, 0], velocities[i, s, 1])
            agent.fastest = agent.asked_radius = max(agent.fastest, speed)
        terms = prepare(around, b, functions, weights, active)
        costs = AgentCosts(agent, functions, weights, active[:terms])
        for s in range(velocities.shape[1]):
            for k in range(weights.shape[0]):
                if weights[k] != 0.0:
                    total[i, s] += weights[k] * cost_of(
                        costs, k, velocities[i, s, 0], velocities[i, s, 1]
                    )
        random[i] = agent.random
