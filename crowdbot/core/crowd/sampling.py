"""Sampling in velocity space: each agent takes the candidate of least total cost.

Candidates are fixed in the frame of the preferred velocity. Their base costs are tabulated and
sorted once per agent, so that the search stops at the first candidate whose lower bound exceeds
the best cost so far: exact branch and bound.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from crowdbot.core.crowd.cost import (
    AGENT_SIZE,
    BASE,
    EXCESS,
    FASTEST,
    NEAR_COLUMNS,
    PREFERRED,
    PREPARE,
    PX,
    PY,
    RADIUS,
    TIME_STEP,
    VX,
    VY,
    WORK_COLUMNS,
    Array,
    CompiledCost,
    FunctionPointer,
    borrow2,
    borrow3,
)
from crowdbot.core.crowd.neighbours import BINDEX, BRADIUS, BVX, BVY, BX, BY, gather
from crowdbot.core.crowd.policy import Agents, CrowdView


def fan(speeds: int, angles: int, opening: float) -> Array:
    """Candidates (S, 2) for a preferred velocity (1, 0): rest, then rings, slow to fast.

    Within a ring from -opening/2 to +opening/2, counter-clockwise.
    """
    turns = 2.0 * math.pi
    step = opening / (angles if opening == turns else angles - 1)
    theta = -0.5 * opening + step * np.arange(angles)
    rings = [
        np.column_stack([np.cos(theta), np.sin(theta)]) * (s / (speeds - 1))
        for s in range(1, speeds)
    ]
    return np.concatenate([np.zeros((1, 2)), *rings])


@dataclass(frozen=True, slots=True)
class CandidateTable:
    """Per agent: lower bounds (N, S) in rising order and the candidates (N, S) they belong to."""

    bound: Array
    index: NDArray[np.int64]


@njit(cache=True, error_model="numpy")
def _tabulate(
    candidates: Array,
    preferred: Array,
    max_speed: Array,
    base: Any,
    params: Array,
    weight: float,
    total: Array,
) -> None:
    for i in range(total.shape[0]):
        for c in range(candidates.shape[0]):
            ux, uy = preferred[i] * candidates[c, 0], preferred[i] * candidates[c, 1]
            total[i, c] += weight * base(ux, uy, preferred[i], max_speed[i], params)


def tabulate(candidates: Array, agents: Agents, costs: Sequence[CompiledCost]) -> CandidateTable:
    """Sum the base costs of a mix and sort each agent's candidates by them."""
    total = np.zeros((len(agents), len(candidates)))
    for cost in costs:
        base = FunctionPointer(cost.base, BASE)
        _tabulate(
            candidates, agents.preferred_speed, agents.max_speed, base, cost.params, cost.weight,
            total,
        )  # fmt: skip
    index = np.argsort(total, axis=1, kind="stable")
    return CandidateTable(np.take_along_axis(total, index, axis=1), index)


class Sampler:
    """A mix of costs over a fan of candidates, ready to decide for one set of agents."""

    def __init__(self, candidates: Array, costs: Sequence[CompiledCost], agents: Agents) -> None:
        largest = float(np.max(agents.radius, initial=0.0))
        mix = sorted(costs, key=lambda c: c.reach(largest, largest))  # few neighbours first
        self._candidates = candidates
        self._table = tabulate(candidates, agents, mix)
        self._mix = mix
        self._prepares = tuple(FunctionPointer(c.prepare, PREPARE) for c in mix)
        self._excesses = tuple(FunctionPointer(c.excess, EXCESS) for c in mix)
        width = max(len(c.params) for c in mix)
        self._params = np.array([np.pad(c.params, (0, width - len(c.params))) for c in mix])
        self._weights = np.array([c.weight for c in mix])
        self._work = np.zeros((0, 0, WORK_COLUMNS))

    def choose(self, view: CrowdView) -> Array:
        """Chosen velocities (N, 2), m/s; zero for agents that are absent."""
        bodies = self._bodies(view)
        chosen = np.zeros_like(view.position)
        rows = 1 + len(bodies) + len(view.walls)
        if self._work.shape[1] < rows:
            self._work = np.zeros((len(self._mix), rows, WORK_COLUMNS))
        largest = float(np.max(bodies[:, BRADIUS], initial=0.0))
        reach = max(c.reach(largest, largest) for c in self._mix)
        _choose(
            bodies, view.goal, view.agents.preferred_speed, view.walls, reach, view.dt,
            self._candidates, self._table.bound, self._table.index,
            self._prepares, self._excesses, self._params, self._weights, self._work, chosen,
        )  # fmt: skip
        return chosen

    @staticmethod
    def _bodies(view: CrowdView) -> Array:
        """Everybody present and the robots, as a table sorted by x; robots have index -1."""
        who = np.flatnonzero(view.present)
        people = np.column_stack(
            [view.position[who], view.velocity[who], view.agents.radius[who], who]
        )
        robots = np.column_stack([view.robot, np.full(len(view.robot), -1.0)])
        bodies = np.concatenate([people, robots])
        return np.ascontiguousarray(bodies[np.argsort(bodies[:, BX], kind="stable")])


@njit(cache=True, error_model="numpy")
def _choose(
    bodies: Array,
    goal: Array,
    preferred: Array,
    walls: Array,
    reach: float,
    dt: float,
    candidates: Array,
    bound: Array,
    index: NDArray[np.int64],
    prepares: Any,
    excesses: Any,
    params: Array,
    weights: Array,
    work: Array,
    chosen: Array,
) -> None:
    work = borrow3(work.ctypes, *work.shape)
    params = borrow2(params.ctypes, *params.shape)
    agent = np.empty(AGENT_SIZE)
    near = np.empty((bodies.shape[0], NEAR_COLUMNS))
    items = np.empty(weights.shape[0], np.int64)
    for b in range(bodies.shape[0]):
        i = int(bodies[b, BINDEX])
        if i < 0:
            continue
        gx, gy = goal[i, 0] - bodies[b, BX], goal[i, 1] - bodies[b, BY]
        to_goal = math.hypot(gx, gy)
        if to_goal <= bodies[b, BRADIUS]:
            continue  # arrived: the chosen velocity stays zero
        agent[PX], agent[PY], agent[VX], agent[VY] = (
            bodies[b, BX], bodies[b, BY], bodies[b, BVX], bodies[b, BVY],
        )  # fmt: skip
        agent[RADIUS], agent[PREFERRED], agent[TIME_STEP] = bodies[b, BRADIUS], preferred[i], dt
        agent[FASTEST] = preferred[i]
        count = gather(bodies, b, reach, near)
        for k in range(weights.shape[0]):
            items[k] = prepares[k](agent, near, count, walls, params[k], work[k])
            if weights[k] == 0.0:
                items[k] = 0
        ex, ey = preferred[i] * gx / to_goal, preferred[i] * gy / to_goal
        best, best_index = math.inf, candidates.shape[0]
        for c in range(candidates.shape[0]):
            if bound[i, c] > best:
                break
            q = index[i, c]
            ux = candidates[q, 0] * ex - candidates[q, 1] * ey
            uy = candidates[q, 0] * ey + candidates[q, 1] * ex
            total = bound[i, c]
            for k in range(weights.shape[0]):
                if items[k] > 0:
                    budget = (best - total) / weights[k]
                    total += weights[k] * excesses[k](ux, uy, budget, agent, work[k], params[k])
                    if total > best:
                        break
            if total < best or (total == best and q < best_index):
                best, best_index = total, q
                chosen[i, 0], chosen[i, 1] = ux, uy
