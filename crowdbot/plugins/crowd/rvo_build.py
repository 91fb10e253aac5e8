"""RVO as a compiled cost: ``w / T(2u - v) + |u - v_preferred|``, T the first collision time."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from crowdbot.core.crowd.cost import (
    BASE,
    D2,
    EXCESS,
    FROM_SURFACE,
    NVX,
    NVY,
    PREPARE,
    PX,
    PY,
    RADIUS,
    RANGE,
    REACH,
    RX,
    RY,
    VX,
    VY,
    CompiledCost,
    Pointer,
    near_table,
    wall_table,
    work_table,
)
from crowdbot.core.crowd.geometry import nearest_on_segment, time_to_disc, time_to_segment
from crowdbot.plugins.crowd.rvo import RvoSpec

_W = 2  # entry of params


@njit(BASE, cache=True, error_model="numpy")
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    if math.hypot(ux, uy) > max_speed * (1.0 + 1e-12):
        return math.inf
    return math.hypot(ux - preferred, uy)


@njit(PREPARE, cache=True, error_model="numpy")
def _prepare(
    agent: Pointer,
    near: Pointer,
    near_count: int,
    walls: Pointer,
    wall_count: int,
    params: Pointer,
    work: Pointer,
) -> int:
    """Row 0: number of neighbours, of walls. Then r, v_j, d^2 - R^2; then ends of walls from p."""
    near, walls, work = near_table(near), wall_table(walls), work_table(work)
    discs = 0
    for j in range(near_count):
        reach = params[RANGE] + params[FROM_SURFACE] * near[j, REACH]
        gap2 = near[j, D2] - near[j, REACH] ** 2
        if near[j, D2] >= reach * reach or gap2 <= 0.0:  # discs that overlap are ignored
            continue
        discs += 1
        work[discs, 0], work[discs, 1] = near[j, RX], near[j, RY]
        work[discs, 2], work[discs, 3] = near[j, NVX], near[j, NVY]
        work[discs, 4] = gap2
    walls_near = 0
    px, py, radius = agent[PX], agent[PY], agent[RADIUS]
    reach = params[RANGE] + params[FROM_SURFACE] * radius
    for s in range(wall_count):
        nx, ny = nearest_on_segment(px, py, walls[s, 0], walls[s, 1], walls[s, 2], walls[s, 3])
        d2 = (px - nx) ** 2 + (py - ny) ** 2
        if radius * radius < d2 <= reach * reach:  # walls that overlap are ignored, too
            walls_near += 1
            row = discs + walls_near
            work[row, 0], work[row, 1] = walls[s, 0] - px, walls[s, 1] - py
            work[row, 2], work[row, 3] = walls[s, 2] - px, walls[s, 3] - py
    work[0, 0], work[0, 1] = discs, walls_near
    return discs + walls_near


@njit(EXCESS, cache=True, error_model="numpy")
def _excess(
    ux: float, uy: float, budget: float, agent: Pointer, work: Pointer, params: Pointer
) -> float:
    work = work_table(work)
    vx, vy = 2.0 * ux - agent[VX], 2.0 * uy - agent[VY]
    discs, segments = int(work[0, 0]), int(work[0, 1])
    too_soon = params[_W] / budget if budget > 0.0 else math.inf
    first = math.inf
    for j in range(1, discs + 1):
        t = time_to_disc(work[j, 0], work[j, 1], vx - work[j, 2], vy - work[j, 3], work[j, 4])
        first = min(first, t)
        if first < too_soon:
            return float(params[_W] / first)
    for j in range(discs + 1, discs + 1 + segments):
        t = time_to_segment(vx, vy, agent[RADIUS], work[j, 0], work[j, 1], work[j, 2], work[j, 3])
        first = min(first, t)
    return float(params[_W] / first)


def build(spec: RvoSpec) -> CompiledCost:
    """Compile-time functions with this spec's parameters."""
    surface = 1.0 if spec.range.measure == "surface" else 0.0
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        params=np.array([spec.range.value, surface, spec.w]),
        weight=spec.weight,
    )
