"""Sampling in velocity space: each agent takes the candidate with the lowest total cost.

Candidates are fixed in a frame. In the frame of the preferred velocity, their base costs are
tabulated and sorted once per agent, so that the search stops at the first candidate whose lower
bound exceeds the best cost so far: exact branch and bound. In other frames the bounds are computed
at each decision, and candidates above the best cost are skipped.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.velocity_search.agent_costs import (
    AgentCosts,
    Functions,
    base_cost,
    in_preferred_frame,
    prepare,
)
from crowdbot.core.crowd.velocity_search.broken import check_numbers, report_broken
from crowdbot.core.crowd.velocity_search.candidates import (
    ALONG_PREFERRED,
    ZERO,
    FanOptions,
    Sampling,
    draw_candidates,
    frame_of,
    radius_of,
)
from crowdbot.core.crowd.velocity_search.evaluate import Evaluator
from crowdbot.core.crowd.velocity_search.neighbours import DiscRecord, Starts
from crowdbot.core.crowd.velocity_search.records import (
    AGENT,
    AgentRecord,
    NeighbourRecord,
    WallRecord,
)
from crowdbot.core.crowd.velocity_search.search import (
    arrange,
    in_world,
    least_forbidden,
    search,
    set_bounds,
    try_in_order,
)
from crowdbot.core.crowd.velocity_search.single import polar, single_candidates
from crowdbot.core.crowd.velocity_search.surroundings import (
    DecisionTraitsRecord,
    SettingsRecord,
    Surroundings,
    describe,
)
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.support.prefetch import prefetch
from crowdbot.core.support.records import Rows, rows_of
from crowdbot.core.types.arrays import Array, Indices, Mask


class SearchArguments(NamedTuple):
    """Arguments of the compiled search; see `choose_velocities`."""

    options: FanOptions
    ordered: bool
    tabulated: bool
    candidates: Array
    regular: Array
    ranked: Array
    indices: Indices
    first: Indices
    frame: Array
    world: Array
    active: Indices
    tried: Array


class Sampler:
    """Weighted costs over candidate velocities, for the decisions of one set of agents."""

    def __init__(self, sampling: Sampling, costs: WeightedCosts) -> None:
        self.costs = costs
        s = sampling
        self._candidates = np.zeros((s.random, 2)) if s.random else s.fan()
        self._polar = np.zeros((1, 2)) if s.random else polar(s)
        self._options = FanOptions(s.base, s.direction, s.radius, 0.5 * s.opening, s.random > 0)
        # True if the bounds are the same at each decision.
        self._tabulated = not s.random and s.base == ZERO and s.direction == ALONG_PREFERRED
        self._table_dt = math.nan
        # For each agent, or for one that is filled again for each: bounds, and x and y of their
        # candidates; the numbers of these.
        self._ranked = np.zeros((1, 3, len(self._candidates)))
        self._index = np.arange(len(self._candidates))[np.newaxis]
        # Where each search begins: the previous choice is a good bound and does not affect the
        # result.
        self._first = np.zeros(len(costs.agents), np.int64)
        # Scratch: the frame (base, then direction times radius), candidates in the world frame,
        # data of `search` about candidates.
        self._frame = np.zeros(4)
        self._world = np.zeros_like(self._candidates)
        self._tried = np.zeros((5, len(self._candidates)))

    def choose(self, view: CrowdView) -> Array:
        """Return chosen velocities (N, 2), m/s; zero for agents that are absent or have arrived."""
        costs = self.costs
        if costs.vectorised:
            return self._choose_slowly(view)
        around = costs.surroundings(view)
        self._tabulate(view.dt, view)
        chosen = np.zeros((len(view.position), 2))
        choose_velocities(
            *around, costs.functions, costs.weights, *self._options, costs.ordered,
            self._candidates, self._polar, self._tabulated, self._ranked, self._index, self._first,
            self._frame, self._world, costs.active, self._tried, chosen,
        )  # fmt: skip
        check_numbers(costs, view, around)
        return chosen

    def arguments(self, dt: float) -> SearchArguments:
        """Return the arguments of `choose_velocities` for decisions every ``dt`` seconds."""
        self._tabulate(dt, None)
        return SearchArguments(
            self._options, self.costs.ordered, self._tabulated, self._candidates, self._polar,
            self._ranked, self._index, self._first, self._frame, self._world, self.costs.active,
            self._tried,
        )  # fmt: skip

    def candidates(self, view: CrowdView) -> Array:
        """Return regular, or new random, candidates (N, S, 2) of all agents, world frame, m/s."""
        found = np.zeros((len(view.position), *self._candidates.shape))
        _candidates_of(
            *self.costs.surroundings(view), *self._options, self._candidates, self._polar,
            self._frame, found,
        )  # fmt: skip
        return found

    def _choose_slowly(self, view: CrowdView) -> Array:
        """Evaluate every candidate by every function, for vectorised functions."""
        found = self.candidates(view)
        total = Evaluator(self.costs).total(view, found)
        if np.any(np.isnan(total)):
            report_broken(self.costs, view, "a cost")
        best = np.argmin(total, axis=1)
        rows = np.arange(len(found))
        chosen = found[rows, best]
        chosen[~np.isfinite(total[rows, best])] = 0.0
        return np.asarray(chosen)

    def _tabulate(self, dt: float, view: CrowdView | None) -> None:
        """Sum the base costs and sort each agent's candidates by them; ``view`` is for errors."""
        if not self._tabulated or self._table_dt == dt:
            return
        costs = self.costs
        total = np.zeros((len(costs.agents), len(self._candidates)))
        _tabulate(
            self._candidates, costs.traits, self._options.radius, dt, costs.functions,
            costs.weights, rows_of(1, AGENT), total,
        )  # fmt: skip
        if np.any(np.isnan(total)):
            report_broken(costs, view, "a base")
        self._index = np.argsort(total, axis=1, kind="stable")
        bound, (x, y) = np.take_along_axis(total, self._index, axis=1), self._candidates.T
        self._ranked = np.stack([bound, x[self._index], y[self._index]], axis=1)
        self._table_dt = dt


@kernel
def _tabulate(
    candidates: Array,
    traits: Rows[DecisionTraitsRecord],
    radius: int,
    dt: float,
    functions: Functions,
    weights: Array,
    deciding: Rows[AgentRecord],
    total: Array,
) -> None:
    agent = deciding[0]
    for i in range(total.shape[0]):
        agent.preferred, agent.max_speed = traits[i].preferred, traits[i].max_speed
        agent.pvx, agent.time_step = agent.preferred, dt
        agent.max_acceleration = traits[i].max_acceleration
        if agent.preferred <= 0.0:
            continue  # never used
        scale = radius_of(agent, radius)
        for c in range(candidates.shape[0]):
            along, across = in_preferred_frame(
                scale * candidates[c, 0], scale * candidates[c, 1], agent
            )
            total[i, c] = base_cost(
                along, across, agent.preferred, agent.max_speed, functions, weights
            )


@kernel
def choose_velocities(
    table: Rows[DiscRecord], starts: Starts, low: float, height: float, decides: Mask, goal: Array,
    walls: Array, grid_frame: Array, grid_first: Indices, grid_cells: Indices, reach: float,
    traits: Rows[DecisionTraitsRecord], settings: Rows[SettingsRecord],
    random: Array, near: Rows[NeighbourRecord], found: Rows[WallRecord],
    deciding: Rows[AgentRecord],
    functions: Functions, weights: Array,
    base: int, direction: int, radius: int, half: float, drawn: bool,
    ordered: bool, candidates: Array, regular: Array, tabulated: bool, ranked: Array,
    indices: Indices, first: Indices, frame: Array, world: Array, active: Indices, tried: Array,
    chosen: Array,
) -> None:  # fmt: skip
    """Write the chosen velocity of each agent, m/s.

    Args:
        table to deciding: fields of `Surroundings`.
        functions, weights: see `AgentCosts`.
        base to drawn: fields of `FanOptions`.
        ordered: True to call each function for all candidates, in order.
        candidates, regular: (S, 2) of the unit fan; in single precision, see `single`.
        tabulated: True if ``ranked`` holds all agents' sorted candidates; otherwise it is scratch.
        ranked: (N or 1, 3, S) lower bounds of candidates, and their x and y.
        indices: (N or 1, S) indices of these candidates.
        first: (N,) start of each agent's search in ``indices``.
        frame, world, active, tried: (4,), (S, 2), (K,), (5, S) scratch.
        chosen: (N, 2) result, m/s.
    """
    around = Surroundings(
        table, starts, low, height, decides, goal, walls, grid_frame, grid_first, grid_cells,
        reach, traits, settings, random, near, found, deciding,
    )  # fmt: skip
    agent = deciding[0]
    options = FanOptions(base, direction, radius, half, drawn)
    for b in range(table.shape[0]):
        if tabulated and b + 1 < table.shape[0]:
            _fetch_table(int(table[b + 1].index), ranked, indices, first)
        i = describe(around, b)
        if i < 0:
            continue
        scale = frame_of(agent, options, frame)
        terms = prepare(around, b, functions, weights, active)
        costs = AgentCosts(agent, functions, weights, active[:terms])
        unit, to_draw = candidates, drawn
        if settings[0].parity != 0.0 and not (ordered and drawn):
            single_candidates(agent, options, regular, world)
            frame[0], frame[1], frame[2], frame[3] = 0.0, 0.0, 1.0, 0.0  # unchanged
            unit, to_draw = world, False
        if ordered:
            best, place = try_in_order(frame, unit, to_draw, half, scale, costs)
        else:
            row = i if tabulated else 0
            bound, x, y, index = ranked[row, 0], ranked[row, 1], ranked[row, 2], indices[row]
            if to_draw:
                draw_candidates(agent, half, scale, unit)
            if not tabulated or settings[0].parity != 0.0:
                arrange(unit, index, x, y)
            start = first[i]
            if not tabulated:
                start = set_bounds(frame, unit, agent, functions, weights, bound)
            best, place = search(frame, x, y, bound, index, tabulated, start, costs, tried)
        random[i] = agent.random
        if best == math.inf:
            c = -1 if agent.parity == 0.0 else least_forbidden(frame, unit, costs)
        else:
            c = indices[i, place] if tabulated and not ordered else place
            first[i] = place
        if c >= 0:
            chosen[i, 0], chosen[i, 1] = in_world(frame, unit, c)


@inline_kernel
def _fetch_table(i: int, ranked: Array, indices: Indices, first: Indices) -> None:
    """Prefetch the first data of agent i's search while the previous agent decides."""
    if i < 0:
        return
    bound, x, y, start = ranked[i, 0], ranked[i, 1], ranked[i, 2], first[i]
    for k in (0, 8, 16):
        prefetch(bound, k)
        prefetch(x, k)
        prefetch(y, k)
    prefetch(bound, 32)
    prefetch(bound, start)
    prefetch(x, start)
    prefetch(y, start)
    prefetch(indices[i], start)


@kernel
def _candidates_of(
    table: Rows[DiscRecord], starts: Starts, low: float, height: float, decides: Mask, goal: Array,
    walls: Array, grid_frame: Array, grid_first: Indices, grid_cells: Indices, reach: float,
    traits: Rows[DecisionTraitsRecord], settings: Rows[SettingsRecord],
    random: Array, near: Rows[NeighbourRecord], found: Rows[WallRecord],
    deciding: Rows[AgentRecord],
    base: int, direction: int, radius: int, half: float, drawn: bool,
    candidates: Array, regular: Array, frame: Array, result: Array,
) -> None:  # fmt: skip
    """Write the candidates of all agents (N, S, 2), m/s; arguments as in `choose_velocities`."""
    around = Surroundings(
        table, starts, low, height, decides, goal, walls, grid_frame, grid_first, grid_cells,
        reach, traits, settings, random, near, found, deciding,
    )  # fmt: skip
    agent = deciding[0]
    options = FanOptions(base, direction, radius, half, drawn)
    for b in range(table.shape[0]):
        i = describe(around, b)
        if i < 0:
            continue
        scale = frame_of(agent, options, frame)
        if settings[0].parity != 0.0:
            single_candidates(agent, options, regular, result[i])
            random[i] = agent.random
            continue
        if drawn:
            draw_candidates(agent, half, scale, candidates)
            random[i] = agent.random
        for c in range(candidates.shape[0]):
            result[i, c, 0], result[i, c, 1] = in_world(frame, candidates, c)
