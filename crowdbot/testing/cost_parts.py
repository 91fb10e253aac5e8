"""Base and excess of a compiled cost, separately."""

from __future__ import annotations

import math
from collections.abc import Iterator
from copy import copy
from dataclasses import replace

import numpy as np

from crowdbot.core.crowd import CrowdView
from crowdbot.core.crowd.velocity_search.agent_costs import (
    EXCESSES,
    LOWER_BOUNDS,
    PARAMS,
    WORK,
    Functions,
    base_cost,
    in_preferred_frame,
)
from crowdbot.core.crowd.velocity_search.cost import CompiledCost
from crowdbot.core.crowd.velocity_search.cost_calls import call_excess, call_lower_bound
from crowdbot.core.crowd.velocity_search.evaluate import Evaluator
from crowdbot.core.crowd.velocity_search.records import AgentRecord
from crowdbot.core.crowd.velocity_search.surroundings import describe
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts
from crowdbot.core.support.compiling.compile import array_kernel
from crowdbot.core.support.records import Rows
from crowdbot.core.types.arrays import Array

#: Shares of the true excess that are used as budgets.
_SHARES = (0.0, 0.3, 0.9, 1.1, 3.0)


def bases_of(cost: CompiledCost, view: CrowdView, velocities: Array) -> Array:
    """Return the base costs (N, S) alone; 0 for agents without a preferred velocity.

    Args:
        velocities: (N, S, 2), m/s.
    """
    costs = WeightedCosts([replace(cost, weight=1.0)], view.agents, relaxation_time=0.5)
    bases = np.zeros(velocities.shape[:2])
    for i, agent in _each_agent(costs, view):
        _fill_bases(agent, costs.functions, costs.weights, velocities[i], bases[i])
    return bases


def stops_at_budget(cost: CompiledCost, view: CrowdView, velocities: Array) -> str:
    """Return what is wrong with ``excess`` when it gets a budget; empty if nothing is."""
    costs = WeightedCosts([replace(cost, weight=1.0)], view.agents, relaxation_time=0.5)
    for i, agent in _each_prepared(costs, view, velocities):
        wrong = _budgets(costs, agent, velocities[i])
        if wrong:
            return wrong
    return ""


def above_lower_bound(cost: CompiledCost, view: CrowdView, velocities: Array) -> str:
    """Return what is wrong with ``lower_bound`` compared with the excess; empty if nothing is."""
    costs = WeightedCosts([replace(cost, weight=1.0)], view.agents, relaxation_time=0.5)
    for i, agent in _each_prepared(costs, view, velocities):
        ux, uy = np.ascontiguousarray(velocities[i].T)
        least = np.full(len(ux), np.nan)
        _fill_lower_bounds(ux, uy, agent, costs.functions, least)
        for x, y, bound in zip(ux, uy, least, strict=True):
            true = _excess(x, y, math.inf, agent, costs.functions)
            if not math.isnan(true) and not 0.0 <= bound <= true * (1.0 + 1e-9):
                return f"excess is {true:g}, its lower bound {bound:g}"
    return ""


def forgets_work(cost: CompiledCost, view: CrowdView, velocities: Array) -> bool:
    """Return True if costs do not depend on the values in ``work`` before ``prepare``."""
    costs = WeightedCosts([replace(cost, weight=1.0)], view.agents, relaxation_time=0.5)
    evaluator = Evaluator(costs)
    first = evaluator.total(view, velocities)  # gives ``work`` its size
    found = []
    for left in (0.0, 2.0):
        costs.work[:] = left
        found.append(evaluator.total(view, velocities))
    return np.array_equal(first, found[0]) and np.array_equal(found[0], found[1])


def _budgets(costs: WeightedCosts, agent: Rows[AgentRecord], velocities: Array) -> str:
    for ux, uy in velocities.tolist():
        true = _excess(ux, uy, math.inf, agent, costs.functions)
        if not math.isfinite(true):
            continue
        for budget in (share * true for share in _SHARES):
            found = _excess(ux, uy, budget, agent, costs.functions)
            within = true <= budget * (1.0 - 1e-9)
            if within and not math.isclose(found, true, rel_tol=1e-9, abs_tol=1e-12):
                return f"excess is {true:g}, with a budget of {budget:g} it is {found:g}"
            if true > budget * (1.0 + 1e-9) and not found > budget * (1.0 - 1e-9):
                return f"excess is {true:g}, with a budget of {budget:g} only {found:g}"
    return ""


def _each_prepared(
    costs: WeightedCosts, view: CrowdView, velocities: Array
) -> Iterator[tuple[int, Rows[AgentRecord]]]:
    """Yield each agent that decides as `_each_agent` does, with ``work`` prepared for it."""
    for i in range(len(view.agents)):
        only = replace(view, decides=np.arange(len(view.agents)) == i)
        Evaluator(costs).total(only, velocities)
        yield from _each_agent(costs, only)


def _each_agent(costs: WeightedCosts, view: CrowdView) -> list[tuple[int, Rows[AgentRecord]]]:
    """Return row number and one-row record of each agent that decides."""
    around = costs.surroundings(view)
    found = []
    for b in range(around.table.shape[0]):
        i = describe(around, b)
        if i >= 0:
            found.append((i, copy(around.deciding)))
    return found


@array_kernel
def _fill_bases(
    deciding: Rows[AgentRecord],
    functions: Functions,
    weights: Array,
    velocities: Array,
    out: Array,
) -> None:
    agent = deciding[0]
    for s in range(len(velocities)):
        along, across = in_preferred_frame(velocities[s, 0], velocities[s, 1], agent)
        out[s] = base_cost(along, across, agent.preferred, agent.max_speed, functions, weights)


@array_kernel
def _excess(
    ux: float, uy: float, budget: float, agent: Rows[AgentRecord], functions: Functions
) -> float:
    return float(
        call_excess(
            functions[0, EXCESSES], ux, uy, budget, agent[0], functions[0, WORK],
            functions[0, PARAMS],
        )
    )  # fmt: skip


@array_kernel
def _fill_lower_bounds(
    ux: Array, uy: Array, agent: Rows[AgentRecord], functions: Functions, out: Array
) -> None:
    call_lower_bound(
        functions[0, LOWER_BOUNDS], len(ux), ux, uy, agent[0], functions[0, WORK],
        functions[0, PARAMS], out,
    )  # fmt: skip
