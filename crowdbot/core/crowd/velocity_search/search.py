"""Branch and bound over one agent's candidates, and plain loops."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.crowd.velocity_search.agent_costs import (
    LOWER_BOUNDS,
    PARAMS,
    WORK,
    AgentCosts,
    Functions,
    base_cost,
    cost_of,
    excess_of,
    in_preferred_frame,
)
from crowdbot.core.crowd.velocity_search.candidates import draw_candidates
from crowdbot.core.crowd.velocity_search.cost_calls import call_lower_bound
from crowdbot.core.crowd.velocity_search.records import AgentRecord
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.types.arrays import Array, Indices

#: Largest relative rounding error of a cost.
_ROUNDING = 1e-9
#: Number of candidates that processors compute at once.
_STEP = 8


@inline_kernel
def turned(frame: Array, x: float, y: float) -> tuple[float, float]:
    """Return a velocity of the unit fan, scaled and rotated to the world (or given) frame, m/s."""
    return frame[0] + x * frame[2] - y * frame[3], frame[1] + x * frame[3] + y * frame[2]


@inline_kernel
def in_world(frame: Array, candidates: Array, c: int) -> tuple[float, float]:
    """Return candidate number c of the unit fan in the world (or given) frame, m/s."""
    return turned(frame, candidates[c, 0], candidates[c, 1])


@kernel
def arrange(candidates: Array, index: Indices, x: Array, y: Array) -> None:
    """Write candidates (S, 2) to ``x`` and ``y`` (S,), in the order of their indices."""
    for c in range(index.shape[0]):
        x[c], y[c] = candidates[index[c], 0], candidates[index[c], 1]


@kernel
def set_bounds(
    frame: Array,
    candidates: Array,
    agent: AgentRecord,
    functions: Functions,
    weights: Array,
    bound: Array,
) -> int:
    """Write base costs of all candidates to ``bound`` (S,).

    Return the candidate with the lowest.
    """
    least, preferred, fastest = 0, agent.preferred, agent.max_speed
    cosine, sine = agent.pvx / preferred, agent.pvy / preferred
    # The frame relative to the preferred velocity.
    x, y = frame[0] * cosine + frame[1] * sine, frame[1] * cosine - frame[0] * sine
    along, across = frame[2] * cosine + frame[3] * sine, frame[3] * cosine - frame[2] * sine
    for c in range(candidates.shape[0]):
        ux = x + candidates[c, 0] * along - candidates[c, 1] * across
        uy = y + candidates[c, 0] * across + candidates[c, 1] * along
        bound[c] = base_cost(ux, uy, preferred, fastest, functions, weights)
        if math.isnan(bound[c]):
            agent.broken = 1.0
        if bound[c] < bound[least]:
            least = c
    return least


@inline_kernel
def search(
    frame: Array,
    x: Array,
    y: Array,
    bound: Array,
    index: Indices,
    is_sorted: bool,
    start: int,
    costs: AgentCosts,
    tried: Array,
) -> tuple[float, int]:
    """Return the lowest cost, and the position of its candidate; of equal ones the first.

    Args:
        frame: (4,) see `turned`.
        x, y, bound, index: (S,) candidates of the unit fan, their lower bounds, and indices.
        is_sorted: True if bounds increase.
        start: position of the candidate to try first.
        tried: (5, S) scratch.
    """
    ux, uy = turned(frame, x[start], y[start])
    best = cost_within(ux, uy, bound[start], math.inf, costs)
    best_index, best_place = index[start], start
    left = _possible(frame, x, y, bound, is_sorted, best, tried)
    left = _rule_out(left, best, tried, costs)
    least, place = tried[2], tried[4]
    for at in range(left):
        c = int(place[at])
        if bound[c] > best or least[at] > best + _ROUNDING * abs(best) or c == start:
            continue
        cost = cost_within(tried[0, at], tried[1, at], bound[c], best, costs)
        if cost < best or (cost == best and index[c] < best_index):
            best, best_index, best_place = cost, index[c], c
    return best, best_place


@kernel
def _whole_steps(count: int, most: int) -> int:
    """Return the number of candidates, rounded up to whole SIMD vectors.

    The added ones have arbitrary values.
    """
    return min((count + _STEP - 1) // _STEP * _STEP, most)


@inline_kernel
def _possible(
    frame: Array, x: Array, y: Array, bound: Array, is_sorted: bool, best: float, tried: Array
) -> int:
    """Write candidates that may be as good as ``best`` to ``tried``; return how many.

    Rows 0, 1, 2 and 4: velocity in the world frame, bound, position.
    """
    ux, uy, least, place = tried[0], tried[1], tried[2], tried[4]
    if is_sorted:
        left = int(np.searchsorted(bound, best, side="right"))
        whole = _whole_steps(left, bound.shape[0])
        bx, by, fx, fy = frame[0], frame[1], frame[2], frame[3]
        for c in range(whole):  # one row at a time, so that it vectorises
            ux[c] = bx + x[c] * fx - y[c] * fy
        for c in range(whole):
            uy[c] = by + x[c] * fy + y[c] * fx
        for c in range(whole):
            least[c] = bound[c]
        for c in range(whole):
            place[c] = c
        return left
    left = 0
    for c in range(x.shape[0]):
        if bound[c] <= best:
            ux[left], uy[left] = turned(frame, x[c], y[c])
            least[left], place[left] = bound[c], c
            left += 1
    return left


@inline_kernel
def cost_within(ux: float, uy: float, base: float, best: float, costs: AgentCosts) -> float:
    """Return the cost of a world candidate, or anything above ``best`` if it exceeds it."""
    # A function that stops just above its budget must not be rounded to a tie with the best.
    cost, most = base, best + _ROUNDING * abs(best)
    for term in range(costs.active.shape[0]):
        k = costs.active[term]
        weight = costs.weights[k]
        budget = (most - cost) / weight
        excess = excess_of(costs, k, ux, uy, budget)
        if math.isnan(excess) and not math.isnan(budget):
            costs.agent.broken = 1.0
        cost += weight * excess
        if cost > best:
            break
    return cost


@inline_kernel
def _rule_out(count: int, best: float, tried: Array, costs: AgentCosts) -> int:
    """Leave out candidates whose bound is above ``best``; return how many stay.

    The function with the largest range comes first: it has the most neighbours and excludes most.
    """
    ux, uy, least, out, place = tried[0], tried[1], tried[2], tried[3], tried[4]
    functions, most = costs.functions, best + _ROUNDING * abs(best)
    for term in range(costs.active.shape[0] - 1, -1, -1):
        k = costs.active[term]
        if functions[k, LOWER_BOUNDS] == 0:
            continue
        call_lower_bound(
            functions[k, LOWER_BOUNDS], _whole_steps(count, ux.shape[0]), ux, uy,
            costs.agent, functions[k, WORK], functions[k, PARAMS], out,
        )  # fmt: skip
        stay = 0
        for c in range(count):  # one that goes is overwritten by the next
            bound = least[c] + costs.weights[k] * out[c]
            ux[stay], uy[stay], least[stay], place[stay] = ux[c], uy[c], bound, place[c]
            stay += int(not bound > most)
        count = stay
    return count


@kernel
def try_in_order(
    frame: Array, candidates: Array, drawn: bool, half: float, scale: float, costs: AgentCosts
) -> tuple[float, int]:
    """Return the lowest cost and its candidate, as `search`, by trying all in order.

    For functions that draw random numbers; candidates are drawn one by one too.
    """
    best, place, agent = math.inf, 0, costs.agent
    for c in range(candidates.shape[0]):
        if drawn:
            draw_candidates(agent, half, scale, candidates[c : c + 1])
        ux, uy = in_world(frame, candidates, c)
        along, across = in_preferred_frame(ux, uy, agent)
        cost = base_cost(
            along, across, agent.preferred, agent.max_speed, costs.functions, costs.weights
        )
        for term in range(costs.active.shape[0]):
            k = costs.active[term]
            cost += costs.weights[k] * excess_of(costs, k, ux, uy, math.inf)
        if math.isnan(cost):
            agent.broken = 1.0
        if cost < best:
            best, place = cost, c
    return best, place


@kernel
def least_forbidden(frame: Array, candidates: Array, costs: AgentCosts) -> int:
    """Return the original engine's choice if every candidate is forbidden; -1 if it finds none.

    There a forbidden candidate costs the largest single-precision number times the function's
    weight, which is less than the worst cost for a weight below 1.
    """
    best, place = 1.0, -1
    for c in range(candidates.shape[0]):
        ux, uy = in_world(frame, candidates, c)
        total = 0.0
        for k in range(costs.weights.shape[0]):
            if costs.weights[k] != 0.0 and cost_of(costs, k, ux, uy) == math.inf:
                total += costs.weights[k]
        if total < best:
            best, place = total, c
    return place
