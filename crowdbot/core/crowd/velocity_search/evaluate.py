"""Total cost of given velocities, without any shortcut."""

from __future__ import annotations

import numpy as np

from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.velocity_search.agent_costs import (
    AgentCosts,
    Functions,
    cost_of,
    prepare,
)
from crowdbot.core.crowd.velocity_search.cost import (
    ASKED_RADIUS,
    AX,
    BY,
    D2,
    FASTEST,
    GX,
    GY,
    MAX_ACCELERATION,
    MAX_SPEED,
    NPX,
    NPY,
    NVX,
    NVY,
    PREFERRED,
    PVX,
    PVY,
    PX,
    PY,
    RADIUS,
    RANDOM,
    REACH,
    RELAXATION,
    RX,
    RY,
    STATIC,
    TIME_STEP,
    VX,
    VY,
    WALL_D2,
    AgentView,
    Neighbours,
    NumpyCost,
)
from crowdbot.core.crowd.velocity_search.neighbours import Starts, gather, gather_walls
from crowdbot.core.crowd.velocity_search.surroundings import Surroundings, describe
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts
from crowdbot.core.support.compile import kernel
from crowdbot.core.support.immutable import immutable, immutable_fields
from crowdbot.core.types.arrays import Array, Indices, Mask


class Evaluator:
    """Weighted costs of any velocities, by compiled and vectorised functions."""

    def __init__(self, costs: WeightedCosts) -> None:
        self.costs = costs

    def total(self, view: CrowdView, velocities: Array, *, compiled: bool = True) -> Array:
        """Weighted sums (N, S) of all costs at velocities (N, S, 2), m/s.

        Zero for agents that are absent or have arrived, ``inf`` where a velocity is forbidden.

        Args:
            compiled: False leaves the compiled functions out.

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
        agent = around.agent
        for b in range(len(around.table)):
            i = describe(around, b)
            if i < 0:
                continue
            count = gather(
                around.table, around.starts, around.low, around.height, b, around.reach, around.near
            )
            walls = gather_walls(around.walls, agent[PX], agent[PY], around.reach, around.found)
            seen, tried = immutable_fields(_agent_view(agent)), immutable(velocities[i])
            for cost in self.costs.vectorised:
                others = immutable_fields(
                    _neighbours(cost, agent, around.near[:count], around.found[:walls])
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


def _agent_view(agent: Array) -> AgentView:
    return AgentView(
        position=agent[[PX, PY]],
        velocity=agent[[VX, VY]],
        preferred_velocity=agent[[PVX, PVY]],
        goal=agent[[GX, GY]],
        radius=float(agent[RADIUS]),
        preferred_speed=float(agent[PREFERRED]),
        max_speed=float(agent[MAX_SPEED]),
        max_acceleration=float(agent[MAX_ACCELERATION]),
        time_step=float(agent[TIME_STEP]),
        relaxation_time=float(agent[RELAXATION]),
    )


def _neighbours(cost: NumpyCost, agent: Array, near: Array, walls: Array) -> Neighbours:
    surface = float(cost.from_surface)
    near = near[near[:, D2] < (cost.range + surface * near[:, REACH]) ** 2]
    walls = walls[walls[:, WALL_D2] <= (cost.range + surface * agent[RADIUS]) ** 2]
    return Neighbours(
        offset=near[:, [RX, RY]],
        velocity=near[:, [NVX, NVY]],
        preferred_velocity=near[:, [NPX, NPY]],
        radius=near[:, REACH] - agent[RADIUS],
        fixed=near[:, STATIC] != 0.0,
        walls=walls[:, AX : BY + 1].copy(),
    )


@kernel
def _evaluate(
    table: Array, starts: Starts, low: float, height: float, who: Mask, goal: Array, walls: Array,
    reach: float, traits: Array, settings: Array, random: Array, near: Array, found: Array,
    agent: Array, functions: Functions, weights: Array,
    active: Indices, velocities: Array, total: Array,
) -> None:  # fmt: skip
    """Add compiled costs of velocities (N, S, 2) to ``total`` (N, S).

    Args:
        table to agent: fields of `Surroundings`.
        functions, weights: see `AgentCosts`.
        active: (K,) scratch.
    """
    around = Surroundings(
        table, starts, low, height, who, goal, walls, reach, traits, settings, random, near,
        found, agent,
    )  # fmt: skip
    for b in range(table.shape[0]):
        i = describe(around, b)
        if i < 0:
            continue
        for s in range(velocities.shape[1]):
            speed = np.hypot(velocities[i, s, 0], velocities[i, s, 1])
            agent[FASTEST] = agent[ASKED_RADIUS] = max(agent[FASTEST], speed)
        terms = prepare(around, b, functions, weights, active)
        costs = AgentCosts(agent, functions, weights, active[:terms])
        for s in range(velocities.shape[1]):
            for k in range(weights.shape[0]):
                if weights[k] != 0.0:
                    total[i, s] += weights[k] * cost_of(
                        costs, k, velocities[i, s, 0], velocities[i, s, 1]
                    )
        random[i] = agent[RANDOM]
