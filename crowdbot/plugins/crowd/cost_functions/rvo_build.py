"""RVO as a compiled cost: ``w / T(2u - v) + |u - v_preferred|``, T the first collision time."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import (
    BASE,
    EXCESS,
    LOWER_BOUND,
    PREPARE,
    AgentRecord,
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
    list_approaching,
    record_type,
    record_values,
    soonest_disc,
)
from crowdbot.plugin.for_crowds import NEAR_WALLS
from crowdbot.plugins.crowd.cost_functions.rvo import RvoSpec

#: Later than any finite collision time, s.
_EVER = 1e300
_ROUNDING = 1.0 + 1e-6


class _Params(CostParams):
    """Parameters; units are those of the spec."""

    w: float


_PARAMS = record_type(_Params)


@array_kernel
def _too_fast(ux: float, uy: float, max_speed: float) -> bool:
    """Return True if the speed is above the maximum in single precision."""
    x, y = np.float32(ux), np.float32(uy)
    speed = np.float32(np.sqrt(np.float32(np.float32(x * x) + np.float32(y * y))))
    return bool(speed > np.float32(max_speed))


@declared_kernel(BASE)
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    if ux * ux + uy * uy > (max_speed * _ROUNDING) ** 2:
        return math.inf
    ahead = ux - preferred
    return math.sqrt(ahead * ahead + uy * uy)


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
    # The velocity is 2u - v.
    ux, uy = 2.0 * agent.asked_x - agent.vx, 2.0 * agent.asked_y - agent.vy
    # The second term covers rounding, where the sum of two sides replaces the length.
    spread = 2.0 * agent.asked_radius + 1e-9 * (agent.fastest + abs(ux) + abs(uy))
    items = list_approaching(
        agent, near, near_count, walls, wall_count, params, work, ux, uy, spread, _EVER
    )
    return max(items, 1) if agent.parity != 0.0 else items


@declared_kernel(EXCESS)
def _excess(
    ux: float, uy: float, budget: float, agent: AgentRecord, work: Pointer, params: Pointer
) -> float:
    own = as_record(params, _PARAMS)
    if agent.parity != 0.0 and _too_fast(ux, uy, agent.max_speed):
        return math.inf
    too_soon = own.w / budget if budget > 0.0 else math.inf
    vx, vy = 2.0 * ux - agent.vx, 2.0 * uy - agent.vy
    return float(own.w / first_collision(vx, vy, too_soon, agent, work))


@declared_kernel(LOWER_BOUND)
def _lower_bound(
    count: int,
    ux: Pointer,
    uy: Pointer,
    agent: AgentRecord,
    work: Pointer,
    params: Pointer,
    out: Pointer,
) -> int:
    """Return a lower bound of the cost, without walls."""
    own = as_record(params, _PARAMS)
    soonest_disc(count, ux, uy, 2.0, agent.vx, agent.vy, work, out)
    for c in range(count):
        out[c] *= own.w
    return 1


def build(spec: RvoSpec) -> CompiledCost:
    """Return the compiled functions with this spec's parameters."""
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        lower_bound=_lower_bound,
        params=record_values(_PARAMS, spec, **spec.range.cost_params()),
        weight=spec.weight,
        wall_reach=(min(NEAR_WALLS, spec.range.value), 0.0),
        looks_farther=True,
    )
