"""VanToll as a compiled cost: blocked distance, deviation from the goal, inertia.

Base: angle to the preferred velocity + ||u| - s| / s. Excess: d - min(d, T |u|) + angle to the
present velocity, with d the max_distance and T the time to the first collision.
"""

from __future__ import annotations

import math

from crowdbot.plugin import (
    BASE,
    EXCESS,
    PREPARE,
    AgentRecord,
    CompiledCost,
    CostParams,
    NeighbourRecord,
    Pointer,
    Rows,
    WallRecord,
    as_record,
    declared_kernel,
    first_contact,
    list_obstacles,
    record_type,
    record_values,
)
from crowdbot.plugin.for_crowds import NEAR_WALLS
from crowdbot.plugins.crowd.cost_functions.van_toll import VanTollSpec

_SURELY = 1e-9  # share of a way by which it is shorter in spite of rounding


class _Params(CostParams):
    """Parameters; units are those of the spec."""

    max_distance: float


_PARAMS = record_type(_Params)


@declared_kernel(BASE)
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    speed = math.hypot(ux, uy)
    if preferred <= 0.0:
        return 0.0 if speed == 0.0 else math.inf
    turn = math.atan2(abs(uy), ux) if speed > 0.0 else 0.0
    return turn + abs(speed - preferred) / preferred


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
    fastest = agent.fastest
    list_obstacles(agent, near, near_count, walls, wall_count, params, work, fastest)
    return 1


@declared_kernel(EXCESS)
def _excess(
    ux: float, uy: float, budget: float, agent: AgentRecord, work: Pointer, params: Pointer
) -> float:
    own = as_record(params, _PARAMS)
    vx, vy, way = agent.vx, agent.vy, own.max_distance
    speed = math.hypot(ux, uy)
    if speed == 0.0:
        return float(way)
    turn = 0.0
    if vx != 0.0 or vy != 0.0:
        turn = math.atan2(abs(vx * uy - vy * ux), vx * ux + vy * uy)
    if turn > budget:
        return turn
    # Where the way is free for less than this, the cost exceeds the budget by more than rounding.
    until = ((1.0 - _SURELY) * way + turn - budget) / speed
    return float(way - min(way, first_contact(ux, uy, agent, work, until) * speed) + turn)


def build(spec: VanTollSpec) -> CompiledCost:
    """Return the compiled functions with this spec's parameters."""
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        params=record_values(_PARAMS, spec, **spec.range.cost_params()),
        weight=spec.weight,
        wall_reach=(min(NEAR_WALLS, spec.max_distance * (1.0 + 1e-6)), 0.0),
        looks_farther=spec.max_distance > NEAR_WALLS,
    )
