"""Forces as costs: C(u) = |u - target|^2 / (2 dt), the target being the force's effect in dt.

``prepare`` of a force-based function writes its target velocity to row 0 with `set_target`;
the rest is shared.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from crowdbot.plugin import (
    BASE,
    EXCESS,
    GRADIENT,
    OPTIMUM,
    AgentRecord,
    Array,
    CompiledCost,
    Pointer,
    array_kernel,
    as_record,
    declared_kernel,
    record_type,
)
from crowdbot.plugins.crowd.cost_functions.weighted_cost import WeightedCostSpec

#: Largest force, m/s^2: a target has to stay finite when squared.
_LARGEST = 1e9


class _Target:
    """Record in ``work``: the target velocity, m/s."""

    vx: float
    vy: float


_TARGET = record_type(_Target)


@array_kernel
def set_target(fx: float, fy: float, agent: AgentRecord, work: Pointer) -> int:
    """Write the target velocity that a force per mass (m/s^2) leads to in one decision."""
    size = math.hypot(fx, fy)
    if size > _LARGEST:
        fx, fy = fx / size * _LARGEST, fy / size * _LARGEST
    time = agent.time_step / (agent.weight if agent.parity != 0.0 else 1.0)
    target = as_record(work, _TARGET)
    target.vx, target.vy = agent.vx + fx * time, agent.vy + fy * time
    return 1


def force_cost(
    spec: WeightedCostSpec, prepare: Callable[..., Any], params: Array, **walls: Any
) -> CompiledCost:
    """Return the cost of a force whose ``prepare`` ends with `set_target`.

    Args:
        spec: for the weight.
        prepare, params: of the cost.
        walls: fields of `CompiledCost` on the walls that it needs.
    """
    return CompiledCost(
        base=no_base, prepare=prepare, excess=_from_target, gradient=_to_target, optimum=_target,
        params=params, weight=spec.weight, **walls,
    )  # fmt: skip


@declared_kernel(BASE)
def no_base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    """Return 0: no cost depends on the candidate alone."""
    return 0.0


@declared_kernel(EXCESS)
def _from_target(
    ux: float, uy: float, budget: float, agent: AgentRecord, work: Pointer, params: Pointer
) -> float:
    """Return the cost by the distance from the target velocity."""
    target = as_record(work, _TARGET)
    return float(0.5 * ((ux - target.vx) ** 2 + (uy - target.vy) ** 2) / agent.time_step)


@declared_kernel(GRADIENT)
def _to_target(
    ux: float, uy: float, agent: AgentRecord, work: Pointer, params: Pointer, out: Pointer
) -> int:
    """Write the cost's gradient; at the present velocity it is minus the force per mass."""
    target = as_record(work, _TARGET)
    out[0], out[1] = (ux - target.vx) / agent.time_step, (uy - target.vy) / agent.time_step
    return 1


@declared_kernel(OPTIMUM)
def _target(agent: AgentRecord, work: Pointer, params: Pointer, out: Pointer) -> int:
    """Write the velocity of least cost."""
    target = as_record(work, _TARGET)
    out[0], out[1] = target.vx, target.vy
    return 1
