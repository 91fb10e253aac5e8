"""Paris as a compiled cost; formulas in docs/reference/crowd/paris.md."""

from __future__ import annotations

import math

import numpy as np
from numba import float32

from crowdbot.core.support.compile import array_kernel
from crowdbot.plugin import (
    AX,
    AY,
    BASE,
    BX,
    BY,
    D2,
    EXCESS,
    GX,
    GY,
    NVX,
    NVY,
    PARITY,
    PREFERRED,
    PREPARE,
    PVX,
    PVY,
    PX,
    PY,
    RADIUS,
    REACH,
    RX,
    RY,
    STATIC,
    VX,
    VY,
    WALL_D2,
    CompiledCost,
    Pointer,
    declared_kernel,
    in_range,
    near_table,
    time_to_disc,
    time_to_segment,
    wall_table,
    work_table,
)
from crowdbot.plugins.crowd.cost_functions.paris import ParisSpec

_W_A, _W_B, _T_MAX = range(2, 5)  # entries of params
_PEOPLE, _PILLARS, _WALLS = range(3)  # entries of row 0 of work
_BRAKING = 0.5  # s of way that has to be free before a wall or a pillar
#: The original's infinity: one blocking neighbour still is finite, and less than none to choose.
_LARGEST = 3.4028234663852886e38
_OFFSET = 1e-3  # keeps the excess positive under parity
_PARALLEL = 1e-5  # m/s; lines whose cross product is below this do not cross


@declared_kernel(BASE)
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    speed = math.hypot(ux, uy)
    ahead = ux / speed if speed > 0.0 else 0.0
    course = 500.0 * (1.0 - params[_W_A]) * (1.0 - ahead)
    return float(course + 0.001 * math.hypot(ux - preferred, uy))


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
    """People, then pillars: offset, velocity, reach. Then walls (none in the original): ends."""
    near, segments, table = near_table(near), wall_table(walls), work_table(work)
    row = 0
    for fixed in range(2):
        for j in range(near_count):
            if near[j, STATIC] != fixed or not in_range(near[j, D2], near[j, REACH], params):
                continue
            row += 1
            table[row, 0], table[row, 1] = near[j, RX], near[j, RY]
            table[row, 2], table[row, 3] = near[j, NVX], near[j, NVY]
            table[row, 4] = near[j, REACH]
        table[0, fixed] = row
    table[0, _PILLARS] -= table[0, _PEOPLE]
    before = row
    for s in range(0 if agent[PARITY] != 0.0 else wall_count):
        if in_range(segments[s, WALL_D2], agent[RADIUS], params):
            row += 1
            table[row, 0], table[row, 1] = segments[s, AX], segments[s, AY]
            table[row, 2], table[row, 3] = segments[s, BX], segments[s, BY]
            table[row, 4] = segments[s, WALL_D2]
    table[0, _WALLS] = row - before
    return 1


@array_kernel
def _time(rx: float, ry: float, vx: float, vy: float, reach: float, parity: bool) -> float:
    """Until a point with velocity v is within reach of (rx, ry)."""
    gap2 = rx * rx + ry * ry - reach * reach
    if gap2 <= 0.0 or (parity and vx == 0.0 and vy == 0.0):
        return 0.0  # the original takes two who keep their distance for touching
    return float(time_to_disc(rx, ry, vx, vy, gap2))


@array_kernel
def _ratio(a: float, b: float) -> float:
    """Quotient; 0 / 0 is 0, which the original leaves undefined."""
    if b != 0.0:
        return a / b
    return 0.0 if a == 0.0 else math.copysign(math.inf, a)


@array_kernel
def _window(
    row: int, ex: float, ey: float, agent: Pointer, work: Pointer, t_max: float
) -> tuple[float, float, float]:
    """When neighbour `row` reaches the crossing, and the speeds between which it is met there."""
    table, parity = work_table(work), agent[PARITY] != 0.0
    rx, ry, vx, vy = table[row, 0], table[row, 1], table[row, 2], table[row, 3]
    reach, cross = table[row, 4], ex * vy - ey * vx
    if abs(cross) < _PARALLEL:
        if _time(rx, ry, ex - vx, ey - vy, reach, parity) > t_max:
            return t_max, 0.0, math.inf
        return 0.0, _LARGEST if parity else math.inf, 0.0
    along = (rx * vy - ry * vx) / cross
    cx, cy = ex * along, ey * along
    if _time(cx, cy, agent[VX], agent[VY], reach, parity) >= t_max:
        return t_max, 0.0, math.inf
    t1 = min(t_max, _time(cx - rx, cy - ry, vx, vy, reach, parity))
    t2 = t1 + reach / math.hypot(vx, vy)
    t2 = t2 if t2 <= t_max else 0.0
    return t1, _ratio(abs(along), t1), _ratio(abs(along), t2)


@array_kernel
def _free_way(row: int, ex: float, ey: float, agent: Pointer, work: Pointer) -> float:
    """Way in direction e before pillar or wall `row` is touched, m."""
    table, radius = work_table(work), agent[RADIUS]
    if row <= int(table[0, _PEOPLE] + table[0, _PILLARS]):
        return float(_time(table[row, 0], table[row, 1], ex, ey, table[row, 4], False))
    if table[row, 4] <= radius * radius:
        return 0.0
    ax, ay, bx, by = table[row, 0], table[row, 1], table[row, 2], table[row, 3]
    return float(time_to_segment(ex, ey, radius, ax, ay, bx, by))


@array_kernel
def _single_unit(x: float, y: float) -> tuple[float, float]:
    """Unit vector in single precision; zero where that knows no length."""
    a, b = float32(x), float32(y)
    size = float32(math.sqrt(float32(a * a) + float32(b * b)))
    if size == float32(0.0):
        return 0.0, 0.0
    return float(float32(a / size)), float(float32(b / size))


@array_kernel
def _rounding(ux: float, uy: float, agent: Pointer) -> float:
    """Error of 1 - cos(u, v_preferred) in the original's single precision.

    It decides between candidates that differ by less than a few millionths of the cost.
    """
    ex, ey = _single_unit(ux, uy)
    if ex == 0.0 and ey == 0.0:
        return 0.0
    gx, gy = _single_unit(
        float32(agent[GX]) - float32(agent[PX]), float32(agent[GY]) - float32(agent[PY])
    )
    preferred = float32(agent[PREFERRED])
    x, y, px, py = float32(ex), float32(ey), float32(gx) * preferred, float32(gy) * preferred
    size, wanted = float32(math.sqrt(x * x + y * y)), float32(math.sqrt(px * px + py * py))
    single = float32(float32(1.0) - float32((x * px + y * py) / (size * wanted)))
    exact = (ux * agent[PVX] + uy * agent[PVY]) / (math.hypot(ux, uy) * agent[PREFERRED])
    return float(float(single) - (1.0 - exact))


@declared_kernel(EXCESS)
def _excess(
    ux: float, uy: float, budget: float, agent: Pointer, work: Pointer, params: Pointer
) -> float:
    table, speed, preferred = work_table(work), math.hypot(ux, uy), agent[PREFERRED]
    if speed == 0.0:
        return _OFFSET if agent[PARITY] != 0.0 else 0.0
    ex, ey, t_max = ux / speed, uy / speed, params[_T_MAX]
    people, risk, misfit = int(table[0, _PEOPLE]), 0.0, 0.0
    if agent[PARITY] != 0.0 and preferred > 0.0:
        misfit = _OFFSET + 500.0 * (1.0 - params[_W_A]) * _rounding(ux, uy, agent)
        ex, ey = _single_unit(ux, uy)
    total = people + int(table[0, _PILLARS] + table[0, _WALLS])
    for row in range(1, total + 1):
        if row <= people:
            t1, s1, s2 = _window(row, ex, ey, agent, work, t_max)
            slower = max(0.0, 1.0 - _ratio(s1, preferred))
            choice = min(slower, max(0.0, _ratio(s2 - preferred, preferred)))
            if choice > 0.0 and t1 < t_max + params[_W_B]:
                risk += choice * (1.0 - t1 / (t_max + params[_W_B]))
            misfit += max(0.0, _ratio(s1 - speed, preferred), _ratio(speed - s2, preferred))
        else:
            free = _free_way(row, ex, ey, agent, work)
            risk += max(0.0, 1.0 - _ratio(free, preferred * t_max))
            misfit += max(0.0, _ratio(speed - free / _BRAKING, preferred))
        if misfit > budget:
            return misfit
    if misfit > _LARGEST:
        return math.inf
    return float(misfit + (1000.0 * params[_W_A] * risk / total if total > 0 else 0.0))


def build(spec: ParisSpec) -> CompiledCost:
    """Compiled functions with this spec's parameters."""
    surface = 1.0 if spec.range.measure == "surface" else 0.0
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        params=np.array([spec.range.value, surface, spec.w_a, spec.w_b, spec.t_max]),
        weight=spec.weight,
    )
