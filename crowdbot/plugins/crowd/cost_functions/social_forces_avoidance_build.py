"""SocialForcesAvoidance as a compiled cost.

Formulas in docs/reference/crowd/social_forces_avoidance.md.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.crowd.contact.geometry import opposite_taken_for_parallel
from crowdbot.core.support.compile import array_kernel
from crowdbot.plugin import (
    AX,
    AY,
    BX,
    BY,
    D2,
    NPX,
    NPY,
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
    STATIC,
    VX,
    VY,
    WALL_D2,
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
from crowdbot.plugins.crowd.cost_functions.social_forces_avoidance import SocialForcesAvoidanceSpec
from crowdbot.plugins.crowd.cost_functions.wall_points_build import SAME, counts

_V0, _SIGMA, _U0, _R, _DT, _RELATIVE = range(2, 8)  # entries of params
_CLOSEST = 0.001  # m; nothing nearer exerts a force
_SEEN = math.cos(math.radians(100.0))  # half the field of view


@array_kernel
def _people(agent: Pointer, near: Pointer, j: int, params: Pointer) -> tuple[float, float]:
    """Force per mass by neighbour j: along the line of centres, by the ellipse of its stride."""
    near, parity = near_table(near), agent[PARITY] != 0.0
    xx, xy = -near[j, RX], -near[j, RY]
    distance = math.sqrt(near[j, D2])
    stride, wanted = math.hypot(near[j, NVX], near[j, NVY]), math.hypot(near[j, NPX], near[j, NPY])
    stride *= params[_DT]
    yx = near[j, NPX] / wanted * stride if wanted > 0.0 else 0.0
    yy = near[j, NPY] / wanted * stride if wanted > 0.0 else 0.0
    if params[_RELATIVE] != 0.0:
        yx = (near[j, NVX] - agent[VX]) * params[_DT]
        yy = (near[j, NVY] - agent[VY]) * params[_DT]
        stride = math.hypot(yx, yy)
    moved = math.hypot(xx - yx, xy - yy)
    if distance <= near[j, REACH] or moved == 0.0:
        return 0.0, 0.0
    around = distance + moved
    counted = stride if parity or wanted > 0.0 or params[_RELATIVE] != 0.0 else 0.0
    minor2 = 0.25 * (around * around - counted * counted)
    if minor2 <= 0.0 or math.sqrt(minor2) < _CLOSEST:
        return 0.0, 0.0
    minor = math.sqrt(minor2)
    slope = (distance - (xx * yx + xy * yy) / distance) / moved
    growth = around * (1.0 + slope) / (4.0 * minor)
    size = params[_V0] / params[_SIGMA] * math.exp(-minor / params[_SIGMA]) * growth
    if not parity:
        size /= distance
    speed = math.hypot(agent[VX], agent[VY])
    behind = speed > 0.0 and -(agent[VX] * xx + agent[VY] * xy) <= _SEEN * speed * distance
    if behind and not (parity and opposite_taken_for_parallel(agent[VX], agent[VY], -xx, -xy)):
        size *= 0.5
    return size * xx, size * xy


@array_kernel
def _wall(
    yx: float, yy: float, distance: float, parity: bool, params: Pointer
) -> tuple[float, ...]:
    """Force per mass by a wall point; y leads from it to the agent."""
    if distance < _CLOSEST:
        return 0.0, 0.0
    size = params[_U0] / params[_R] * math.exp(-distance / params[_R])
    if not parity:
        size /= distance
    return size * yx, size * yy


@array_kernel
def _faces(s: int, agent: Pointer, walls: Pointer, params: Pointer) -> bool:
    """Whether the original counts edge s: seen from outside, and not nearest at its second end."""
    table = wall_table(walls)
    ax, ay, bx, by = table[s, AX], table[s, AY], table[s, BX], table[s, BY]
    outside = ax * (by - ay) - ay * (bx - ax) <= 0.0
    # The nearest point was worked out along the segment, so that its end is met but for rounding.
    second = abs(table[s, NX] - bx) <= SAME and abs(table[s, NY] - by) <= SAME
    return bool(outside and not second and in_range(table[s, WALL_D2], agent[RADIUS], params))


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
    """Sum of forces; pillars push like walls."""
    table, segments = near_table(near), wall_table(walls)
    parity, fx, fy = agent[PARITY] != 0.0, 0.0, 0.0
    for j in range(near_count):
        if not in_range(table[j, D2], table[j, REACH], params):
            continue
        if table[j, STATIC] != 0.0:
            centre = math.sqrt(table[j, D2])
            surface = centre - (table[j, REACH] - agent[RADIUS])
            scale = -surface / centre if centre > 0.0 else 0.0
            push = _wall(scale * table[j, RX], scale * table[j, RY], surface, parity, params)
        else:
            push = _people(agent, near, j, params)
        fx, fy = fx + push[0], fy + push[1]
    for s in range(wall_count):
        if _faces(s, agent, walls, params) if parity else counts(s, agent, walls, params):
            distance = math.sqrt(segments[s, WALL_D2])
            push = _wall(-segments[s, NX], -segments[s, NY], distance, parity, params)
            fx, fy = fx + push[0], fy + push[1]
    return int(aim(fx, fy, agent, work))


def build(spec: SocialForcesAvoidanceSpec) -> CompiledCost:
    """Compiled functions with this spec's parameters."""
    surface = 1.0 if spec.range.measure == "surface" else 0.0
    relative = 1.0 if spec.stride == "relative" else 0.0
    own = [spec.v0, spec.sigma, spec.u0, spec.r, spec.dt, relative]
    return CompiledCost(
        base=no_base,
        prepare=_prepare,
        excess=from_target,
        gradient=to_target,
        optimum=target,
        params=np.array([spec.range.value, surface, *own]),
        weight=spec.weight,
    )
