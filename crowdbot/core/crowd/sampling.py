"""Sampling in velocity space: each agent takes the candidate of least total cost.

Candidates are fixed in some frame. Where that is the frame of the preferred velocity, their base
costs are tabulated and sorted once per agent, so that the search stops at the first candidate
whose lower bound exceeds the best cost so far: exact branch and bound. In other frames the bounds
are computed at each decision, and candidates above the best cost are passed over.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.candidates import (
    ALONG_PREFERRED,
    ZERO,
    Sampling,
    draw_candidates,
    radius_of,
)
from crowdbot.core.crowd.cost import (
    AGENT_SIZE,
    MAX_ACCELERATION,
    MAX_SPEED,
    PARITY,
    PREFERRED,
    PVX,
    RANDOM,
    TIME_STEP,
    Array,
)
from crowdbot.core.crowd.evaluate import Evaluator
from crowdbot.core.crowd.mix import (
    S_DT,
    S_PARITY,
    T_MAX_ACCELERATION,
    T_MAX_SPEED,
    T_PREFERRED,
    Addresses,
    Mix,
    base_cost,
    describe,
    prepare,
)
from crowdbot.core.crowd.neighbours import INDEX, WANTED_X, WANTED_Y, Starts
from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.search import (
    as_it_is,
    frame_of,
    in_world,
    least_forbidden,
    lower_bounds,
    search,
    try_in_order,
)
from crowdbot.core.crowd.single import polar, single_candidates
from crowdbot.core.kernel import kernel

Indices = NDArray[np.int64]


class Sampler:
    """A mix of costs over candidates, ready to decide for one set of agents."""

    def __init__(self, sampling: Sampling, mix: Mix) -> None:
        self.sampling, self.mix = sampling, mix
        s = sampling
        self._candidates = np.zeros((s.random, 2)) if s.random else s.fan()
        self._polar = np.zeros((1, 2)) if s.random else polar(s)
        # Whether bounds are the same at each decision.
        self._tabulated = not s.random and s.base == ZERO and s.direction == ALONG_PREFERRED
        self._table_dt = math.nan
        # Bounds and their candidates: a row for each agent, or one that each fills anew.
        self._bound = np.zeros((1, len(self._candidates)))
        self._index = np.arange(len(self._candidates))[np.newaxis]
        # Where each search begins: the previous choice is a good bound, and changes no choice.
        self._first = np.zeros(len(mix.agents), np.int64)
        # Scratch: the frame (base, then direction times radius), candidates in the world frame,
        # functions whose excess may differ from zero, what `search` knows about candidates.
        self._frame = np.zeros(4)
        self._world = np.zeros_like(self._candidates)
        self._active = np.zeros(len(mix.compiled), np.int64)
        self._tried = np.zeros((5, len(self._candidates)))

    def choose(self, view: CrowdView) -> Array:
        """Chosen velocities (N, 2), m/s; zero for agents that are absent or have arrived."""
        s, mix = self.sampling, self.mix
        scene, settings = mix.scene(view), mix.settings(view)
        if mix.vectorised:
            return self._choose_slowly(view)
        self._tabulate(settings)
        chosen = np.zeros_like(view.position)
        _choose(
            scene.table, scene.starts, scene.low, scene.height, scene.who, scene.goal, scene.walls,
            scene.reach, scene.agent, scene.near, scene.found, mix.traits, settings, mix.random,
            mix.bases, mix.prepares, mix.excesses, mix.floors, mix.params_at, mix.weights,
            mix.work_at,
            s.base, s.direction, s.radius, 0.5 * s.opening, s.random > 0, mix.ordered,
            self._candidates, self._polar, self._tabulated, self._bound, self._index,
            self._first, self._frame, self._world, self._active, self._tried, chosen,
        )  # fmt: skip
        return chosen

    def candidates(self, view: CrowdView) -> Array:
        """The regular candidates (N, S, 2) of everybody, or new random ones, world frame, m/s."""
        s, mix = self.sampling, self.mix
        scene, settings = mix.scene(view), mix.settings(view)
        found = np.zeros((len(view.position), *self._candidates.shape))
        _candidates_of(
            scene.table, scene.who, scene.goal, scene.agent, mix.traits, settings, mix.random,
            s.base, s.direction, s.radius, 0.5 * s.opening, s.random > 0, self._candidates,
            self._polar, self._frame, found,
        )  # fmt: skip
        return found

    def _choose_slowly(self, view: CrowdView) -> Array:
        """Every candidate by every function, for mixes with vectorised ones."""
        found = self.candidates(view)
        total = Evaluator(self.mix).total(view, found)
        best = np.argmin(total, axis=1)
        rows = np.arange(len(found))
        chosen = found[rows, best]
        chosen[~np.isfinite(total[rows, best])] = 0.0
        return np.asarray(chosen)

    def _tabulate(self, settings: Array) -> None:
        """Sum the base costs of a mix and sort each agent's candidates by them."""
        dt = settings[S_DT]
        if not self._tabulated or self._table_dt == dt:
            return
        mix = self.mix
        total = np.zeros((len(mix.agents), len(self._candidates)))
        _tabulate(
            self._candidates, mix.traits, self.sampling.radius, dt, mix.bases, mix.params_at,
            mix.weights, np.zeros(AGENT_SIZE), total,
        )  # fmt: skip
        self._index = np.argsort(total, axis=1, kind="stable")
        self._bound = np.take_along_axis(total, self._index, axis=1)
        self._table_dt = dt


@kernel
def _tabulate(
    candidates: Array,
    traits: Array,
    radius: int,
    dt: float,
    bases: Addresses,
    params_at: Addresses,
    weights: Array,
    agent: Array,
    total: Array,
) -> None:
    for i in range(total.shape[0]):
        agent[PREFERRED], agent[MAX_SPEED] = traits[i, T_PREFERRED], traits[i, T_MAX_SPEED]
        agent[PVX], agent[TIME_STEP] = agent[PREFERRED], dt
        agent[MAX_ACCELERATION] = traits[i, T_MAX_ACCELERATION]
        if agent[PREFERRED] <= 0.0:
            continue  # never asked for
        scale = radius_of(agent, radius)
        for c in range(candidates.shape[0]):
            ux, uy = scale * candidates[c, 0], scale * candidates[c, 1]
            total[i, c] = base_cost(ux, uy, agent, bases, params_at, weights)


@kernel
def _choose(
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
    floors: Addresses,
    params_at: Addresses,
    weights: Array,
    work_at: Addresses,
    base: int,
    direction: int,
    radius: int,
    half: float,
    drawn: bool,
    ordered: bool,
    candidates: Array,
    regular: Array,
    tabulated: bool,
    bounds: Array,
    indices: Indices,
    first: Indices,
    frame: Array,
    world: Array,
    active: Indices,
    tried: Array,
    chosen: Array,
) -> None:
    """Everybody's choice; see `Sampler`."""
    fan = candidates
    for b in range(table.shape[0]):
        i = int(table[b, INDEX])
        if i < 0 or not who[i] or (table[b, WANTED_X] == 0.0 and table[b, WANTED_Y] == 0.0):
            continue
        describe(table, b, traits, goal, settings, random, i, agent)
        scale = frame_of(agent, base, direction, radius, frame)
        terms = prepare(
            table, starts, low, height, b, walls, reach, agent, near, found, prepares, params_at,
            weights, work_at, active,
        )  # fmt: skip
        to_draw = drawn
        if settings[S_PARITY] != 0.0 and not (ordered and drawn):
            single_candidates(agent, regular, drawn, half, radius, base, direction, world)
            as_it_is(frame)
            fan, to_draw = world, False
        if ordered:
            best, place = try_in_order(
                frame, fan, to_draw, half, scale, agent, bases, excesses, params_at, work_at,
                weights, active[:terms],
            )  # fmt: skip
        elif tabulated:
            best, place = search(
                frame, fan, bounds[i], indices[i], True, first[i], agent, excesses, floors,
                params_at, work_at, weights, active[:terms], tried,
            )  # fmt: skip
        else:
            if to_draw:
                draw_candidates(agent, half, scale, fan)
            start = lower_bounds(frame, fan, agent, bases, params_at, weights, bounds[0])
            best, place = search(
                frame, fan, bounds[0], indices[0], False, start, agent, excesses, floors,
                params_at, work_at, weights, active[:terms], tried,
            )  # fmt: skip
        random[i] = agent[RANDOM]
        if best == math.inf:
            if agent[PARITY] == 0.0:
                continue
            place = least_forbidden(
                frame, fan, agent, bases, excesses, params_at, work_at, weights,
                active[:terms],
            )  # fmt: skip
            if place < 0:
                continue
            c = place
        else:
            c = indices[i, place] if tabulated and not ordered else place
            first[i] = place
        chosen[i, 0], chosen[i, 1] = in_world(frame, fan, c)


@kernel
def _candidates_of(
    table: Array,
    who: NDArray[np.bool_],
    goal: Array,
    agent: Array,
    traits: Array,
    settings: Array,
    random: Array,
    base: int,
    direction: int,
    radius: int,
    half: float,
    drawn: bool,
    candidates: Array,
    regular: Array,
    frame: Array,
    result: Array,
) -> None:
    for b in range(table.shape[0]):
        i = int(table[b, INDEX])
        if i < 0 or not who[i] or (table[b, WANTED_X] == 0.0 and table[b, WANTED_Y] == 0.0):
            continue
        describe(table, b, traits, goal, settings, random, i, agent)
        scale = frame_of(agent, base, direction, radius, frame)
        if settings[S_PARITY] != 0.0:
            single_candidates(agent, regular, drawn, half, radius, base, direction, result[i])
            random[i] = agent[RANDOM]
            continue
        if drawn:
            draw_candidates(agent, half, scale, candidates)
            random[i] = agent[RANDOM]
        for c in range(candidates.shape[0]):
            result[i, c, 0], result[i, c, 1] = in_world(frame, candidates, c)
