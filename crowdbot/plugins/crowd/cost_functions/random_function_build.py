"""RandomFunction as a compiled cost: uniform between 0 and 2, from the agent's own generator.

The original draws between -1 and 1; adding 1 to every candidate does not change the choice.
"""

from __future__ import annotations

from crowdbot.plugin import (
    BASE,
    COST_PARAMS,
    EXCESS,
    GRADIENT,
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
from crowdbot.plugin.for_crowds import draw
from crowdbot.plugins.crowd.cost_functions.random_function import RandomFunctionSpec


@declared_kernel(BASE)
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    return 0.0


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
    return 1


@declared_kernel(EXCESS)
def _excess(
    ux: float, uy: float, budget: float, agent: AgentRecord, work: Pointer, params: Pointer
) -> float:
    return float(draw(agent, -1.0, 1.0) + 1.0)


@declared_kernel(GRADIENT)
def _gradient(
    ux: float, uy: float, agent: AgentRecord, work: Pointer, params: Pointer, out: Pointer
) -> int:
    out[1] = draw(agent, -1.0, 1.0)  # y first, as in the original
    out[0] = draw(agent, -1.0, 1.0)
    return 1


def build(spec: RandomFunctionSpec) -> CompiledCost:
    """Return the compiled functions; there are no parameters."""
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        gradient=_gradient,
        params=record_values(COST_PARAMS, range=spec.range.value, from_surface=0.0),
        weight=spec.weight,
        wall_reach=(0.0, 0.0),
        ordered=True,
    )
