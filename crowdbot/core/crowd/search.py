"""Branch and bound over one agent's candidates, and the plain loops beside it."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from crowdbot.core.crowd.calls import call_base, call_excess, call_floor
from crowdbot.core.crowd.candidates import CURRENT, direction_of, draw_candidates, radius_of
from crowdbot.core.crowd.cost import FASTEST, MAX_SPEED, PREFERRED, PVX, PVY, VX, VY, Array
from crowdbot.core.crowd.mix import Addresses, base_cost, cost_of
from crowdbot.core.kernel import kernel

Indices = NDArray[np.int64]
#: What rounding may make of a cost, as a fraction of it.
_ROUNDING = 1e-9


@kernel
def frame_of(agent: Array, base: int, direction: int, radius: int, frame: Array) -> float:
    """Where an agent's candidates are; sets the greatest speed asked for; returns the radius."""
    scale = radius_of(agent, radius)
    ex, ey = direction_of(agent, direction)
    frame[0], frame[1] = (agent[VX], agent[VY]) if base == CURRENT else (0.0, 0.0)
    frame[2], frame[3] = scale * ex, scale * ey
    agent[FASTEST] = (1.0 + 1e-9) * (scale + math.hypot(frame[0], frame[1]))
    return scale


@njit(cache=True, error_model="numpy", inline="always")
def in_world(frame: Array, candidates: Array, c: int) -> tuple[float, float]:
    """A candidate of the unit fan in the world frame (or in that of the given frame), m/s."""
    return (
        frame[0] + candidates[c, 0] * frame[2] - candidates[c, 1] * frame[3],
        frame[1] + candidates[c, 0] * frame[3] + candidates[c, 1] * frame[2],
    )


@kernel
def as_it_is(frame: Array) -> None:
    """The frame of candidates that are given in the world frame."""
    frame[0], frame[1], frame[2], frame[3] = 0.0, 0.0, 1.0, 0.0


@kernel
def lower_bounds(
    frame: Array,
    candidates: Array,
    agent: Array,
    bases: Addresses,
    params_at: Addresses,
    weights: Array,
    bound: Array,
) -> int:
    """Lower bounds of all candidates; returns the candidate of the least."""
    least, preferred, fastest = 0, agent[PREFERRED], agent[MAX_SPEED]
    cosine, sine = agent[PVX] / preferred, agent[PVY] / preferred
    # The frame as seen from the preferred velocity.
    x, y = frame[0] * cosine + frame[1] * sine, frame[1] * cosine - frame[0] * sine
    along, across = frame[2] * cosine + frame[3] * sine, frame[3] * cosine - frame[2] * sine
    for c in range(candidates.shape[0]):
        ux = x + candidates[c, 0] * along - candidates[c, 1] * across
        uy = y + candidates[c, 0] * across + candidates[c, 1] * along
        total = 0.0
        for k in range(bases.shape[0]):
            if weights[k] != 0.0:
                total += weights[k] * call_base(bases[k], ux, uy, preferred, fastest, params_at[k])
        bound[c] = total
        if total < bound[least]:
            least = c
    return least


@kernel
def search(
    frame: Array,
    candidates: Array,
    bound: Array,
    index: Indices,
    is_sorted: bool,
    start: int,
    agent: Array,
    excesses: Addresses,
    floors: Addresses,
    params_at: Addresses,
    work_at: Addresses,
    weights: Array,
    active: Indices,
    tried: Array,
) -> tuple[float, int]:
    """Least cost, and the place of its candidate among the bounds; the first one of equals.

    Args:
        bound, index: (S,) what each candidate costs at least, and its number.
        start: place of the candidate that is tried first.
        tried: (5, S) scratch.
    """
    agent_at = agent.ctypes.data
    x, y = in_world(frame, candidates, index[start])
    best = cost_within(
        x, y, bound[start], math.inf, agent_at, excesses, params_at, work_at, weights, active
    )
    best_index, best_place = index[start], start
    count = candidates.shape[0]
    if is_sorted:
        count = np.searchsorted(bound, best, side="right")
    ux, uy, least, place = tried[0], tried[1], tried[2], tried[4]
    left = 0
    for c in range(count):
        if bound[c] <= best and c != start:
            ux[left], uy[left] = in_world(frame, candidates, index[c])
            least[left], place[left] = bound[c], c
            left += 1
    raise_floors(left, tried, agent_at, floors, params_at, work_at, weights, active)
    for at in range(left):
        c = int(place[at])
        if bound[c] > best or least[at] > best + _ROUNDING * abs(best):
            continue
        cost = cost_within(
            ux[at], uy[at], bound[c], best, agent_at, excesses, params_at, work_at, weights, active
        )
        if cost < best or (cost == best and index[c] < best_index):
            best, best_index, best_place = cost, index[c], c
    return best, best_place


@kernel
def cost_within(
    ux: float,
    uy: float,
    base: float,
    best: float,
    agent_at: int,
    excesses: Addresses,
    params_at: Addresses,
    work_at: Addresses,
    weights: Array,
    active: Indices,
) -> float:
    """Cost of a candidate in the world frame, or anything above ``best`` if it exceeds it."""
    # A function that stops just above its budget must not be rounded to a tie with the best.
    cost, most = base, best + _ROUNDING * abs(best)
    for term in range(active.shape[0]):
        k = active[term]
        budget = (most - cost) / weights[k]
        cost += weights[k] * call_excess(
            excesses[k], ux, uy, budget, agent_at, work_at[k], params_at[k]
        )
        if cost > best:
            break
    return cost


@kernel
def raise_floors(
    count: int,
    tried: Array,
    agent_at: int,
    floors: Addresses,
    params_at: Addresses,
    work_at: Addresses,
    weights: Array,
    active: Indices,
) -> None:
    """Add to row 2 of ``tried`` what the functions know about the candidates in rows 0 and 1."""
    ux, uy, least, out = tried[0], tried[1], tried[2], tried[3]
    for term in range(active.shape[0]):
        k = active[term]
        if floors[k] != 0:
            call_floor(
                floors[k], count, ux.ctypes.data, uy.ctypes.data, agent_at, work_at[k],
                params_at[k], out.ctypes.data,
            )  # fmt: skip
            for c in range(count):
                least[c] += weights[k] * out[c]


@kernel
def try_in_order(
    frame: Array,
    candidates: Array,
    drawn: bool,
    half: float,
    scale: float,
    agent: Array,
    bases: Addresses,
    excesses: Addresses,
    params_at: Addresses,
    work_at: Addresses,
    weights: Array,
    active: Indices,
) -> tuple[float, int]:
    """As `search`, but everything is evaluated in the order of the candidates.

    For functions that draw random numbers; candidates are drawn one by one, too.
    """
    best, place = math.inf, 0
    for c in range(candidates.shape[0]):
        if drawn:
            draw_candidates(agent, half, scale, candidates[c : c + 1])
        ux, uy = in_world(frame, candidates, c)
        cost = base_cost(ux, uy, agent, bases, params_at, weights)
        for term in range(active.shape[0]):
            k = active[term]
            cost += weights[k] * call_excess(
                excesses[k], ux, uy, math.inf, agent.ctypes.data, work_at[k], params_at[k]
            )
        if cost < best:
            best, place = cost, c
    return best, place


@kernel
def least_forbidden(
    frame: Array,
    candidates: Array,
    agent: Array,
    bases: Addresses,
    excesses: Addresses,
    params_at: Addresses,
    work_at: Addresses,
    weights: Array,
    active: Indices,
) -> int:
    """The original's choice where every candidate is forbidden; -1 if it finds none.

    There a forbidden candidate costs the largest single-precision number times the function's
    weight, which is less than the worst cost for a weight below 1.
    """
    best, place = 1.0, -1
    for c in range(candidates.shape[0]):
        ux, uy = in_world(frame, candidates, c)
        total = 0.0
        for k in range(weights.shape[0]):
            if weights[k] == 0.0:
                continue
            has_excess = False
            for term in range(active.shape[0]):
                has_excess = has_excess or active[term] == k
            cost = cost_of(k, ux, uy, agent, bases, excesses, has_excess, params_at, work_at)
            total += weights[k] if cost == math.inf else 0.0
        if total < best:
            best, place = total, c
    return place
