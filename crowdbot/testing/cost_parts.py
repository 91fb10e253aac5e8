"""Base and excess of a compiled cost, one by one."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numba import njit

from crowdbot.core.crowd import CrowdView
from crowdbot.core.crowd.calls import call_excess, call_floor
from crowdbot.core.crowd.cost import Array, CompiledCost
from crowdbot.core.crowd.evaluate import Evaluator
from crowdbot.core.crowd.mix import Addresses, Mix, base_cost, describe
from crowdbot.core.crowd.neighbours import INDEX, WANTED_X, WANTED_Y

#: Shares of the true excess that are tried as budgets.
_SHARES = (0.0, 0.3, 0.9, 1.1, 3.0)


def bases_of(cost: CompiledCost, view: CrowdView, velocities: Array) -> Array:
    """Costs (N, S) of the base alone; 0 for who wants to go nowhere.

    Args:
        velocities: (N, S, 2), m/s.
    """
    mix = Mix([replace(cost, weight=1.0)], view.agents, relaxation_time=0.5)
    found = np.zeros(velocities.shape[:2])
    for i, agent in _each_agent(mix, view):
        _fill_bases(agent, mix.bases, mix.params_at, mix.weights, velocities[i], found[i])
    return found


def stops_at_budget(cost: CompiledCost, view: CrowdView, velocities: Array) -> str:
    """What is wrong with the excess under a budget; empty if nothing is."""
    mix = Mix([replace(cost, weight=1.0)], view.agents, relaxation_time=0.5)
    for i in range(len(view.agents)):
        only = replace(view, decides=np.arange(len(view.agents)) == i)
        Evaluator(mix).total(only, velocities)  # prepares ``work`` for this agent
        for _, agent in _each_agent(mix, only):
            wrong = _budgets(mix, agent, velocities[i])
            if wrong:
                return wrong
    return ""


def above_floor(cost: CompiledCost, view: CrowdView, velocities: Array) -> str:
    """What is wrong with the floor of the excess; empty if nothing is."""
    mix = Mix([replace(cost, weight=1.0)], view.agents, relaxation_time=0.5)
    for i in range(len(view.agents)):
        only = replace(view, decides=np.arange(len(view.agents)) == i)
        Evaluator(mix).total(only, velocities)  # prepares ``work`` for this agent
        for _, agent in _each_agent(mix, only):
            ux, uy = np.ascontiguousarray(velocities[i].T)
            least = np.full(len(ux), np.nan)
            _fill_floors(ux, uy, agent, mix.floors, mix.params_at, mix.work_at, least)
            for x, y, floor in zip(ux, uy, least, strict=True):
                true = _excess(x, y, math.inf, agent, mix.excesses, mix.params_at, mix.work_at)
                if not math.isnan(true) and not 0.0 <= floor <= true * (1.0 + 1e-9):
                    return f"excess is {true:g}, its floor {floor:g}"
    return ""


def forgets_work(cost: CompiledCost, view: CrowdView, velocities: Array) -> bool:
    """Whether costs are the same whatever another agent left in ``work``."""
    mix = Mix([replace(cost, weight=1.0)], view.agents, relaxation_time=0.5)
    evaluator = Evaluator(mix)
    first = evaluator.total(view, velocities)  # gives ``work`` its size
    found = []
    for left in (0.0, 2.0):
        mix.work[:] = left
        found.append(evaluator.total(view, velocities))
    return np.array_equal(first, found[0]) and np.array_equal(found[0], found[1])


def _budgets(mix: Mix, agent: Array, velocities: Array) -> str:
    for ux, uy in velocities.tolist():
        true = _excess(ux, uy, math.inf, agent, mix.excesses, mix.params_at, mix.work_at)
        if not math.isfinite(true):
            continue
        for budget in (share * true for share in _SHARES):
            found = _excess(ux, uy, budget, agent, mix.excesses, mix.params_at, mix.work_at)
            within = true <= budget * (1.0 - 1e-9)
            if within and not math.isclose(found, true, rel_tol=1e-9, abs_tol=1e-12):
                return f"excess is {true:g}, with a budget of {budget:g} it is {found:g}"
            if true > budget * (1.0 + 1e-9) and not found > budget * (1.0 - 1e-9):
                return f"excess is {true:g}, with a budget of {budget:g} only {found:g}"
    return ""


def _each_agent(mix: Mix, view: CrowdView) -> list[tuple[int, Array]]:
    """Row and ``agent`` vector of everybody who decides."""
    scene, settings = mix.scene(view), mix.settings(view)
    found = []
    for b, row in enumerate(scene.table):
        i = int(row[INDEX])
        if i >= 0 and scene.who[i] and (row[WANTED_X] or row[WANTED_Y]):
            agent = scene.agent.copy()
            describe(scene.table, b, mix.traits, scene.goal, settings, mix.random, i, agent)
            found.append((i, agent))
    return found


@njit(cache=True, error_model="numpy")
def _fill_bases(
    agent: Array,
    bases: Addresses,
    params_at: Addresses,
    weights: Array,
    velocities: Array,
    out: Array,
) -> None:
    for s in range(len(velocities)):
        out[s] = base_cost(velocities[s, 0], velocities[s, 1], agent, bases, params_at, weights)


@njit(cache=True, error_model="numpy")
def _excess(
    ux: float,
    uy: float,
    budget: float,
    agent: Array,
    excesses: Addresses,
    params_at: Addresses,
    work_at: Addresses,
) -> float:
    return float(
        call_excess(excesses[0], ux, uy, budget, agent.ctypes.data, work_at[0], params_at[0])
    )


@njit(cache=True, error_model="numpy")
def _fill_floors(
    ux: Array,
    uy: Array,
    agent: Array,
    floors: Addresses,
    params_at: Addresses,
    work_at: Addresses,
    out: Array,
) -> None:
    call_floor(
        floors[0], len(ux), ux.ctypes.data, uy.ctypes.data, agent.ctypes.data, work_at[0],
        params_at[0], out.ctypes.data,
    )  # fmt: skip
