"""The method ``global``: the velocity of least cost, in closed form or by a fine search."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numba import njit
from numpy.typing import NDArray

from crowdbot.core.crowd.calls import call_optimum
from crowdbot.core.crowd.candidates import EVERYWHERE
from crowdbot.core.crowd.cost import RANDOM, Array
from crowdbot.core.crowd.mix import Addresses, Mix, describe, prepare
from crowdbot.core.crowd.neighbours import INDEX, WANTED_X, WANTED_Y, Starts
from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.sampling import Sampler


class Optimum:
    """Closed form where the mix is one function that has one; otherwise `EVERYWHERE`."""

    def __init__(self, mix: Mix) -> None:
        self.mix = mix
        self.is_closed = len(mix.compiled) == 1 and not mix.vectorised and mix.optima[0] != 0
        self.search = Sampler(EVERYWHERE, mix)

    def choose(self, view: CrowdView) -> Array:
        """Chosen velocities (N, 2), m/s; zero for agents that are absent or have arrived."""
        if not self.is_closed:
            return self.search.choose(view)
        mix, scene = self.mix, self.mix.scene(view)
        chosen, unknown = np.zeros_like(view.position), np.zeros(len(view.position), np.bool_)
        _solve(
            scene.table, scene.starts, scene.low, scene.height, scene.who, scene.goal, scene.walls,
            scene.reach, scene.agent, scene.near, scene.found, mix.traits, mix.settings(view),
            mix.random, mix.prepares, int(mix.optima[0]), mix.params_at, mix.weights, mix.work_at,
            unknown, chosen,
        )  # fmt: skip
        if np.any(unknown):
            chosen[unknown] = self.search.choose(replace(view, decides=unknown))[unknown]
        return chosen


@njit(cache=True, error_model="numpy")
def _solve(
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
    prepares: Addresses,
    optimum: int,
    params_at: Addresses,
    weights: Array,
    work_at: Addresses,
    unknown: NDArray[np.bool_],
    chosen: Array,
) -> None:
    active = np.empty(1, np.int64)
    out = np.zeros(2)
    for b in range(table.shape[0]):
        i = int(table[b, INDEX])
        if i < 0 or not who[i] or (table[b, WANTED_X] == 0.0 and table[b, WANTED_Y] == 0.0):
            continue
        describe(table, b, traits, goal, settings, random, i, agent)
        prepare(
            table, starts, low, height, b, walls, reach, agent, near, found, prepares, params_at,
            weights, work_at, active,
        )  # fmt: skip
        known = call_optimum(optimum, agent.ctypes.data, work_at[0], params_at[0], out.ctypes.data)
        random[i] = agent[RANDOM]
        if known == 0:
            unknown[i] = True
        else:
            chosen[i, 0], chosen[i, 1] = out[0], out[1]
