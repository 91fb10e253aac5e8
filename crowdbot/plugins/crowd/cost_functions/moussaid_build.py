"""Moussaid as a compiled cost.

With the free distance c in direction e (at most d_max) and the safe speed S = min(s, c / tau): cost
K (1 + ((S - |u|) / S)^2), K = d_max^2 + c^2 - 2 d_max c cos(e, v_preferred) + 1. The base is the
least K of any c.
"""

from __future__ import annotations

import math

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
    first_contact,
    list_approaching,
    record_type,
    record_values,
)
from crowdbot.plugin.for_crowds import NEAR_WALLS
from crowdbot.plugins.crowd.cost_functions.moussaid import MoussaidSpec

_SURELY = 1e-6  # share by which a way is shorter in spite of rounding
_TINY = 1e-300  # (m/s)^2, against a division by zero


class _Params(CostParams):
    """Parameters; units are those of the spec."""

    d_max: float


_PARAMS = record_type(_Params)


@array_kernel
def _least_course(ahead: float, d_max: float) -> float:
    ahead = max(0.0, ahead)
    return 1.0 + d_max * d_max * (1.0 - ahead * ahead)


@array_kernel
def _too_short(ahead: float, budget: float, d_max: float) -> float:
    """Return the free way (m) below which the excess is above the budget, or less than zero.

    The excess is at least (d_max * ahead - free)^2, for any speed.
    """
    if not ahead > 0.0 or not 0.0 <= budget < math.inf:
        return -1.0
    return float(d_max * (ahead - _SURELY) - (1.0 + _SURELY) * math.sqrt(budget))


@declared_kernel(BASE)
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    own = as_record(params, _PARAMS)
    speed = math.hypot(ux, uy)
    return float(_least_course(ux / speed if speed > 0.0 else 0.0, own.d_max))


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
    own = as_record(params, _PARAMS)
    # All are computed at the preferred speed; beyond d_max there is no cost.
    speed = agent.preferred
    horizon = (1.0 + 1e-9) * own.d_max / speed if speed > 0.0 else math.inf
    list_approaching(
        agent, near, near_count, walls, wall_count, params, work, 0.0, 0.0, speed, horizon
    )
    return 1


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
    """Return a lower bound of the excess at any free way.

    Either the way is free for the preferred speed, which u then falls short of, or it is so short
    that the course costs more.
    """
    own = as_record(params, _PARAMS)
    preferred, d_max = agent.preferred, own.d_max
    for c in range(count):
        speed = math.sqrt(ux[c] * ux[c] + uy[c] * uy[c])
        along = ux[c] * agent.pvx + uy[c] * agent.pvy
        ahead = along / max(speed * preferred, _TINY)
        slower = (preferred - speed) / preferred
        missing = max(0.0, d_max * ahead - preferred * agent.relaxation)
        least = _least_course(ahead, d_max) * slower * slower
        out[c] = (1.0 - _SURELY) * min(least, missing * missing)
    return 1


@declared_kernel(EXCESS)
def _excess(
    ux: float, uy: float, budget: float, agent: AgentRecord, work: Pointer, params: Pointer
) -> float:
    own = as_record(params, _PARAMS)
    speed, preferred, d_max = math.hypot(ux, uy), agent.preferred, own.d_max
    ahead, scale = 0.0, 0.0
    if speed > 0.0:
        scale = preferred / speed
        if preferred > 0.0:
            ahead = (ux * agent.pvx + uy * agent.pvy) / (speed * preferred)
    until = _too_short(ahead, budget, d_max) / preferred if preferred > 0.0 else 0.0
    t = first_contact(ux * scale, uy * scale, agent, work, until)
    free = min(d_max, t * preferred) if preferred > 0.0 else d_max
    course = d_max * d_max + free * free - 2.0 * d_max * free * ahead + 1.0
    least = _least_course(ahead, d_max)
    safe = preferred if free >= preferred * agent.relaxation else free / agent.relaxation
    if safe <= 0.0:
        return math.inf if speed > 0.0 else max(0.0, course - least)
    slower = (safe - speed) / safe
    return float(max(0.0, course * (1.0 + slower * slower) - least))


def build(spec: MoussaidSpec) -> CompiledCost:
    """Return the compiled functions with this spec's parameters."""
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        lower_bound=_lower_bound,
        params=record_values(_PARAMS, spec, **spec.range.cost_params()),
        weight=spec.weight,
        wall_reach=(min(NEAR_WALLS, spec.d_max * (1.0 + 1e-6)), 0.0),
        looks_farther=spec.d_max > NEAR_WALLS,
    )
