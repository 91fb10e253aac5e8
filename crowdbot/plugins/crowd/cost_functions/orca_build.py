"""ORCA as a compiled cost, with its optimum; formulas in docs/reference/crowd/orca.md."""

from __future__ import annotations

import math

from crowdbot.plugin import (
    BASE,
    EXCESS,
    OPTIMUM,
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
from crowdbot.plugins.crowd.cost_functions.half_planes_build import best_velocity, put, violation
from crowdbot.plugins.crowd.cost_functions.orca import OrcaSpec

_BRAKING = 0.5  # s within which the gap to a wall may be used up


class _Params(CostParams):
    """Parameters of ORCA, as a record.

    Attributes:
        horizon: time for which discs apart are kept apart, s.
        limit: 1 if the optimum is not faster than preferred.
    """

    horizon: float
    limit: float


_PARAMS = record_type(_Params)


@declared_kernel(BASE)
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    return min(math.hypot(ux - preferred, uy), 2.0 * max_speed)


@array_kernel
def change(
    rx: float,
    ry: float,
    wx: float,
    wy: float,
    reach: float,
    horizon: float,
    dt: float,
    parity: bool,
) -> tuple[float, float, float]:
    """Return the unit vector out of the velocity obstacle, and the distance to its border along it.

    Args:
        rx, ry: centre of the other disc minus own centre.
        wx, wy: own velocity minus the other's.
        horizon, dt: time for which separate discs stay apart, and in which overlapping ones
            separate.
    """  # fmt: skip
    d2 = rx * rx + ry * ry
    gap2 = d2 - reach * reach
    time = horizon if gap2 > 0.0 else dt
    ox, oy = wx - rx / time, wy - ry / time  # from the centre of the cut-off disc
    out2, towards = ox * ox + oy * oy, ox * rx + oy * ry
    if gap2 <= 0.0 or (towards < 0.0 and towards * towards > reach * reach * out2):
        out = math.sqrt(out2)
        if out == 0.0:
            distance = math.sqrt(d2)
            return (-rx / distance, -ry / distance, reach / time) if d2 > 0.0 else (0.0, 0.0, 0.0)
        if parity and gap2 <= 0.0:  # divided by the square, so not a unit vector
            return ox / out2, oy / out2, reach / time - out2
        return ox / out, oy / out, reach / time - out
    leg, side = math.sqrt(gap2), 1.0 if rx * oy - ry * ox > 0.0 else -1.0
    nx, ny = -(side * rx * reach + ry * leg) / d2, (rx * leg - side * ry * reach) / d2
    nx, ny = side * nx, side * ny
    return nx, ny, -(wx * nx + wy * ny)


@array_kernel
def is_out_of_the_way(
    rx: float, ry: float, d2: float, vx: float, vy: float, radius: float, horizon: float,
    ax: float, ay: float, spread: float,
) -> bool:  # fmt: skip
    """Return True if a wall's two half-planes clearly change nothing.

    Usually decided without a square root. The second half-plane touches the cut-off disc, and is c
    - reach away from 0, where c is the part of the disc's centre along its normal.

    Args:
        rx, ry, d2: nearest point of the wall and its squared distance.
        ax, ay, spread: centre and radius of the disc, m/s.
    """
    share = 1.0 / horizon
    stops = radius + _BRAKING * (spread + abs(ax) + abs(ay))
    ox, oy = vx - share * rx, vy - share * ry  # from the centre of the cut-off disc
    out2, behind = (1.0 + 1e-9) * (ox * ox + oy * oy), -share * (ox * rx + oy * ry)
    inside = behind + ox * ax + oy * ay  # how far the disc's centre is inside, times out
    far = (d2 > (1.0 + 1e-9) * stops * stops) & (behind > 0.0) & (inside > 0.0)
    touches = behind * behind > share * share * radius * radius * out2
    needed = share * radius + spread
    return bool(far & touches & (inside * inside > needed * needed * out2))


@array_kernel
def _put_walls(
    agent: AgentRecord,
    walls: Rows[WallRecord],
    wall_count: int,
    params: Pointer,
    work: Pointer,
    count: int,
) -> int:
    """Write two half-planes per wall: for braking, and for passing its nearest point.

    Those that hold all velocities in question change nothing, and most are such ones.
    """
    own = as_record(params, _PARAMS)
    vx, vy, radius = agent.vx, agent.vy, agent.radius
    ax, ay, spread = agent.asked_x, agent.asked_y, (1.0 + 1e-6) * agent.asked_radius
    for s in range(wall_count):
        d2, rx, ry = walls[s].d2, walls[s].nx, walls[s].ny
        if is_out_of_the_way(rx, ry, d2, vx, vy, radius, own.horizon, ax, ay, spread):
            continue
        if d2 == 0.0 or not in_range(d2, radius, params):
            continue
        distance = math.sqrt(d2)
        nx, ny, c = -rx / distance, -ry / distance, (radius - distance) / _BRAKING
        if c >= nx * ax + ny * ay - spread:
            put(work, count, nx, ny, c)
            count += 1
        if distance > radius:
            nx, ny, way = change(rx, ry, vx, vy, radius, own.horizon, 1.0, False)
            c = nx * vx + ny * vy + way
            if c >= nx * ax + ny * ay - spread:
                put(work, count, nx, ny, c)
                count += 1
    return count


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
    """Write row 0: the number of half-planes; then the half-planes."""
    own = as_record(params, _PARAMS)
    count = 0
    vx, vy, horizon, dt = agent.vx, agent.vy, own.horizon, agent.time_step
    parity = agent.parity != 0.0
    ax, ay, spread = agent.asked_x, agent.asked_y, (1.0 + 1e-6) * agent.asked_radius
    for j in range(near_count):
        if not in_range(near[j].d2, near[j].reach, params):
            continue
        wx, wy = vx - near[j].nvx, vy - near[j].nvy
        nx, ny, way = change(
            near[j].rx, near[j].ry, wx, wy, near[j].reach, horizon, dt, parity
        )  # fmt: skip
        if nx == 0.0 and ny == 0.0:
            continue
        share = 1.0 if near[j].static != 0.0 else 0.5  # people share the avoidance equally
        c = nx * (vx + share * way * nx) + ny * (vy + share * way * ny)
        if parity or c >= nx * ax + ny * ay - spread:
            put(work, count, nx, ny, c)
            count += 1
    if not parity:
        count = _put_walls(agent, walls, wall_count, params, work, count)
    work[0] = count
    return max(count, 1)  # the base alone may be below the cost of a candidate that is too fast


@declared_kernel(EXCESS)
def _excess(
    ux: float, uy: float, budget: float, agent: AgentRecord, work: Pointer, params: Pointer
) -> float:
    most, worst = 2.0 * agent.max_speed, 0.0
    deviation = math.hypot(ux - agent.pvx, uy - agent.pvy)
    base = min(deviation, most)
    for k in range(int(work[0])):
        worst = max(worst, violation(work, k, ux, uy))
        if worst > 0.0 and most + worst - base > budget:
            break
    return float(most + worst - base if worst > 0.0 else deviation - base)


@declared_kernel(OPTIMUM)
def _optimum(agent: AgentRecord, work: Pointer, params: Pointer, out: Pointer) -> int:
    own = as_record(params, _PARAMS)
    fastest = agent.max_speed
    if own.limit != 0.0:
        fastest = min(fastest, math.hypot(agent.pvx, agent.pvy))
    out[0], out[1] = best_velocity(work, int(work[0]), fastest, agent.pvx, agent.pvy)
    return 1


def build(spec: OrcaSpec) -> CompiledCost:
    """Return the compiled functions with this spec's parameters."""
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        optimum=_optimum,
        params=record_values(
            _PARAMS,
            **spec.range.cost_params(),
            horizon=spec.time_horizon,
            limit=float(spec.limit == "preferred_speed"),
        ),
        weight=spec.weight,
        # Beyond, half-planes hold every velocity: their borders touch the cut-off disc, whose
        # tangents through the present velocity v are sqrt(centre^2 - v^2) or more away from 0.
        wall_reach=(1.0, (1.0 + 1e-5) * max(spec.time_horizon, _BRAKING)),
        reach_with_own=True,
        # The cut-off disc of a wall beyond is farther from v than d and its radius, so the wall's
        # half-planes hold every velocity that differs from v by less than d.
        optimum_by_nearby_walls=True,
    )
