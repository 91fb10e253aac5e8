"""A mix of cost functions made ready for one decision of a crowd."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.bodies import most_bodies, write_bodies
from crowdbot.core.crowd.calls import address_of, call_base, call_excess, call_prepare
from crowdbot.core.crowd.cost import (
    AGENT_SIZE,
    BASE,
    DESCENDS,
    EXCESS,
    FASTEST,
    FLOOR,
    GRADIENT,
    GX,
    GY,
    MAX_ACCELERATION,
    MAX_SPEED,
    NEAR_COLUMNS,
    OPTIMUM,
    PARITY,
    PREFERRED,
    PREPARE,
    PVX,
    PVY,
    PX,
    PY,
    RADIUS,
    RANDOM,
    RELAXATION,
    TIME_STEP,
    VX,
    VY,
    WALL_COLUMNS,
    WEIGHT,
    WORK_COLUMNS,
    Array,
    CompiledCost,
    NumpyCost,
)
from crowdbot.core.crowd.minstd import seeds
from crowdbot.core.crowd.neighbours import (
    BODY_COLUMNS,
    Starts,
    gather,
    gather_walls,
    sort_bodies,
    strip_height,
)
from crowdbot.core.crowd.neighbours import BODY_RADIUS as B_RADIUS
from crowdbot.core.crowd.neighbours import VX as B_VX
from crowdbot.core.crowd.neighbours import VY as B_VY
from crowdbot.core.crowd.neighbours import WANTED_X as B_WX
from crowdbot.core.crowd.neighbours import WANTED_Y as B_WY
from crowdbot.core.crowd.neighbours import X as B_X
from crowdbot.core.crowd.neighbours import Y as B_Y
from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.kernel import kernel

Addresses = NDArray[np.intp]
# Columns of ``traits``; entries of ``settings``.
T_PREFERRED, T_MAX_SPEED, T_MAX_ACCELERATION, T_WEIGHT = range(4)
S_DT, S_RELAXATION, S_PARITY = range(3)


@dataclass(slots=True)
class Scene:
    """Everybody's surroundings at one decision, in the form that compiled code takes.

    Attributes:
        table, starts, low, height: bodies as `crowdbot.core.crowd.neighbours` sorts them.
        who: (N,) whose choice is wanted.
        goal: (N, 2), m.
        walls: (S, 4), m.
        reach: largest centre distance at which a neighbour may count, m.
        near, found, agent: scratch.
    """

    table: Array
    starts: Starts
    low: float
    height: float
    who: NDArray[np.bool_]
    goal: Array
    walls: Array
    reach: float
    near: Array
    found: Array
    agent: Array = field(default_factory=lambda: np.zeros(AGENT_SIZE))


class Mix:
    """Weighted cost functions for one set of agents.

    Args:
        relaxation_time: the policy's, s.
        parity: do as the original engine does, defects included; for comparisons only.
        weight: (N,) see ``WEIGHT`` in `crowdbot.core.crowd.cost`; 1 by default.
    """

    def __init__(
        self,
        costs: Sequence[CompiledCost | NumpyCost],
        agents: Agents,
        *,
        relaxation_time: float = 0.0,
        parity: bool = False,
        weight: Array | None = None,
    ) -> None:
        self.agents, self.parity, self.relaxation_time = agents, parity, relaxation_time
        self._all = tuple(costs)
        self.largest = float(np.max(agents.radius, initial=0.0))
        # Few neighbours first: their excess is the cheaper one.
        self.compiled = sorted(
            (c for c in costs if isinstance(c, CompiledCost)),
            key=lambda c: c.reach(self.largest, self.largest),
        )
        self.vectorised = [c for c in costs if isinstance(c, NumpyCost)]
        self.ordered = any(c.ordered for c in self.compiled)
        self.bases = _addresses([c.base for c in self.compiled], BASE)
        self.prepares = _addresses([c.prepare for c in self.compiled], PREPARE)
        self.excesses = _addresses([c.excess for c in self.compiled], EXCESS)
        self.gradients = _addresses([c.gradient for c in self.compiled], GRADIENT)
        self.optima = _addresses([c.optimum for c in self.compiled], OPTIMUM)
        self.floors = _addresses([c.floor for c in self.compiled], FLOOR)
        width = max((len(c.params) for c in self.compiled), default=2)
        self.params = np.zeros((len(self.compiled), width))
        for row, cost in zip(self.params, self.compiled, strict=True):
            row[: len(cost.params)] = cost.params
        self.params_at = layers(self.params)
        self.weights = np.array([c.weight for c in self.compiled], np.float64)
        ones = np.ones(len(agents)) if weight is None else weight
        self.traits = np.column_stack(
            [agents.preferred_speed, agents.max_speed, agents.max_acceleration, ones]
        )
        self.random = seeds(agents.id)
        self._make_work(1)
        self._bodies = self._table = np.zeros((0, BODY_COLUMNS))

    def _make_work(self, rows: int) -> None:
        self.work = np.zeros((len(self.compiled), rows, WORK_COLUMNS))
        self.work_at = layers(self.work)

    def reach(self, view: CrowdView) -> float:
        """Centre distance beyond which nobody matters to anybody, m."""
        largest = self.largest
        for discs in (view.robot, view.pillars):
            if len(discs):
                largest = max(largest, float(discs[:, -1].max()))
        return max((c.reach(self.largest, largest) for c in self._all), default=0.0)

    def settings(self, view: CrowdView) -> Array:
        """Numbers that hold for all agents; see the ``S_`` constants."""
        return np.array([view.dt, self.relaxation_time, float(self.parity)])

    def scene(self, view: CrowdView) -> Scene:
        """Sort the bodies of a view."""
        reach, torus = self.reach(view), view.torus
        room = most_bodies(
            len(view.position), len(view.robot) + len(view.pillars), torus is not None
        )
        if len(self._bodies) < room:
            self._bodies = np.zeros((room, BODY_COLUMNS))
            self._table = np.zeros((room, BODY_COLUMNS))
        box = np.array(torus if torus is not None else (0.0, 0.0, 0.0, 0.0))
        count = write_bodies(
            view.position, view.velocity, view.goal, view.agents.radius,
            view.agents.preferred_speed, view.present, view.robot, view.pillars, box,
            view.diagonal, reach, self._bodies,
        )  # fmt: skip
        if self.work.shape[1] < 1 + count + len(view.walls):
            self._make_work(1 + room + len(view.walls))
        height = strip_height(self._bodies, count, reach)
        low, starts = sort_bodies(self._bodies, count, height, self._table)
        return Scene(
            table=self._table[:count], starts=starts, low=low, height=height,
            who=view.present if view.decides is None else view.present & view.decides,
            goal=view.goal, walls=view.walls, reach=reach,
            near=np.empty((count, NEAR_COLUMNS)), found=np.empty((len(view.walls), WALL_COLUMNS)),
        )  # fmt: skip


def _addresses(functions: Sequence[object], signature: object) -> Addresses:
    return np.array([0 if f is None else address_of(f, signature) for f in functions], np.intp)


@kernel
def describe(
    table: Array,
    b: int,
    traits: Array,
    goal: Array,
    settings: Array,
    random: Array,
    i: int,
    agent: Array,
) -> None:
    """Write the ``agent`` vector of agent i, who is row b of the body table."""
    agent[PX], agent[PY], agent[VX], agent[VY] = (
        table[b, B_X], table[b, B_Y], table[b, B_VX], table[b, B_VY],
    )  # fmt: skip
    agent[RADIUS], agent[PREFERRED] = table[b, B_RADIUS], traits[i, T_PREFERRED]
    agent[TIME_STEP], agent[RELAXATION] = settings[S_DT], settings[S_RELAXATION]
    agent[GX], agent[GY] = goal[i, 0], goal[i, 1]
    agent[PVX], agent[PVY] = table[b, B_WX], table[b, B_WY]
    agent[MAX_SPEED], agent[WEIGHT] = traits[i, T_MAX_SPEED], traits[i, T_WEIGHT]
    agent[MAX_ACCELERATION] = traits[i, T_MAX_ACCELERATION]
    agent[PARITY], agent[RANDOM] = settings[S_PARITY], random[i]
    agent[DESCENDS] = 0.0
    agent[FASTEST] = max(agent[MAX_SPEED], math.hypot(agent[VX], agent[VY]))


@kernel
def prepare(
    table: Array,
    starts: Starts,
    low: float,
    height: float,
    b: int,
    walls: Array,
    reach: float,
    agent: Array,
    near: Array,
    found: Array,
    prepares: Addresses,
    params_at: Addresses,
    weights: Array,
    work_at: Addresses,
    active: NDArray[np.int64],
) -> int:
    """Prepare all functions of a mix for one agent.

    Returns:
        how many have an excess; their numbers are in ``active``.
    """
    near_count = gather(table, starts, low, height, b, reach, near)
    wall_count = gather_walls(walls, agent[PX], agent[PY], reach, found)
    terms = 0
    for k in range(prepares.shape[0]):
        items = call_prepare(
            prepares[k], agent.ctypes.data, near.ctypes.data, near_count, found.ctypes.data,
            wall_count, params_at[k], work_at[k],
        )  # fmt: skip
        if items > 0 and weights[k] != 0.0:
            active[terms] = k
            terms += 1
    return terms


@kernel
def base_cost(
    ux: float,
    uy: float,
    agent: Array,
    bases: Addresses,
    params_at: Addresses,
    weights: Array,
) -> float:
    """Weighted sum of the bases for a candidate in the world frame."""
    preferred = agent[PREFERRED]
    along = (ux * agent[PVX] + uy * agent[PVY]) / preferred
    across = (uy * agent[PVX] - ux * agent[PVY]) / preferred
    total = 0.0
    for k in range(bases.shape[0]):
        if weights[k] != 0.0:
            total += weights[k] * call_base(
                bases[k], along, across, preferred, agent[MAX_SPEED], params_at[k]
            )
    return total


@kernel
def cost_of(
    k: int,
    ux: float,
    uy: float,
    agent: Array,
    bases: Addresses,
    excesses: Addresses,
    has_excess: bool,
    params_at: Addresses,
    work_at: Addresses,
) -> float:
    """Cost of a velocity by function k alone, without its weight."""
    preferred = agent[PREFERRED]
    along = (ux * agent[PVX] + uy * agent[PVY]) / preferred
    across = (uy * agent[PVX] - ux * agent[PVY]) / preferred
    cost = call_base(bases[k], along, across, preferred, agent[MAX_SPEED], params_at[k])
    if has_excess:
        cost += call_excess(
            excesses[k], ux, uy, math.inf, agent.ctypes.data, work_at[k], params_at[k]
        )
    return float(cost)


def layers(array: Array) -> Addresses:
    """Addresses of the parts of an array along its first axis; valid while it lives."""
    return np.asarray(array.ctypes.data + array.strides[0] * np.arange(len(array)), np.intp)
