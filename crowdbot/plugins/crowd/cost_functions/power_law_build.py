"""PowerLaw as a compiled cost; formulas in docs/reference/crowd/power_law.md."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.support.compile import array_kernel
from crowdbot.plugin import (
    D2,
    NVX,
    NVY,
    NX,
    NY,
    PARITY,
    PREPARE,
    RADIUS,
    REACH,
    RX,
    RY,
    VX,
    VY,
    CompiledCost,
    Pointer,
    declared_kernel,
    in_range,
    near_table,
    wall_table,
)
from crowdbot.plugins.crowd.cost_functions.force_build import (
    aim,
    from_target,
    no_base,
    target,
    to_target,
)
from crowdbot.plugins.crowd.cost_functions.power_law import PowerLawSpec
from crowdbot.plugins.crowd.cost_functions.wall_points_build import counts

_K, _TAU0 = range(2, 4)  # entries of params
_SOONEST = 0.001  # s; collisions sooner than this exert no force


@array_kernel
def _repulsion(
    rx: float, ry: float, wx: float, wy: float, reach: float, params: Pointer
) -> tuple[float, float]:
    """Force per mass by a disc at (rx, ry) that is approached with velocity w."""
    speed2, approach = wx * wx + wy * wy, rx * wx + ry * wy
    gap2 = rx * rx + ry * ry - reach * reach
    root2 = approach * approach - speed2 * gap2
    if gap2 <= 0.0 or root2 <= 0.0 or approach <= 0.0:
        return 0.0, 0.0
    root = math.sqrt(root2)
    t = gap2 / (approach + root)  # (approach - root) / speed2 without cancellation
    if not _SOONEST <= t <= params[_TAU0]:
        return 0.0, 0.0
    decay = params[_K] * math.exp(-t / params[_TAU0])
    size = decay * (2.0 / t + 1.0 / params[_TAU0]) / (speed2 * t * t)
    fx = -size * (wx + (speed2 * rx - approach * wx) / root)
    fy = -size * (wy + (speed2 * ry - approach * wy) / root)
    return fx, fy


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
    """Sum of forces; a wall is its nearest point, which the original has none of."""
    near, segments = near_table(near), wall_table(walls)
    vx, vy, fx, fy = agent[VX], agent[VY], 0.0, 0.0
    for j in range(near_count):
        if in_range(near[j, D2], near[j, REACH], params):
            wx, wy = vx - near[j, NVX], vy - near[j, NVY]
            ax, ay = _repulsion(near[j, RX], near[j, RY], wx, wy, near[j, REACH], params)
            fx, fy = fx + ax, fy + ay
    for s in range(0 if agent[PARITY] != 0.0 else wall_count):
        if counts(s, agent, walls, params):
            ax, ay = _repulsion(segments[s, NX], segments[s, NY], vx, vy, agent[RADIUS], params)
            fx, fy = fx + ax, fy + ay
    return int(aim(fx, fy, agent, work))


def build(spec: PowerLawSpec) -> CompiledCost:
    """Compiled functions with this spec's parameters."""
    surface = 1.0 if spec.range.measure == "surface" else 0.0
    return CompiledCost(
        base=no_base,
        prepare=_prepare,
        excess=from_target,
        gradient=to_target,
        optimum=target,
        params=np.array([spec.range.value, surface, spec.k, spec.tau0]),
        weight=spec.weight,
    )
