from __future__ import annotations

import math

import numpy as np
from numba import njit

from crowdbot.plugin import (
    BASE,
    D2,
    EXCESS,
    NVX,
    NVY,
    PREPARE,
    REACH,
    RX,
    RY,
    CompiledCost,
    Pointer,
    in_range,
    near_table,
    work_table,
)
from my_costs import QuickElbowRoomSpec
from my_costs.numpy_build import AHEAD


@njit(BASE, cache=True, error_model="numpy")
def base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    return math.hypot(ux - preferred, uy)


@njit(PREPARE, cache=True, error_model="numpy")
def prepare(
    agent: Pointer,
    near: Pointer,
    near_count: int,
    walls: Pointer,
    wall_count: int,
    params: Pointer,
    work: Pointer,
) -> int:
    others, table, items = near_table(near), work_table(work), 0
    for k in range(near_count):
        if in_range(others[k, D2], others[k, REACH], params):
            items += 1
            table[items, 0] = others[k, RX] + AHEAD * others[k, NVX]
            table[items, 1] = others[k, RY] + AHEAD * others[k, NVY]
            table[items, 2] = others[k, REACH]
    table[0, 0] = items
    return items


@njit(EXCESS, cache=True, error_model="numpy")
def excess(
    ux: float, uy: float, budget: float, agent: Pointer, work: Pointer, params: Pointer
) -> float:
    table, total = work_table(work), 0.0
    for k in range(1, int(table[0, 0]) + 1):
        gap = math.hypot(table[k, 0] - AHEAD * ux, table[k, 1] - AHEAD * uy) - table[k, 2]
        total += math.exp(-max(gap, 0.0))
        if total > budget:
            break
    return total


def build(spec: QuickElbowRoomSpec) -> CompiledCost:
    return CompiledCost(
        base=base,
        prepare=prepare,
        excess=excess,
        params=np.array([spec.range, 0.0]),
        weight=spec.weight,
    )
