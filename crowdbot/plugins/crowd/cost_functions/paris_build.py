"""Paris as a compiled cost; formulas in docs/reference/crowd/paris.md."""

from __future__ import annotations

import math
from typing import Any

from numba import float32

from crowdbot.plugin import (
    BASE,
    EXCESS,
    PREPARE,
    WORK_COLUMNS,
    AgentRecord,
    CompiledCost,
    CostParams,
    NeighbourRecord,
    Pointer,
    Rows,
    WallRecord,
    array_kernel,
    as_record,
    as_rows,
    declared_kernel,
    in_range,
    record_type,
    record_values,
    time_to_disc,
    time_to_segment,
)
from crowdbot.plugin.for_crowds import MORE_WALLS, is_passed, swept_width, walls_closer_than
from crowdbot.plugins.crowd.cost_functions.paris import ParisSpec

_BRAKING = 0.5  # s of free distance required before a wall or a pillar
#: The original's infinity: one blocking neighbour has a finite cost, lower than having no choice.
_LARGEST = 3.4028234663852886e38
_OFFSET = 1e-3  # keeps the excess positive under parity
_PARALLEL = 1e-5  # m/s; lines whose cross product is below this do not cross


class _Params(CostParams):
    """Parameters; units are those of the spec."""

    w_a: float
    w_b: float
    t_max: float


class _Header:
    """Row 0 of ``work``: how many rows of each follow, and how many walls are in range at all."""

    people: float
    pillars: float
    walls: float
    all_walls: float


class _Disc:
    """Row of a person or a pillar: offset, velocity, sum of radii."""

    x: float
    y: float
    vx: float
    vy: float
    reach: float


class _Wall:
    """Row of a wall: both ends, squared distance."""

    ax: float
    ay: float
    bx: float
    by: float
    d2: float


_PARAMS, _HEADER = record_type(_Params), record_type(_Header)
_DISC, _WALL = record_type(_Disc, WORK_COLUMNS), record_type(_Wall, WORK_COLUMNS)


@declared_kernel(BASE)
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    own = as_record(params, _PARAMS)
    speed = math.hypot(ux, uy)
    ahead = ux / speed if speed > 0.0 else 0.0
    course = 500.0 * (1.0 - own.w_a) * (1.0 - ahead)
    return float(course + 0.001 * math.hypot(ux - preferred, uy))


@array_kernel
def _walls_in_range(
    agent: AgentRecord, walls: Rows[WallRecord], wall_count: int, params: Pointer
) -> float:
    """Return the number of walls in range, or -1 if it depends on walls that were not given."""
    own, count = as_record(params, _PARAMS), 0
    if agent.parity != 0.0:
        return 0.0
    if agent.walls_within > 0.0:
        return float(walls_closer_than(agent, own.range + own.from_surface * agent.radius))
    for s in range(wall_count):
        count += int(in_range(walls[s].d2, agent.radius, params))
    return float(count)


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
    """Write people, then pillars: offset, velocity, reach.

    Then walls (the original has none): ends of those that are near enough for a cost.
    """
    header, discs, found = as_record(work, _HEADER), as_rows(work, _DISC), as_rows(work, _WALL)
    row = 0
    for fixed in range(2):
        for j in range(near_count):
            if near[j].static != fixed or not in_range(near[j].d2, near[j].reach, params):
                continue
            row += 1
            disc, other = discs[row], near[j]
            disc.x, disc.y, disc.reach = other.rx, other.ry, other.reach
            disc.vx, disc.vy = other.nvx, other.nvy
        if fixed == 0:
            header.people = row
    header.pillars = row - header.people
    own, before = as_record(params, _PARAMS), row
    header.all_walls = _walls_in_range(agent, walls, wall_count, params)
    if header.all_walls < 0.0:
        return MORE_WALLS
    far = max(agent.preferred * own.t_max, _BRAKING * max(agent.fastest, agent.asked_radius))
    far = agent.radius + (1.0 + 1e-6) * far
    if agent.parity == 0.0 and 0.0 < agent.walls_within < far:
        return MORE_WALLS
    for s in range(0 if agent.parity != 0.0 else wall_count):
        if walls[s].d2 <= far * far and in_range(walls[s].d2, agent.radius, params):
            row += 1
            wall, near_by = found[row], walls[s]
            wall.ax, wall.ay, wall.bx, wall.by = near_by.ax, near_by.ay, near_by.bx, near_by.by
            wall.d2 = near_by.d2
    header.walls = row - before
    return 1


@array_kernel
def _time(rx: float, ry: float, vx: float, vy: float, reach: float, parity: bool) -> float:
    """Return the time until a point with velocity v is within reach of (rx, ry)."""
    gap2 = rx * rx + ry * ry - reach * reach
    if gap2 <= 0.0 or (parity and vx == 0.0 and vy == 0.0):
        return 0.0  # the original treats a pair with constant distance as touching
    return float(time_to_disc(rx, ry, vx, vy, gap2))


@array_kernel
def _ratio(a: float, b: float) -> float:
    """Return the quotient; 0 / 0 is 0, which the original leaves undefined."""
    if b != 0.0:
        return a / b
    return 0.0 if a == 0.0 else math.copysign(math.inf, a)


@array_kernel
def _window(
    row: int, ex: float, ey: float, agent: AgentRecord, work: Pointer, t_max: float
) -> tuple[float, float, float]:
    """Return when neighbour `row` reaches the crossing, and the speeds that meet it there."""
    disc, parity = as_rows(work, _DISC)[row], agent.parity != 0.0
    rx, ry, vx, vy = disc.x, disc.y, disc.vx, disc.vy
    reach, cross = disc.reach, ex * vy - ey * vx
    if abs(cross) < _PARALLEL:
        if _time(rx, ry, ex - vx, ey - vy, reach, parity) > t_max:
            return t_max, 0.0, math.inf
        return 0.0, _LARGEST if parity else math.inf, 0.0
    along = (rx * vy - ry * vx) / cross
    cx, cy = ex * along, ey * along
    if _time(cx, cy, agent.vx, agent.vy, reach, parity) >= t_max:
        return t_max, 0.0, math.inf
    t1 = min(t_max, _time(cx - rx, cy - ry, vx, vy, reach, parity))
    t2 = t1 + reach / math.hypot(vx, vy)
    t2 = t2 if t2 <= t_max else 0.0
    return t1, _ratio(abs(along), t1), _ratio(abs(along), t2)


@array_kernel
def _free_way(row: int, ex: float, ey: float, agent: AgentRecord, work: Pointer) -> float:
    """Return the distance in direction e until pillar or wall `row` is touched, m."""
    header, radius = as_record(work, _HEADER), agent.radius
    if row <= int(header.people + header.pillars):
        disc = as_rows(work, _DISC)[row]
        return float(_time(disc.x, disc.y, ex, ey, disc.reach, False))
    wall = as_rows(work, _WALL)[row]
    if wall.d2 <= radius * radius:
        return 0.0
    if is_passed(ex, ey, swept_width(ex, ey, radius), wall.ax, wall.ay, wall.bx, wall.by):
        return math.inf
    return float(time_to_segment(ex, ey, radius, wall.ax, wall.ay, wall.bx, wall.by))


@array_kernel
def _single_unit(x: Any, y: Any) -> tuple[float, float]:
    """Return a unit vector in single precision; zero if its length underflows."""
    a, b = float32(x), float32(y)
    size = float32(math.sqrt(float32(a * a) + float32(b * b)))
    if size == float32(0.0):
        return 0.0, 0.0
    return float(float32(a / size)), float(float32(b / size))


@array_kernel
def _rounding(ux: float, uy: float, agent: AgentRecord) -> float:
    """Return the error of 1 - cos(u, v_preferred) in the original's single precision.

    It decides between candidates that differ by less than a few millionths of the cost.
    """
    ex, ey = _single_unit(ux, uy)
    if ex == 0.0 and ey == 0.0:
        return 0.0
    gx, gy = _single_unit(
        float32(agent.gx) - float32(agent.px), float32(agent.gy) - float32(agent.py)
    )
    preferred = float32(agent.preferred)
    x, y, px, py = float32(ex), float32(ey), float32(gx) * preferred, float32(gy) * preferred
    size, preferred_size = float32(math.sqrt(x * x + y * y)), float32(math.sqrt(px * px + py * py))
    single = float32(float32(1.0) - float32((x * px + y * py) / (size * preferred_size)))
    exact = (ux * agent.pvx + uy * agent.pvy) / (math.hypot(ux, uy) * agent.preferred)
    return float(float(single) - (1.0 - exact))


@declared_kernel(EXCESS)
def _excess(
    ux: float, uy: float, budget: float, agent: AgentRecord, work: Pointer, params: Pointer
) -> float:
    own = as_record(params, _PARAMS)
    header, speed, preferred = as_record(work, _HEADER), math.hypot(ux, uy), agent.preferred
    if speed == 0.0:
        return _OFFSET if agent.parity != 0.0 else 0.0
    ex, ey, t_max = ux / speed, uy / speed, own.t_max
    people, risk, misfit = int(header.people), 0.0, 0.0
    if agent.parity != 0.0 and preferred > 0.0:
        misfit = _OFFSET + 500.0 * (1.0 - own.w_a) * _rounding(ux, uy, agent)
        ex, ey = _single_unit(ux, uy)
    listed = people + int(header.pillars + header.walls)
    total = people + int(header.pillars + header.all_walls)
    for row in range(1, listed + 1):
        if row <= people:
            t1, s1, s2 = _window(row, ex, ey, agent, work, t_max)
            slower = max(0.0, 1.0 - _ratio(s1, preferred))
            choice = min(slower, max(0.0, _ratio(s2 - preferred, preferred)))
            if choice > 0.0 and t1 < t_max + own.w_b:
                risk += choice * (1.0 - t1 / (t_max + own.w_b))
            misfit += max(0.0, _ratio(s1 - speed, preferred), _ratio(speed - s2, preferred))
        else:
            free = _free_way(row, ex, ey, agent, work)
            risk += max(0.0, 1.0 - _ratio(free, preferred * t_max))
            misfit += max(0.0, _ratio(speed - free / _BRAKING, preferred))
        if misfit > budget:
            return misfit
    if misfit > _LARGEST:
        return math.inf
    return float(misfit + (1000.0 * own.w_a * risk / total if total > 0 else 0.0))


def build(spec: ParisSpec) -> CompiledCost:
    """Return the compiled functions with this spec's parameters."""
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        params=record_values(_PARAMS, spec, **spec.range.cost_params()),
        weight=spec.weight,
        # Walls that are farther away are only counted.
        wall_reach=(0.0, (1.0 + 2e-6) * max(spec.t_max, _BRAKING)),
        reach_at_preferred=True,
        looks_farther=True,
    )
