"""Total cost of given velocities, without any shortcut."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from crowdbot.core.crowd.cost import (
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
    Array,
    Neighbours,
    NumpyCost,
)
from crowdbot.core.crowd.mix import Addresses, Mix, Scene, cost_of, describe, prepare
from crowdbot.core.crowd.neighbours import (
    INDEX,
    WANTED_X,
    WANTED_Y,
    Starts,
    gather,
    gather_walls,
)
from crowdbot.core.crowd.policy import CrowdView


class Evaluator:
    """Costs of a mix at any velocities, for mixes of compiled and vectorised functions."""

    def __init__(self, mix: Mix) -> None:
        self.mix = mix

    def total(self, view: CrowdView, velocities: Array, *, compiled: bool = True) -> Array:
        """Weighted sums (N, S) of all costs at velocities (N, S, 2), m/s.

        Zero for agents that are absent or have arrived, ``inf`` where a velocity is forbidden.

        Args:
            compiled: False leaves the compiled functions out.

        Raises:
            ValueError: a vectorised function returned NaN or a wrong number of costs.
        """
        mix, scene = self.mix, self.mix.scene(view)
        total = np.zeros(velocities.shape[:2])
        settings = mix.settings(view)
        if compiled and mix.compiled:
            _evaluate(
                scene.table, scene.starts, scene.low, scene.height, scene.who, scene.goal,
                scene.walls, scene.reach, scene.agent, scene.near, scene.found, mix.traits,
                settings, mix.random, mix.bases, mix.prepares, mix.excesses, mix.params_at,
                mix.weights, mix.work_at, np.ascontiguousarray(velocities), total,
            )  # fmt: skip
        if mix.vectorised:
            self._add_vectorised(scene, settings, velocities, total)
        return total

    def _add_vectorised(
        self, scene: Scene, settings: Array, velocities: Array, total: Array
    ) -> None:
        mix, agent = self.mix, scene.agent
        for b, row in enumerate(scene.table):
            i = int(row[INDEX])
            if i < 0 or not scene.who[i] or not (row[WANTED_X] or row[WANTED_Y]):
                continue
            describe(scene.table, b, mix.traits, scene.goal, settings, mix.random, i, agent)
            count = gather(
                scene.table, scene.starts, scene.low, scene.height, b, scene.reach, scene.near
            )
            walls = gather_walls(scene.walls, agent[PX], agent[PY], scene.reach, scene.found)
            seen = _agent_view(agent)
            for cost in mix.vectorised:
                others = _neighbours(cost, agent, scene.near[:count], scene.found[:walls])
                found = np.asarray(cost.evaluate(velocities[i], seen, others), np.float64)
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


@njit(cache=True, error_model="numpy")
def _evaluate(
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
    params_at: Addresses,
    weights: Array,
    work_at: Addresses,
    velocities: Array,
    total: Array,
) -> None:
    active = np.empty(weights.shape[0], np.int64)
    has_excess = np.empty(weights.shape[0], np.bool_)
    for b in range(table.shape[0]):
        i = int(table[b, INDEX])
        if i < 0 or not who[i] or (table[b, WANTED_X] == 0.0 and table[b, WANTED_Y] == 0.0):
            continue
        describe(table, b, traits, goal, settings, random, i, agent)
        for s in range(velocities.shape[1]):
            speed = np.hypot(velocities[i, s, 0], velocities[i, s, 1])
            agent[FASTEST] = max(agent[FASTEST], speed)
        terms = prepare(
            table, starts, low, height, b, walls, reach, agent, near, found, prepares, params_at,
            weights, work_at, active,
        )  # fmt: skip
        has_excess[:] = False
        for term in range(terms):
            has_excess[active[term]] = True
        for s in range(velocities.shape[1]):
            for k in range(weights.shape[0]):
                if weights[k] != 0.0:
                    total[i, s] += weights[k] * cost_of(
                        k, velocities[i, s, 0], velocities[i, s, 1], agent, bases, excesses,
                        has_excess[k], params_at, work_at,
                    )  # fmt: skip
        random[i] = agent[RANDOM]
