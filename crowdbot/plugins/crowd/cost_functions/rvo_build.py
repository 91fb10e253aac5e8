"""RVO as a compiled cost: ``w / T(2u - v) + |u - v_preferred|``, T the first collision time."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.support.compile import array_kernel
from crowdbot.plugin import (
    ASKED_RADIUS,
    ASKED_X,
    ASKED_Y,
    BASE,
    EXCESS,
    FASTEST,
    LOWER_BOUND,
    MAX_SPEED,
    PARITY,
    PREPARE,
    VX,
    VY,
    CompiledCost,
    Pointer,
    declared_kernel,
    first_collision,
    list_approaching,
    soonest_disc,
)
from crowdbot.plugins.crowd.cost_functions.rvo import RvoSpec

_W = 2  # entry of params
#: Later than any collision but one that never comes, s.
_EVER = 1e300
_ROUNDING = 1.0 + 1e-6


@array_kernel
def _too_fast(ux: float, uy: float, max_speed: float) -> bool:
    """In single precision, which decides about candidates at exactly the largest speed."""
    x, y = np.float32(ux), np.float32(uy)
    speed = np.float32(np.sqrt(np.float32(np.float32(x * x) + np.float32(y * y))))
    return bool(speed > np.float32(max_speed))


@declared_kernel(BASE)
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    if ux * ux + uy * uy > (max_speed * _ROUNDING) ** 2:
        return math.inf
    ahead = ux - preferred
    return math.sqrt(ahead * ahead + uy * uy)


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
    # Of 2u - v.
    ux, uy = 2.0 * agent[ASKED_X] - agent[VX], 2.0 * agent[ASKED_Y] - agent[VY]
    # The second term is for rounding, where the sum of two sides does as well as the length.
    spread = 2.0 * agent[ASKED_RADIUS] + 1e-9 * (agent[FASTEST] + abs(ux) + abs(uy))
    items = list_approaching(
        agent, near, near_count, walls, wall_count, params, work, ux, uy, spread, _EVER
    )
    return max(items, 1) if agent[PARITY] != 0.0 else items


@declared_kernel(EXCESS)
def _excess(
    ux: float, uy: float, budget: float, agent: Pointer, work: Pointer, params: Pointer
) -> float:
    if agent[PARITY] != 0.0 and _too_fast(ux, uy, agent[MAX_SPEED]):
        return math.inf
    too_soon = params[_W] / budget if budget > 0.0 else math.inf
    vx, vy = 2.0 * ux - agent[VX], 2.0 * uy - agent[VY]
    return float(params[_W] / first_collision(vx, vy, too_soon, agent, work))


@declared_kernel(LOWER_BOUND)
def _lower_bound(
    count: int,
    ux: Pointer,
    uy: Pointer,
    agent: Pointer,
    work: Pointer,
    params: Pointer,
    out: Pointer,
) -> int:
    """Without walls."""
    soonest_disc(count, ux, uy, 2.0, agent[VX], agent[VY], work, out)
    for c in range(count):
        out[c] *= params[_W]
    return 1


def build(spec: RvoSpec) -> CompiledCost:
    """Compile-time functions with this spec's parameters."""
    surface = 1.0 if spec.range.measure == "surface" else 0.0
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        lower_bound=_lower_bound,
        params=np.array([spec.range.value, surface, spec.w]),
        weight=spec.weight,
    )
