"""SocialForcesAvoidance as a compiled cost.

Formulas in docs/reference/crowd/social_forces_avoidance.md.
"""

from __future__ import annotations

import math

from crowdbot.plugin import (
    PREPARE,
    AgentRecord,
    CompiledCost,
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
from crowdbot.plugin.for_crowds import MORE_WALLS, SAME_POINT, opposite_taken_for_parallel
from crowdbot.plugins.crowd.cost_functions.force_build import force_cost, set_target
from crowdbot.plugins.crowd.cost_functions.social_forces_avoidance import SocialForcesAvoidanceSpec
from crowdbot.plugins.crowd.cost_functions.wall_forces_build import (
    CLOSEST,
    WallParams,
    add_points,
    add_walls,
    looked_up_to,
    wall_force,
)

_SEEN = math.cos(math.radians(100.0))  # half the field of view


class _Params(WallParams):
    """Parameters; units are those of the spec."""

    v0: float
    sigma: float
    dt: float
    relative: float


_PARAMS = record_type(_Params)


@array_kernel
def _people(
    agent: AgentRecord, near: Rows[NeighbourRecord], j: int, params: Pointer
) -> tuple[float, float]:
    """Return the force per mass from neighbour j, by the ellipse of its stride."""
    own = as_record(params, _PARAMS)
    parity = agent.parity != 0.0
    xx, xy = -near[j].rx, -near[j].ry
    distance = math.sqrt(near[j].d2)
    stride, preferred = math.hypot(near[j].nvx, near[j].nvy), math.hypot(near[j].npx, near[j].npy)
    stride *= own.dt
    yx = near[j].npx / preferred * stride if preferred > 0.0 else 0.0
    yy = near[j].npy / preferred * stride if preferred > 0.0 else 0.0
    if own.relative != 0.0:
        yx = (near[j].nvx - agent.vx) * own.dt
        yy = (near[j].nvy - agent.vy) * own.dt
        stride = math.hypot(yx, yy)
    moved = math.hypot(xx - yx, xy - yy)
    if distance <= near[j].reach or moved == 0.0:
        return 0.0, 0.0
    around = distance + moved
    counted = stride if parity or preferred > 0.0 or own.relative != 0.0 else 0.0
    minor2 = 0.25 * (around * around - counted * counted)
    if minor2 <= 0.0 or math.sqrt(minor2) < CLOSEST:
        return 0.0, 0.0
    minor = math.sqrt(minor2)
    slope = (distance - (xx * yx + xy * yy) / distance) / moved
    growth = around * (1.0 + slope) / (4.0 * minor)
    size = own.v0 / own.sigma * math.exp(-minor / own.sigma) * growth
    if not parity:
        size /= distance
    speed = math.hypot(agent.vx, agent.vy)
    behind = speed > 0.0 and -(agent.vx * xx + agent.vy * xy) <= _SEEN * speed * distance
    if behind and not (parity and opposite_taken_for_parallel(agent.vx, agent.vy, -xx, -xy)):
        size *= 0.5
    return size * xx, size * xy


@array_kernel
def _faces(s: int, agent: AgentRecord, walls: Rows[WallRecord], params: Pointer) -> bool:
    """Return True if the original model counts wall s.

    It counts if the agent is on its outer side and the wall's nearest point is not its second end.
    """
    wall = walls[s]
    ax, ay, bx, by = wall.ax, wall.ay, wall.bx, wall.by
    outside = ax * (by - ay) - ay * (bx - ax) <= 0.0
    # The nearest point was computed along the segment, so its end is reached up to rounding.
    second = abs(wall.nx - bx) <= SAME_POINT and abs(wall.ny - by) <= SAME_POINT
    return bool(outside and not second and in_range(wall.d2, agent.radius, params))


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
    """Write the sum of forces; pillars push like walls."""
    parity, fx, fy = agent.parity != 0.0, 0.0, 0.0
    for j in range(near_count):
        if not in_range(near[j].d2, near[j].reach, params):
            continue
        if near[j].static != 0.0:
            centre = math.sqrt(near[j].d2)
            surface = centre - (near[j].reach - agent.radius)
            scale = -surface / centre if centre > 0.0 else 0.0
            push = wall_force(scale * near[j].rx, scale * near[j].ry, surface, parity, params)
        else:
            push = _people(agent, near, j, params)
        fx, fy = fx + push[0], fy + push[1]
    if parity:
        for s in range(wall_count):
            if _faces(s, agent, walls, params):
                push = wall_force(-walls[s].nx, -walls[s].ny, math.sqrt(walls[s].d2), True, params)
                fx, fy = fx + push[0], fy + push[1]
        return int(set_target(fx, fy, agent, work))
    own = as_record(params, _PARAMS)
    if not 0.0 < agent.walls_within < own.range + own.from_surface * agent.radius:
        fx, fy = add_walls(fx, fy, agent, walls, wall_count, params, work)
        return int(set_target(fx, fy, agent, work))
    done, fx, fy = add_points(fx, fy, agent, params, work)
    return int(set_target(fx, fy, agent, work)) if done else MORE_WALLS


def build(spec: SocialForcesAvoidanceSpec) -> CompiledCost:
    """Return the compiled functions with this spec's parameters."""
    looked_up = looked_up_to(spec.r, spec.range.value)
    return force_cost(
        spec,
        _prepare,
        record_values(
            _PARAMS,
            spec,
            **spec.range.cost_params(),
            relative=float(spec.stride == "relative"),
        ),
        wall_reach=(0.0 if looked_up > 0.0 else spec.range.value, 0.0),
        looks_farther=looked_up > 0.0,
        points=(looked_up, spec.r),
    )
