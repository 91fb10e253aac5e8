"""TtcaDca as a compiled cost.

With d the vector to a neighbour, R the sum of radii, w its velocity relative to the candidate:
q = d (|d| - R) / |d|, n = (-d_y, d_x), w' = w + n (n . w), t = max(0, -q . w' / |w'|^2),
D = |q + t w'|, E = exp(-((t / sigma_t)^2 + (D / sigma_d)^2) / 2), k = 1 / (|d| - R)^2.
Excess: sum(k E) / sum(k). Base: 1 - (exp(-(a / sigma_a)^2 / 2) + exp(-(s / sigma_s)^2 / 2)) / 2
with a the angle to the preferred velocity and s the difference in speed.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from crowdbot.core.crowd.cost import (
    BASE,
    D2,
    EXCESS,
    FASTEST,
    FROM_SURFACE,
    NVX,
    NVY,
    PREPARE,
    RANGE,
    REACH,
    RX,
    RY,
    VX,
    VY,
    CompiledCost,
    Pointer,
    near_table,
    work_table,
)
from crowdbot.plugins.crowd.ttca_dca import TtcaDcaSpec

_INV_TTCA2, _INV_DCA2, _SIGMA_ANGLE, _SIGMA_SPEED = range(2, 6)  # entries of params
_NEGLIGIBLE = 90.0  # exp(-45) of a cost of order one is below double precision
_CLOSEST = 1e-6  # gaps and distances below this count as this, m
_WEIGHT = 6  # column of work


@njit(BASE, cache=True, error_model="numpy")
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    angle = abs(math.atan2(uy, ux)) if ux != 0.0 or uy != 0.0 else 0.0
    slower = (math.hypot(ux, uy) - preferred) / params[_SIGMA_SPEED]
    ahead = math.exp(-0.5 * (angle / params[_SIGMA_ANGLE]) ** 2)
    return 1.0 - 0.5 * (ahead + math.exp(-0.5 * slower * slower))


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
    """Row 0: number of neighbours. Then d, q, v_j, k / sum(k), heaviest first."""
    near, work = near_table(near), work_table(work)
    total, count = 0.0, 0
    for j in range(near_count):
        rx, ry, reach = near[j, RX], near[j, RY], near[j, REACH]
        limit = params[RANGE] + params[FROM_SURFACE] * reach
        if near[j, D2] >= limit * limit or rx * agent[VX] + ry * agent[VY] < 0.0:
            continue  # out of range, or behind
        distance = max(math.sqrt(near[j, D2]), _CLOSEST)
        gap = distance - reach
        weight = 1.0 / max(gap * gap, _CLOSEST * _CLOSEST)
        total += weight
        # The exponent is at least this for every candidate: the gap closes at most at `closing`.
        closing = agent[FASTEST] + max(0.0, -(near[j, NVX] * rx + near[j, NVY] * ry) / distance)
        a, b = params[_INV_TTCA2], params[_INV_DCA2]
        if gap > 0.0 and gap * gap * a * b >= _NEGLIGIBLE * (a + b * closing * closing):
            continue
        count += 1
        row = count
        while row > 1 and work[row - 1, _WEIGHT] < weight:
            for c in range(7):
                work[row, c] = work[row - 1, c]
            row -= 1
        shrink = gap / distance
        work[row, 0], work[row, 1] = rx, ry
        work[row, 2], work[row, 3] = rx * shrink, ry * shrink
        work[row, 4], work[row, 5] = near[j, NVX], near[j, NVY]
        work[row, _WEIGHT] = weight
    for row in range(1, count + 1):
        work[row, _WEIGHT] /= total
    work[0, 0] = count
    return count


@njit(EXCESS, cache=True, error_model="numpy")
def _excess(
    ux: float, uy: float, budget: float, agent: Pointer, work: Pointer, params: Pointer
) -> float:
    work = work_table(work)
    cost = 0.0
    for j in range(1, int(work[0, 0]) + 1):
        dx, dy, qx, qy = work[j, 0], work[j, 1], work[j, 2], work[j, 3]
        wx, wy = work[j, 4] - ux, work[j, 5] - uy
        across = dx * wy - dy * wx
        wx, wy = wx - dy * across, wy + dx * across
        speed2 = wx * wx + wy * wy
        towards = -(qx * wx + qy * wy)
        t = towards / speed2 if towards > 0.0 and speed2 > 0.0 else 0.0
        cx, cy = qx + t * wx, qy + t * wy
        exponent = t * t * params[_INV_TTCA2] + (cx * cx + cy * cy) * params[_INV_DCA2]
        if exponent < _NEGLIGIBLE:
            cost += work[j, _WEIGHT] * math.exp(-0.5 * exponent)
            if cost > budget:
                break
    return cost


def build(spec: TtcaDcaSpec) -> CompiledCost:
    """Compile-time functions with this spec's parameters."""
    params = [
        spec.range.value,
        1.0 if spec.range.measure == "surface" else 0.0,
        1.0 / spec.sigma_ttca**2,
        1.0 / spec.sigma_dca**2,
        spec.sigma_angle_goal,
        spec.sigma_speed_goal,
    ]
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        params=np.array(params),
        weight=spec.weight,
    )
