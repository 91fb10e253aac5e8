"""Karamouzas as a compiled cost; formulas in docs/reference/crowd/karamouzas.md."""

from __future__ import annotations

import math

import numpy as np
from numba import float32

from crowdbot.core.crowd.contact.geometry import single_angle
from crowdbot.core.support.compile import array_kernel
from crowdbot.plugin import (
    BASE,
    EXCESS,
    FASTEST,
    MAX_SPEED,
    PARITY,
    PREFERRED,
    PREPARE,
    PVX,
    PVY,
    VX,
    VY,
    CompiledCost,
    Pointer,
    declared_kernel,
    first_collision,
    list_obstacles,
    work_table,
)
from crowdbot.plugins.crowd.cost_functions.karamouzas import KaramouzasSpec

_ALPHA, _BETA, _GAMMA, _DELTA, _T_MAX = range(2, 7)  # entries of params
_TURN, _SLOWEST, _FASTEST = range(3, 6)  # entries of row 0 of work
_SOON, _MEDIUM, _LATE = 2.5, 6.0, 8.0  # s, fixed by the model
_SLACK = 0.05  # rad and m/s
#: Candidates lie exactly on the limits; rounding must not decide there.
_TOLERANCE = 1e-9


@declared_kernel(BASE)
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    speed = math.hypot(ux, uy)
    ahead = ux / speed if speed > 0.0 else 0.0
    deviation = math.hypot(ux - preferred, uy) / (2.0 * max_speed)
    return float(params[_ALPHA] * (1.0 - 0.5 * ahead) + params[_GAMMA] * deviation)


@array_kernel
def _allowed(t: float, preferred: float, max_speed: float, parity: bool) -> tuple[float, ...]:
    """Largest deviation in heading, slowest and fastest speed when a collision is t away."""
    sixth = math.pi / 6.0
    if t >= _LATE:
        return _SLACK, preferred - _SLACK, preferred + _SLACK
    if t < _SOON:
        turn = sixth + ((_SOON - t) / _SOON) ** 2 * math.pi / 3.0
        return turn, 0.0, max_speed + _SLACK
    spread = abs(max_speed - preferred) + _SLACK
    if t < _MEDIUM:
        turn = sixth
    elif parity:  # jumps at 6 s, and below zero
        turn = _SLACK + sixth - (_LATE - t) / 2.0
    else:
        turn = _SLACK + (sixth - _SLACK) * (_LATE - t) / (_LATE - _MEDIUM)
    return turn, preferred - spread, preferred + spread


@declared_kernel(PREPARE)
def _prepare(
    agent: Pointer,
    near: Pointer,
    near_count: int,
    walls: Pointer,
    wall_count: int,
    params: Pointer,
    work: Pointer,
) -> int:
    """Row 0: allowed deviation and speeds. Then the obstacles."""
    fastest = max(agent[FASTEST], agent[PREFERRED])
    list_obstacles(agent, near, near_count, walls, wall_count, params, work, fastest)
    t = first_collision(agent[PVX], agent[PVY], 0.0, agent, work)
    parity = agent[PARITY] != 0.0
    turn, low, high = _allowed(t, agent[PREFERRED], agent[MAX_SPEED], parity)
    slack = 0.0 if parity else _TOLERANCE
    table = work_table(work)
    table[0, _TURN] = turn + slack
    table[0, _SLOWEST], table[0, _FASTEST] = low - slack, high + slack
    return 1


@declared_kernel(EXCESS)
def _excess(
    ux: float, uy: float, budget: float, agent: Pointer, work: Pointer, params: Pointer
) -> float:
    table = work_table(work)
    speed = math.hypot(ux, uy)
    if not table[0, _SLOWEST] <= speed <= table[0, _FASTEST]:
        return math.inf
    if speed > 0.0:
        px, py = agent[PVX], agent[PVY]
        if agent[PARITY] != 0.0:  # candidates lie exactly on the limit: rounding decides
            off = single_angle(ux, uy, px, py) > float32(table[0, _TURN])
        else:
            off = math.atan2(abs(px * uy - py * ux), px * ux + py * uy) > table[0, _TURN]
        if off:
            return math.inf
    elif table[0, _TURN] < 0.0:
        return math.inf
    cost = params[_BETA] * abs(speed - math.hypot(agent[VX], agent[VY])) / agent[MAX_SPEED]
    if cost > budget or params[_DELTA] == 0.0:
        return float(cost)
    # Earlier than this is too expensive.
    until = params[_T_MAX] * (1.0 - (budget - cost) / params[_DELTA])
    t = first_collision(ux, uy, until, agent, work)
    return float(cost + params[_DELTA] * max(0.0, 1.0 - t / params[_T_MAX]))


def build(spec: KaramouzasSpec) -> CompiledCost:
    """Compiled functions with this spec's parameters."""
    surface = 1.0 if spec.range.measure == "surface" else 0.0
    weights = [spec.alpha, spec.beta, spec.gamma, spec.delta]
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        params=np.array([spec.range.value, surface, *weights, spec.t_max]),
        weight=spec.weight,
    )
