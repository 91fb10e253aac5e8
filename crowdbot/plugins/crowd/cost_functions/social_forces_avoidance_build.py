"""SocialForcesAvoidance as a compiled cost.

Formulas in docs/reference/crowd/social_forces_avoidance.md.
"""

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
from crowdbot.plugin.for_crowds import MORE_WALLS, opposite_taken_for_parallel
from crowdbot.plugins.crowd.cost_functions.force_build import force_cost, set_target
from crowdbot.plugins.crowd.cost_functions.social_forces_avoidance import SocialForcesAvoidanceSpec
from crowdbot.plugins.crowd.cost_functions.wall_points_build import (
    SAME,
    clear_table,
    is_known,
    repeats,
)

_CLOSEST = 0.001  # m; nothing nearer exerts a force
#: A force exp(_LOST) times weaker than a sum is lost when it is added: half of its last bit is at
#: least 2^-54 of it, and exponentials are exact to much less than the other half.
_LOST = 55.0 * math.log(2.0)
#: The bound of a sum is set this much below it, and again if the sum is so much above the bound.
_SMALLER, _LARGER = 0.5, 16.0
#: Equal points have equal squared distances, but for rounding and `SAME`.
_BEFORE = 1.0 - 1e-6
#: Walls are first looked at up to this many times their reach r.
_REACHES = 60.0
_SEEN = math.cos(math.radians(100.0))  # half the field of view


class _Params(CostParams):
    """Parameters; units are those of the spec."""

    v0: float
    sigma: float
    u0: float
    r: float
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
    if minor2 <= 0.0 or math.sqrt(minor2) < _CLOSEST:
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
def _wall(
    yx: float, yy: float, distance: float, parity: bool, params: Pointer
) -> tuple[float, ...]:
    """Return the force per mass from a wall point; y points from it to the agent."""
    own = as_record(params, _PARAMS)
    if distance < _CLOSEST:
        return 0.0, 0.0
    size = own.u0 / own.r * math.exp(-distance / own.r)
    if not parity:
        size /= distance
    return size * yx, size * yy


@array_kernel
def _faces(s: int, agent: AgentRecord, walls: Rows[WallRecord], params: Pointer) -> bool:
    """Return True if the original model counts wall s.

    It counts if the agent is on its outer side and the wall's nearest point is not its second end.
    """
    wall = walls[s]
    ax, ay, bx, by = wall.ax, wall.ay, wall.bx, wall.by
    outside = ax * (by - ay) - ay * (bx - ax) <= 0.0
    # The nearest point was computed along the segment, so its end is reached up to rounding.
    second = abs(wall.nx - bx) <= SAME and abs(wall.ny - by) <= SAME
    return bool(outside and not second and in_range(wall.d2, agent.radius, params))


@array_kernel
def _lost_beyond(least: float, params: Pointer) -> float:
    """Return the distance (m) beyond which walls do not change a sum of ``least`` m/s^2 or more."""
    own = as_record(params, _PARAMS)
    if least <= 0.0 or own.u0 <= 0.0:
        return math.inf
    return float(max(0.0, own.r * (math.log(own.u0 / own.r / least) + _LOST)))


@array_kernel
def _add_walls(
    fx: float, fy: float, known: float, agent: AgentRecord, walls: Rows[WallRecord],
    wall_count: int, params: Pointer, work: Pointer,
) -> tuple[bool, float, float]:  # fmt: skip
    """Add the forces of walls in turn; leave out those that are lost in the sum as it is then.

    A wall that is left out may have the nearest point of a later one, which does not count then.

    Args:
        known: walls farther than this are not given, m; may be infinite.

    Returns:
        True, and the sum, m/s^2; False if walls that are not given might change its bits.
    """
    size = clear_table(0, wall_count, work)
    # The sum is at least ``least`` in both directions, and beyond ``far`` walls are lost in that.
    least = _SMALLER * min(abs(fx), abs(fy))
    far = _lost_beyond(least, params)
    left_out = math.inf
    for s in range(wall_count):
        if far > known:
            return False, fx, fy
        d2 = walls[s].d2
        if d2 > far * far:
            left_out = min(left_out, d2)
            continue
        if not in_range(d2, agent.radius, params) or is_known(walls, s, 0, size, work):
            continue
        if d2 > _BEFORE * left_out and repeats(walls, s):
            continue
        push = _wall(-walls[s].nx, -walls[s].ny, math.sqrt(d2), False, params)
        fx, fy = fx + push[0], fy + push[1]
        now = min(abs(fx), abs(fy))
        if now < least or now > _LARGER * least:
            least = _SMALLER * now
            far = _lost_beyond(least, params)
    return far <= known, fx, fy


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
            push = _wall(scale * near[j].rx, scale * near[j].ry, surface, parity, params)
        else:
            push = _people(agent, near, j, params)
        fx, fy = fx + push[0], fy + push[1]
    if parity:
        for s in range(wall_count):
            if _faces(s, agent, walls, params):
                push = _wall(-walls[s].nx, -walls[s].ny, math.sqrt(walls[s].d2), True, params)
                fx, fy = fx + push[0], fy + push[1]
        return int(set_target(fx, fy, agent, work))
    own = as_record(params, _PARAMS)
    given = not 0.0 < agent.walls_within < own.range + own.from_surface * agent.radius
    known = math.inf if given else agent.walls_within
    done, fx, fy = _add_walls(fx, fy, known, agent, walls, wall_count, params, work)
    return int(set_target(fx, fy, agent, work)) if done else MORE_WALLS


def build(spec: SocialForcesAvoidanceSpec) -> CompiledCost:
    """Return the compiled functions with this spec's parameters."""
    return force_cost(
        spec,
        _prepare,
        record_values(
            _PARAMS,
            spec,
            **spec.range.cost_params(),
            relative=float(spec.stride == "relative"),
        ),
        wall_reach=(min(_REACHES * spec.r, spec.range.value), 0.0),
        looks_farther=True,
    )
