"""FOEAvoidance as a compiled cost; formulas in docs/reference/crowd/foe_avoidance.md."""

from __future__ import annotations

import math

from crowdbot.plugin import (
    COST_PARAMS,
    EXCESS,
    GRADIENT,
    PREPARE,
    WORK_COLUMNS,
    AgentRecord,
    CompiledCost,
    NeighbourRecord,
    Pointer,
    Rows,
    WallRecord,
    array_kernel,
    as_record,
    as_rows,
    declared_kernel,
    in_range,
    nearest_on_segment,
    record_type,
    record_values,
    time_to_segment,
)
from crowdbot.plugin.for_crowds import is_passed, swept_width
from crowdbot.plugins.crowd.cost_functions.foe_avoidance import FoeAvoidanceSpec
from crowdbot.plugins.crowd.cost_functions.force_build import no_base

_AHEAD = 0.1  # m; neighbours less far ahead are not seen
_CLOSING = -0.01  # m/s; neighbours that close in slower are not seen
_SHARPEST_TURN = 0.1  # rad
_SINGLE = 1e-7  # treated as equal in single precision


class _Header:
    """Row 0 of ``work``: how many rows of each follow."""

    discs: float
    walls: float


class _Disc:
    """Row of a neighbour: offset, velocity, sum of radii."""

    x: float
    y: float
    vx: float
    vy: float
    reach: float


class _Wall:
    """Row of a wall: both ends."""

    ax: float
    ay: float
    bx: float
    by: float


_HEADER = record_type(_Header)
_DISC, _WALL = record_type(_Disc, WORK_COLUMNS), record_type(_Wall, WORK_COLUMNS)


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
    """Write neighbours as offset, velocity, sum of radii.

    Then walls (the original has none) as ends.
    """
    header, discs, found = as_record(work, _HEADER), as_rows(work, _DISC), as_rows(work, _WALL)
    row = 0
    for j in range(near_count):
        if in_range(near[j].d2, near[j].reach, params):
            row += 1
            disc, other = discs[row], near[j]
            disc.x, disc.y, disc.reach = other.rx, other.ry, other.reach
            disc.vx, disc.vy = other.nvx, other.nvy
    header.discs = row
    vx, vy, radius, only = agent.vx, agent.vy, agent.radius, agent.descends > 0.0
    width = swept_width(vx, vy, radius)
    for s in range(0 if agent.parity != 0.0 else wall_count):
        near_by = walls[s]
        ax, ay, bx, by = near_by.ax, near_by.ay, near_by.bx, near_by.by
        if only and is_passed(vx, vy, width, ax, ay, bx, by):
            continue  # the gradient asks for the present velocity alone, which never touches it
        d2 = near_by.d2
        if d2 > radius * radius and in_range(d2, radius, params):
            row += 1
            wall = found[row]
            wall.ax, wall.ay, wall.bx, wall.by = ax, ay, bx, by
    header.walls = row - header.discs
    return row


@array_kernel
def _obstacle(row: int, ux: float, uy: float, radius: float, work: Pointer) -> tuple[float, ...]:
    """Return offset, relative velocity and reach of a neighbour, or of the wall point hit first."""
    if row <= int(as_record(work, _HEADER).discs):
        disc = as_rows(work, _DISC)[row]
        return disc.x, disc.y, disc.vx - ux, disc.vy - uy, disc.reach
    wall = as_rows(work, _WALL)[row]
    ax, ay, bx, by = wall.ax, wall.ay, wall.bx, wall.by
    t = math.inf
    if not is_passed(ux, uy, swept_width(ux, uy, radius), ax, ay, bx, by):
        t = time_to_segment(ux, uy, radius, ax, ay, bx, by)
    if t == math.inf:
        return 0.0, 0.0, 0.0, 0.0, radius  # not ahead: not seen
    x, y = nearest_on_segment(t * ux, t * uy, ax, ay, bx, by)
    return x, y, -ux, -uy, radius


@array_kernel
def _terms(row: int, ux: float, uy: float, agent: AgentRecord, work: Pointer) -> tuple[float, ...]:
    """Return focus, bearing, spread, importance times proximity, closing speed of an obstacle."""
    x, y, wx, wy, reach = _obstacle(row, ux, uy, agent.radius, work)
    speed = math.hypot(ux, uy)
    hx, hy = ux / speed, uy / speed
    ahead, right = x * hx + y * hy, x * hy - y * hx
    closing, drift = wx * hx + wy * hy, wx * hy - wy * hx
    if ahead < _AHEAD or closing > _CLOSING:
        return 0.0, 0.0, 1.0, 0.0, -1.0
    t = -ahead / closing
    importance = min(10.0, max(0.1, 10.0 - 2.0 * t)) if t <= 10.0 else 0.0
    focus, bearing = drift / closing, right / ahead
    spread = reach / (ahead * math.log(10.0))
    return focus, bearing, spread, importance * math.exp(-abs(bearing - focus) / spread), closing


@declared_kernel(EXCESS)
def _excess(
    ux: float, uy: float, budget: float, agent: AgentRecord, work: Pointer, params: Pointer
) -> float:
    cost, header = 0.0, as_record(work, _HEADER)
    if ux == 0.0 and uy == 0.0:
        return cost
    for row in range(1, 1 + int(header.discs + header.walls)):
        cost += _terms(row, ux, uy, agent, work)[3]
        if cost > budget:
            break
    return cost


@declared_kernel(GRADIENT)
def _gradient(
    ux: float, uy: float, agent: AgentRecord, work: Pointer, params: Pointer, out: Pointer
) -> int:
    """Write the model's own rule for turning and braking, not the cost's exact gradient."""
    out[0] = out[1] = 0.0
    speed, header = math.hypot(ux, uy), as_record(work, _HEADER)
    if speed == 0.0:
        return 1
    turn = pace = 0.0
    for row in range(1, 1 + int(header.discs + header.walls)):
        focus, bearing, spread, weight, closing = _terms(row, ux, uy, agent, work)
        if agent.parity != 0.0 and abs(bearing - focus) <= _SINGLE:
            weight = 0.0  # the original goes straight on
        elif bearing < focus:
            weight = -weight
        slope = focus * focus - bearing * bearing + speed / closing
        turn += weight * slope / spread
        pace += weight * focus / (closing * spread)
    turn = min(_SHARPEST_TURN, max(-_SHARPEST_TURN, turn))
    across, along = speed * math.sin(turn), speed * (1.0 - math.cos(turn)) + pace
    hx, hy = ux / speed, uy / speed
    out[0], out[1] = -(hy * across + hx * along), -(-hx * across + hy * along)
    return 1


def build(spec: FoeAvoidanceSpec) -> CompiledCost:
    """Return the compiled functions; there are no parameters."""
    return CompiledCost(
        base=no_base,
        prepare=_prepare,
        excess=_excess,
        gradient=_gradient,
        params=record_values(
            COST_PARAMS,
            **spec.range.cost_params(),
        ),
        weight=spec.weight,
        # Nothing is seen that is reached later than in 10 s.
        wall_reach=(2.0, 10.0),
        walls_on_the_way=True,
    )
