"""GoalReachingForce as a compiled cost: force (v_preferred - v) / max(tau, dt) per mass."""

from __future__ import annotations

import numpy as np

from crowdbot.plugin import (
    PREPARE,
    PVX,
    PVY,
    RELAXATION,
    TIME_STEP,
    VX,
    VY,
    CompiledCost,
    Pointer,
    declared_kernel,
)
from crowdbot.plugins.crowd.cost_functions.force_build import (
    aim,
    from_target,
    no_base,
    target,
    to_target,
)
from crowdbot.plugins.crowd.cost_functions.goal_reaching_force import GoalReachingForceSpec


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
    time = max(agent[RELAXATION], agent[TIME_STEP])
    return int(aim((agent[PVX] - agent[VX]) / time, (agent[PVY] - agent[VY]) / time, agent, work))


def build(spec: GoalReachingForceSpec) -> CompiledCost:
    """Compiled functions; there are no parameters."""
    return CompiledCost(
        base=no_base,
        prepare=_prepare,
        excess=from_target,
        gradient=to_target,
        optimum=target,
        params=np.array([spec.range.value, 0.0]),
        weight=spec.weight,
    )
