"""Personal space, compiled: ``|u - preferred| + sum exp(-gap / fade)``."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from crowdbot.plugin import (
    BASE,
    D2,
    EXCESS,
    GRADIENT,
    NVX,
    NVY,
    PREPARE,
    PVX,
    PVY,
    REACH,
    RX,
    RY,
    CompiledCost,
    in_range,
    near_table,
    work_table,
)
from numba import njit

from crowdbot_acme.personal_space import PersonalSpaceSpec

_AHEAD, _FADE = 2, 3  # entries of params after the range


@njit(BASE, cache=True, error_model="numpy")
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Any) -> float:
    return math.hypot(ux - preferred, uy)


@njit(PREPARE, cache=True, error_model="numpy")
def _prepare(
    agent: Any, near: Any, near_count: int, walls: Any, wall_count: int, params: Any, work: Any
) -> int:
    near, work = near_table(near), work_table(work)
    items = 0
    for i in range(near_count):
        if in_range(near[i, D2], near[i, REACH], params):
            items += 1
            work[items, 0], work[items, 1] = near[i, RX], near[i, RY]
            work[items, 2], work[items, 3] = near[i, NVX], near[i, NVY]
            work[items, 4] = near[i, REACH]
    work[0, 0] = items  # row 0 is not cleared between agents
    return items


@njit(cache=True, error_model="numpy")
def _gap(ux: float, uy: float, row: Any, ahead: float) -> tuple[float, float, float]:
    """Where a neighbour will be (m), and the gap between the surfaces then (m)."""
    x = row[0] + (row[2] - ux) * ahead
    y = row[1] + (row[3] - uy) * ahead
    return x, y, math.hypot(x, y) - row[4]


@njit(EXCESS, cache=True, error_model="numpy")
def _excess(ux: float, uy: float, budget: float, agent: Any, work: Any, params: Any) -> float:
    work, cost = work_table(work), 0.0
    for i in range(1, 1 + int(work[0, 0])):
        _, _, gap = _gap(ux, uy, work[i], params[_AHEAD])
        cost += math.exp(-gap / params[_FADE])
        if cost > budget:  # cannot win any more
            break
    return cost


@njit(GRADIENT, cache=True, error_model="numpy")
def _gradient(ux: float, uy: float, agent: Any, work: Any, params: Any, out: Any) -> int:
    dx, dy = ux - agent[PVX], uy - agent[PVY]
    off = max(math.hypot(dx, dy), 1e-9)
    gx, gy = dx / off, dy / off
    work = work_table(work)
    for i in range(1, 1 + int(work[0, 0])):
        x, y, gap = _gap(ux, uy, work[i], params[_AHEAD])
        away = max(math.hypot(x, y), 1e-9)
        slope = math.exp(-gap / params[_FADE]) / params[_FADE] * params[_AHEAD] / away
        gx, gy = gx + slope * x, gy + slope * y
    out[0], out[1] = gx, gy
    return 1


def build(spec: PersonalSpaceSpec) -> CompiledCost:
    """The functions with this spec's parameters."""
    surface = 1.0 if spec.range.measure == "surface" else 0.0
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        gradient=_gradient,
        params=np.array([spec.range.value, surface, spec.ahead, spec.fade]),
        weight=spec.weight,
    )
