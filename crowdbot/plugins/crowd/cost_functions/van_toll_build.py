"""VanToll as a compiled cost: the way that is not free, deviation from the goal, inertia.

Base: angle to the preferred velocity + ||u| - s| / s. Excess: d - min(d, T |u|) + angle to the
present velocity, with d the max_distance and T the time to the first collision.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import (
    BASE,
    EXCESS,
    FASTEST,
    PREPARE,
    VX,
    VY,
    CompiledCost,
    Pointer,
    declared_kernel,
    first_contact,
    list_obstacles,
)
from crowdbot.plugins.crowd.cost_functions.van_toll import VanTollSpec

_MAX_DISTANCE = 2  # entry of params


@declared_kernel(BASE)
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    speed = math.hypot(ux, uy)
    if preferred <= 0.0:
        return 0.0 if speed == 0.0 else math.inf
    turn = math.atan2(abs(uy), ux) if speed > 0.0 else 0.0
    return turn + abs(speed - preferred) / preferred


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
    fastest = agent[FASTEST]
    list_obstacles(agent, near, near_count, walls, wall_count, params, work, fastest)
    return 1


@declared_kernel(EXCESS)
def _excess(
    ux: float, uy: float, budget: float, agent: Pointer, work: Pointer, params: Pointer
) -> float:
    vx, vy, way = agent[VX], agent[VY], params[_MAX_DISTANCE]
    speed = math.hypot(ux, uy)
    if speed == 0.0:
        return float(way)
    turn = 0.0
    if vx != 0.0 or vy != 0.0:
        turn = math.atan2(abs(vx * uy - vy * ux), vx * ux + vy * uy)
    if turn > budget:
        return turn
    return float(way - min(way, first_contact(ux, uy, agent, work) * speed) + turn)


def build(spec: VanTollSpec) -> CompiledCost:
    """Compiled functions with this spec's parameters."""
    surface = 1.0 if spec.range.measure == "surface" else 0.0
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        params=np.array([spec.range.value, surface, spec.max_distance]),
        weight=spec.weight,
    )
