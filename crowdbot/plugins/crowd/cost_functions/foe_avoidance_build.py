"""FOEAvoidance as a compiled cost; formulas in docs/reference/crowd/foe_avoidance.md."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.support.compile import array_kernel
from crowdbot.plugin import (
    AX,
    AY,
    BX,
    BY,
    D2,
    EXCESS,
    GRADIENT,
    NVX,
    NVY,
    PARITY,
    PREPARE,
    RADIUS,
    REACH,
    RX,
    RY,
    WALL_D2,
    CompiledCost,
    Pointer,
    declared_kernel,
    in_range,
    near_table,
    nearest_on_segment,
    time_to_segment,
    wall_table,
    work_table,
)
from crowdbot.plugins.crowd.cost_functions.foe_avoidance import FoeAvoidanceSpec
from crowdbot.plugins.crowd.cost_functions.force_build import no_base

_DISCS, _WALLS = 0, 1  # entries of row 0 of work
_AHEAD = 0.1  # m; who is less far ahead is not seen
_CLOSING = -0.01  # m/s; who closes in slower is not seen
_SHARPEST_TURN = 0.1  # rad
_SINGLE = 1e-7  # what single precision takes for equal


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
    """Neighbours as offset, velocity, sum of radii; then walls (none in the original) as ends."""
    near, segments, table = near_table(near), wall_table(walls), work_table(work)
    row = 0
    for j in range(near_count):
        if in_range(near[j, D2], near[j, REACH], params):
            row += 1
            table[row, 0], table[row, 1] = near[j, RX], near[j, RY]
            table[row, 2], table[row, 3] = near[j, NVX], near[j, NVY]
            table[row, 4] = near[j, REACH]
    table[0, _DISCS] = row
    for s in range(0 if agent[PARITY] != 0.0 else wall_count):
        d2, radius = segments[s, WALL_D2], agent[RADIUS]
        if d2 > radius * radius and in_range(d2, radius, params):
            row += 1
            table[row, 0], table[row, 1] = segments[s, AX], segments[s, AY]
            table[row, 2], table[row, 3] = segments[s, BX], segments[s, BY]
    table[0, _WALLS] = row - table[0, _DISCS]
    return row


@array_kernel
def _obstacle(row: int, ux: float, uy: float, radius: float, work: Pointer) -> tuple[float, ...]:
    """Offset, relative velocity and reach: of a neighbour, or of the wall point hit first."""
    table = work_table(work)
    if row <= int(table[0, _DISCS]):
        wx, wy = table[row, 2] - ux, table[row, 3] - uy
        return table[row, 0], table[row, 1], wx, wy, table[row, 4]
    ax, ay, bx, by = table[row, 0], table[row, 1], table[row, 2], table[row, 3]
    t = time_to_segment(ux, uy, radius, ax, ay, bx, by)
    if t == math.inf:
        return 0.0, 0.0, 0.0, 0.0, radius  # not ahead: not seen
    x, y = nearest_on_segment(t * ux, t * uy, ax, ay, bx, by)
    return x, y, -ux, -uy, radius


@array_kernel
def _terms(row: int, ux: float, uy: float, agent: Pointer, work: Pointer) -> tuple[float, ...]:
    """Focus, bearing, spread, importance times proximity, closing speed of one obstacle."""
    x, y, wx, wy, reach = _obstacle(row, ux, uy, agent[RADIUS], work)
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
    ux: float, uy: float, budget: float, agent: Pointer, work: Pointer, params: Pointer
) -> float:
    cost, table = 0.0, work_table(work)
    if ux == 0.0 and uy == 0.0:
        return cost
    for row in range(1, 1 + int(table[0, _DISCS] + table[0, _WALLS])):
        cost += _terms(row, ux, uy, agent, work)[3]
        if cost > budget:
            break
    return cost


@declared_kernel(GRADIENT)
def _gradient(
    ux: float, uy: float, agent: Pointer, work: Pointer, params: Pointer, out: Pointer
) -> int:
    """The model's own rule for turning and braking, which is not the cost's exact gradient."""
    out[0] = out[1] = 0.0
    speed, table = math.hypot(ux, uy), work_table(work)
    if speed == 0.0:
        return 1
    turn = pace = 0.0
    for row in range(1, 1 + int(table[0, _DISCS] + table[0, _WALLS])):
        focus, bearing, spread, weight, closing = _terms(row, ux, uy, agent, work)
        if agent[PARITY] != 0.0 and abs(bearing - focus) <= _SINGLE:
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
    """Compiled functions; there are no parameters."""
    return CompiledCost(
        base=no_base,
        prepare=_prepare,
        excess=_excess,
        gradient=_gradient,
        params=np.array([spec.range.value, 1.0 if spec.range.measure == "surface" else 0.0]),
        weight=spec.weight,
    )
