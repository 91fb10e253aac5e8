"""PLEdestrians as a compiled cost: energy of the plan to keep u for t_max, then go to the goal.

``t_max (w_a + w_b |u|^2) + 2 sqrt(w_a w_b) |g - p - t_max u|``; forbidden when a collision comes
sooner than t_min.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import (
    ASKED_RADIUS,
    ASKED_X,
    ASKED_Y,
    BASE,
    EXCESS,
    GX,
    GY,
    PREPARE,
    PX,
    PY,
    CompiledCost,
    Pointer,
    declared_kernel,
    first_collision,
    list_approaching,
)
from crowdbot.plugins.crowd.cost_functions.pledestrians import PledestriansSpec

_W_A, _W_B, _T_MIN, _T_MAX, _COST_OF_WAY = range(2, 7)  # entries of params


@declared_kernel(BASE)
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    return float(params[_T_MAX] * (params[_W_A] + params[_W_B] * (ux * ux + uy * uy)))


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
    list_approaching(
        agent, near, near_count, walls, wall_count, params, work,
        agent[ASKED_X], agent[ASKED_Y], agent[ASKED_RADIUS], params[_T_MIN],
    )  # fmt: skip
    return 1


@declared_kernel(EXCESS)
def _excess(
    ux: float, uy: float, budget: float, agent: Pointer, work: Pointer, params: Pointer
) -> float:
    t_max, t_min = params[_T_MAX], params[_T_MIN]
    left = math.hypot(agent[GX] - agent[PX] - t_max * ux, agent[GY] - agent[PY] - t_max * uy)
    cost = float(params[_COST_OF_WAY] * left)
    if cost > budget:
        return cost
    return math.inf if first_collision(ux, uy, t_min, agent, work) < t_min else cost


def build(spec: PledestriansSpec) -> CompiledCost:
    """Compiled functions with this spec's parameters."""
    surface = 1.0 if spec.range.measure == "surface" else 0.0
    way = 2.0 * math.sqrt(spec.w_a * spec.w_b)
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        params=np.array(
            [spec.range.value, surface, spec.w_a, spec.w_b, spec.t_min, spec.t_max, way]
        ),
        weight=spec.weight,
    )
