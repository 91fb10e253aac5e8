"""GoalReachingForce as a compiled cost: force (v_preferred - v) / max(tau, dt) per mass."""

from __future__ import annotations

from crowdbot.plugin import (
    COST_PARAMS,
    PREPARE,
    AgentRecord,
    CompiledCost,
    NeighbourRecord,
    Pointer,
    Rows,
    WallRecord,
    declared_kernel,
    record_values,
)
from crowdbot.plugins.crowd.cost_functions.force_build import force_cost, set_target
from crowdbot.plugins.crowd.cost_functions.goal_reaching_force import GoalReachingForceSpec


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
    time = max(agent.relaxation, agent.time_step)
    return int(
        set_target((agent.pvx - agent.vx) / time, (agent.pvy - agent.vy) / time, agent, work)
    )


def build(spec: GoalReachingForceSpec) -> CompiledCost:
    """Return the compiled functions; there are no parameters."""
    return force_cost(
        spec,
        _prepare,
        record_values(COST_PARAMS, range=spec.range.value, from_surface=0.0),
        wall_reach=(0.0, 0.0),
    )
