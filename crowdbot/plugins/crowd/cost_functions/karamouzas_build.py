"""Karamouzas as a compiled cost; formulas in docs/reference/crowd/karamouzas.md."""

from __future__ import annotations

import math

from numba import float32

from crowdbot.plugin import (
    BASE,
    EXCESS,
    PREPARE,
    AgentRecord,
    CollisionHeader,
    CompiledCost,
    CostParams,
    NeighbourRecord,
    Pointer,
    Rows,
    WallRecord,
    array_kernel,
    as_record,
    declared_kernel,
    first_collision,
    list_obstacles,
    record_type,
    record_values,
)
from crowdbot.plugin.for_crowds import NEAR_WALLS, single_angle
from crowdbot.plugins.crowd.cost_functions.karamouzas import KaramouzasSpec

_SOON, _MEDIUM, _LATE = 2.5, 6.0, 8.0  # s, fixed by the model
_SLACK = 0.05  # rad and m/s
#: Candidates lie exactly on the limits; rounding must not decide.
_TOLERANCE = 1e-9


class _Params(CostParams):
    """Parameters; units are those of the spec."""

    alpha: float
    beta: float
    gamma: float
    delta: float
    t_max: float


class _Header(CollisionHeader):
    """Row 0 of ``work``: also the largest turn (rad), slowest and fastest speed (m/s)."""

    turn: float
    slowest: float
    fastest: float


_PARAMS, _HEADER = record_type(_Params), record_type(_Header)


@declared_kernel(BASE)
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    own = as_record(params, _PARAMS)
    speed = math.hypot(ux, uy)
    ahead = ux / speed if speed > 0.0 else 0.0
    deviation = math.hypot(ux - preferred, uy) / (2.0 * max_speed)
    return float(own.alpha * (1.0 - 0.5 * ahead) + own.gamma * deviation)


@array_kernel
def _allowed(t: float, preferred: float, max_speed: float, parity: bool) -> tuple[float, ...]:
    """Return the largest change of heading, and slowest and fastest speed, for a collision in t."""
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
    agent: AgentRecord,
    near: Rows[NeighbourRecord],
    near_count: int,
    walls: Rows[WallRecord],
    wall_count: int,
    params: Pointer,
    work: Pointer,
) -> int:
    """Write row 0: allowed deviation and speeds; then the obstacles."""
    fastest = max(agent.fastest, agent.preferred)
    list_obstacles(agent, near, near_count, walls, wall_count, params, work, fastest)
    t = first_collision(agent.pvx, agent.pvy, 0.0, agent, work)
    parity = agent.parity != 0.0
    turn, low, high = _allowed(t, agent.preferred, agent.max_speed, parity)
    slack = 0.0 if parity else _TOLERANCE
    header = as_record(work, _HEADER)
    header.turn, header.slowest, header.fastest = turn + slack, low - slack, high + slack
    return 1


@declared_kernel(EXCESS)
def _excess(
    ux: float, uy: float, budget: float, agent: AgentRecord, work: Pointer, params: Pointer
) -> float:
    own = as_record(params, _PARAMS)
    header = as_record(work, _HEADER)
    speed = math.hypot(ux, uy)
    if not header.slowest <= speed <= header.fastest:
        return math.inf
    if speed > 0.0:
        px, py = agent.pvx, agent.pvy
        if agent.parity != 0.0:  # candidates lie exactly on the limit: rounding decides
            off = bool(single_angle(ux, uy, px, py) > float32(header.turn))
        else:
            off = math.atan2(abs(px * uy - py * ux), px * ux + py * uy) > header.turn
        if off:
            return math.inf
    elif header.turn < 0.0:
        return math.inf
    cost = own.beta * abs(speed - math.hypot(agent.vx, agent.vy)) / agent.max_speed
    if cost > budget or own.delta == 0.0:
        return float(cost)
    # Earlier collisions are too expensive.
    until = own.t_max * (1.0 - (budget - cost) / own.delta)
    t = first_collision(ux, uy, until, agent, work)
    return float(cost + own.delta * max(0.0, 1.0 - t / own.t_max))


def build(spec: KaramouzasSpec) -> CompiledCost:
    """Return the compiled functions with this spec's parameters."""
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        params=record_values(_PARAMS, spec, **spec.range.cost_params()),
        weight=spec.weight,
        wall_reach=(NEAR_WALLS, 0.0),
        looks_farther=True,
    )
