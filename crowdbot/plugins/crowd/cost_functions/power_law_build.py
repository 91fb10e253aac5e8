"""PowerLaw as a compiled cost; formulas in docs/reference/crowd/power_law.md."""

from __future__ import annotations

import math

from crowdbot.plugin import (
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
    in_range,
    record_type,
    record_values,
)
from crowdbot.plugin.for_crowds import is_passed, swept_width
from crowdbot.plugins.crowd.cost_functions.force_build import force_cost, set_target
from crowdbot.plugins.crowd.cost_functions.power_law import PowerLawSpec
from crowdbot.plugins.crowd.cost_functions.wall_points_build import (
    choose,
    chosen,
    leave_out_repeated,
)

_SOONEST = 0.001  # s; collisions sooner than this exert no force


class _Params(CostParams):
    """Parameters; units are those of the spec."""

    k: float
    tau0: float


_PARAMS = record_type(_Params)


@array_kernel
def _repulsion(
    rx: float, ry: float, wx: float, wy: float, reach: float, params: Pointer
) -> tuple[float, float]:
    """Return the force per mass from a disc at (rx, ry) approached with velocity w."""
    own = as_record(params, _PARAMS)
    speed2, approach = wx * wx + wy * wy, rx * wx + ry * wy
    gap2 = rx * rx + ry * ry - reach * reach
    root2 = approach * approach - speed2 * gap2
    if gap2 <= 0.0 or root2 <= 0.0 or approach <= 0.0:
        return 0.0, 0.0
    root = math.sqrt(root2)
    t = gap2 / (approach + root)  # (approach - root) / speed2 without cancellation
    if not _SOONEST <= t <= own.tau0:
        return 0.0, 0.0
    decay = own.k * math.exp(-t / own.tau0)
    size = decay * (2.0 / t + 1.0 / own.tau0) / (speed2 * t * t)
    fx = -size * (wx + (speed2 * rx - approach * wx) / root)
    fy = -size * (wy + (speed2 * ry - approach * wy) / root)
    return fx, fy


@array_kernel
def _pushing_walls(
    agent: AgentRecord, walls: Rows[WallRecord], wall_count: int, params: Pointer, work: Pointer
) -> int:
    """Choose walls as points, without those clearly beside the way or too late; return how many."""
    vx, vy, tau0 = agent.vx, agent.vy, as_record(params, _PARAMS).tau0
    width = swept_width(vx, vy, agent.radius)
    far, count = agent.radius + (1.0 + 1e-6) * tau0 * math.sqrt(vx * vx + vy * vy) + 1e-6, 0
    for s in range(0 if agent.parity != 0.0 else wall_count):
        x, y = walls[s].nx, walls[s].ny
        if walls[s].d2 <= far * far and not is_passed(vx, vy, width, x, y, x, y):
            count = choose(count, s, work)
    return int(leave_out_repeated(walls, count, work))


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
    """Write the sum of forces; a wall is its nearest point (the original has no walls)."""
    vx, vy, fx, fy = agent.vx, agent.vy, 0.0, 0.0
    for j in range(near_count):
        if in_range(near[j].d2, near[j].reach, params):
            wx, wy = vx - near[j].nvx, vy - near[j].nvy
            ax, ay = _repulsion(near[j].rx, near[j].ry, wx, wy, near[j].reach, params)
            fx, fy = fx + ax, fy + ay
    for k in range(_pushing_walls(agent, walls, wall_count, params, work)):
        wall = walls[chosen(k, work)]
        if in_range(wall.d2, agent.radius, params):
            ax, ay = _repulsion(wall.nx, wall.ny, vx, vy, agent.radius, params)
            fx, fy = fx + ax, fy + ay
    return int(set_target(fx, fy, agent, work))


def build(spec: PowerLawSpec) -> CompiledCost:
    """Return the compiled functions with this spec's parameters."""
    return force_cost(
        spec,
        _prepare,
        record_values(_PARAMS, spec, **spec.range.cost_params()),
        # Later collisions exert no force.
        wall_reach=(0.0, spec.tau0),
        walls_on_the_way=True,
    )
