"""PLEdestrians as a compiled cost: energy of the plan to keep u for t_max, then go to the goal.

``t_max (w_a + w_b |u|^2) + 2 sqrt(w_a w_b) |g - p - t_max u|``; forbidden when a collision comes
sooner than t_min.
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
    first_collision,
    list_approaching,
    record_type,
    record_values,
)
from crowdbot.plugins.crowd.cost_functions.pledestrians import PledestriansSpec


class _Params(CostParams):
    """Parameters; units are those of the spec."""

    w_a: float
    w_b: float
    t_min: float
    t_max: float
    cost_of_way: float


_PARAMS = record_type(_Params)


@declared_kernel(BASE)
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    own = as_record(params, _PARAMS)
    return float(own.t_max * (own.w_a + own.w_b * (ux * ux + uy * uy)))


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
    list_approaching(
        agent, near, near_count, walls, wall_count, params, work,
        agent.asked_x, agent.asked_y, agent.asked_radius, own.t_min,
    )  # fmt: skip
    return 1


@declared_kernel(EXCESS)
def _excess(
    ux: float, uy: float, budget: float, agent: AgentRecord, work: Pointer, params: Pointer
) -> float:
    own = as_record(params, _PARAMS)
    t_max, t_min = own.t_max, own.t_min
    left = math.hypot(agent.gx - agent.px - t_max * ux, agent.gy - agent.py - t_max * uy)
    cost = float(own.cost_of_way * left)
    if cost > budget:
        return cost
    return math.inf if first_collision(ux, uy, t_min, agent, work) < t_min else cost


def build(spec: PledestriansSpec) -> CompiledCost:
    """Return the compiled functions with this spec's parameters."""
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        params=record_values(
            _PARAMS,
            spec,
            **spec.range.cost_params(),
            cost_of_way=2.0 * math.sqrt(spec.w_a * spec.w_b),
        ),
        weight=spec.weight,
        wall_reach=(0.0, spec.t_min),
    )
