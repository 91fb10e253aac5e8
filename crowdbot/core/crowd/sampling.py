"""Sampling in velocity space: each agent takes the candidate of least total cost.

Candidates are fixed in the frame of the preferred velocity. Their base costs are tabulated and
sorted once per agent, so that the search stops at the first candidate whose lower bound exceeds
the best cost so far: exact branch and bound.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from crowdbot.core.crowd.calls import address_of, call_base, call_excess, call_prepare
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
)
from crowdbot.core.crowd.neighbours import (
    BINDEX,
    BODY_COLUMNS,
    BRADIUS,
    BVX,
    BVY,
    BX,
    BY,
    gather,
    sort_bodies,
)
from crowdbot.core.crowd.policy import Agents, CrowdView

Addresses = NDArray[np.intp]


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
    base: int,
    params: Array,
    weight: float,
    total: Array,
) -> None:
    at = params.ctypes.data
    for i in range(total.shape[0]):
        for c in range(candidates.shape[0]):
            ux, uy = preferred[i] * candidates[c, 0], preferred[i] * candidates[c, 1]
            total[i, c] += weight * call_base(base, ux, uy, preferred[i], max_speed[i], at)


def tabulate(candidates: Array, agents: Agents, costs: Sequence[CompiledCost]) -> CandidateTable:
    """Sum the base costs of a mix and sort each agent's candidates by them."""
    total = np.zeros((len(agents), len(candidates)))
    for cost in costs:
        _tabulate(
            candidates, agents.preferred_speed, agents.max_speed, address_of(cost.base, BASE),
            cost.params, cost.weight, total,
        )  # fmt: skip
    index = np.argsort(total, axis=1, kind="stable")
    return CandidateTable(np.take_along_axis(total, index, axis=1), index)


class Sampler:
    """A mix of costs over a fan of candidates, ready to decide for one set of agents."""

    def __init__(self, candidates: Array, costs: Sequence[CompiledCost], agents: Agents) -> None:
        self._largest = float(np.max(agents.radius, initial=0.0))
        # Few neighbours first.
        self._mix = sorted(costs, key=lambda c: c.reach(self._largest, self._largest))
        self._candidates = candidates
        self._table = tabulate(candidates, agents, self._mix)
        self._prepares = np.array([address_of(c.prepare, PREPARE) for c in self._mix], np.intp)
        self._excesses = np.array([address_of(c.excess, EXCESS) for c in self._mix], np.intp)
        width = max(len(c.params) for c in self._mix)
        self._params = np.array([np.pad(c.params, (0, width - len(c.params))) for c in self._mix])
        self._weights = np.array([c.weight for c in self._mix])
        # Scratch, and where each search begins: the previous choice is a good bound. Neither
        # changes what is chosen.
        self._bodies = np.zeros((0, BODY_COLUMNS))
        self._work = np.zeros((0, 0, WORK_COLUMNS))
        self._first = np.zeros(len(agents), np.int64)

    def choose(self, view: CrowdView) -> Array:
        """Chosen velocities (N, 2), m/s; zero for agents that are absent."""
        self._make_room(len(view.position) + len(view.robot), len(view.walls))
        count = sort_bodies(
            view.position, view.velocity, view.agents.radius, view.present, view.robot, self._bodies
        )
        largest = max([self._largest, *view.robot[:, -1].tolist()])
        reach = max(c.reach(largest, largest) for c in self._mix)
        chosen = np.zeros_like(view.position)
        _choose(
            self._bodies, count, view.goal, view.agents.preferred_speed, view.walls, reach, view.dt,
            self._candidates, self._table.bound, self._table.index, self._prepares, self._excesses,
            self._params, self._weights, self._work, self._first, chosen,
        )  # fmt: skip
        return chosen

    def _make_room(self, bodies: int, walls: int) -> None:
        if len(self._bodies) < bodies:
            self._bodies = np.zeros((bodies, BODY_COLUMNS))
        if self._work.shape[1] < 1 + bodies + walls:
            self._work = np.zeros((len(self._mix), 1 + bodies + walls, WORK_COLUMNS))


@njit(cache=True, error_model="numpy")
def _choose(
    bodies: Array,
    total: int,
    goal: Array,
    preferred: Array,
    walls: Array,
    reach: float,
    dt: float,
    candidates: Array,
    bound: Array,
    index: NDArray[np.int64],
    prepares: Addresses,
    excesses: Addresses,
    params: Array,
    weights: Array,
    work: Array,
    first: NDArray[np.int64],
    chosen: Array,
) -> None:
    """Everybody's choice; see `Sampler`."""
    agent = np.empty(AGENT_SIZE)
    near = np.empty((bodies.shape[0], NEAR_COLUMNS))
    # Addresses, for the pointers that cost functions take.
    agent_at, near_at, walls_at = agent.ctypes.data, near.ctypes.data, walls.ctypes.data
    params_at, work_at = _layers(params), _layers(work)
    active = np.empty(weights.shape[0], np.int64)  # costs whose excess may differ from zero
    for b in range(total):
        i = int(bodies[b, BINDEX])
        if i < 0:
            continue
        gx, gy = goal[i, 0] - bodies[b, BX], goal[i, 1] - bodies[b, BY]
        to_goal = math.hypot(gx, gy)
        if to_goal <= bodies[b, BRADIUS]:
            continue  # arrived: the chosen velocity stays zero
        _describe(bodies, b, preferred[i], dt, agent)
        near_count = gather(bodies, total, b, reach, near)
        terms = 0
        for k in range(weights.shape[0]):
            items = call_prepare(
                prepares[k], agent_at, near_at, near_count, walls_at, walls.shape[0], params_at[k],
                work_at[k],
            )  # fmt: skip
            if items > 0 and weights[k] != 0.0:
                active[terms] = k
                terms += 1
        ex, ey = preferred[i] * gx / to_goal, preferred[i] * gy / to_goal
        best, best_index, best_place = math.inf, candidates.shape[0], first[i]
        for attempt in range(-1, candidates.shape[0]):
            c = first[i] if attempt < 0 else attempt
            if attempt >= 0 and (bound[i, c] > best or c == first[i]):
                if bound[i, c] > best:
                    break
                continue
            q = index[i, c]
            ux = candidates[q, 0] * ex - candidates[q, 1] * ey
            uy = candidates[q, 0] * ey + candidates[q, 1] * ex
            cost = bound[i, c]
            for term in range(terms):
                k = active[term]
                budget = (best - cost) / weights[k]
                cost += weights[k] * call_excess(
                    excesses[k], ux, uy, budget, agent_at, work_at[k], params_at[k]
                )
                if cost > best:
                    break
            if cost < best or (cost == best and q < best_index):
                best, best_index, best_place = cost, q, c
                chosen[i, 0], chosen[i, 1] = ux, uy
        first[i] = best_place


@njit(cache=True, error_model="numpy")
def _describe(bodies: Array, b: int, preferred: float, dt: float, agent: Array) -> None:
    agent[PX], agent[PY], agent[VX], agent[VY] = (
        bodies[b, BX], bodies[b, BY], bodies[b, BVX], bodies[b, BVY],
    )  # fmt: skip
    agent[RADIUS], agent[PREFERRED], agent[TIME_STEP] = bodies[b, BRADIUS], preferred, dt
    agent[FASTEST] = preferred


@njit(cache=True, error_model="numpy")
def _layers(array: Array) -> Addresses:
    """Addresses of the parts of an array along its first axis."""
    at = np.empty(array.shape[0], np.intp)
    for k in range(array.shape[0]):
        at[k] = array.ctypes.data + k * array.strides[0]
    return at
