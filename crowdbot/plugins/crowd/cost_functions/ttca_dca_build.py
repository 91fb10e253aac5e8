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

from crowdbot.core.crowd.contact.geometry import opposite_taken_for_parallel
from crowdbot.core.interfaces import (
    BASE,
    D2,
    DESCENDS,
    EXCESS,
    FASTEST,
    FROM_SURFACE,
    LOWER_BOUND,
    NVX,
    NVY,
    NX,
    NY,
    PARITY,
    PREPARE,
    RADIUS,
    RANGE,
    REACH,
    RX,
    RY,
    VX,
    VY,
    WALL_D2,
    CompiledCost,
    Pointer,
    near_table,
    wall_table,
    work_table,
)
from crowdbot.core.support.compile import declared_kernel, inline_kernel
from crowdbot.plugins.crowd.cost_functions.ttca_dca import TtcaDcaSpec
from crowdbot.plugins.crowd.cost_functions.ttca_dca_gradient_build import gradient
from crowdbot.plugins.crowd.cost_functions.ttca_dca_params_build import (
    CLOSEST,
    INV_DCA2,
    INV_TTCA2,
    NEGLIGIBLE,
    SIGMA_ANGLE,
    SIGMA_SPEED,
    TOTAL,
    WALLS,
    WEIGHT,
)

_HEAVIEST = 2  # neighbours in lower bounds
_TINY = 1e-300


@declared_kernel(BASE)
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    angle = abs(math.atan2(uy, ux)) if ux != 0.0 or uy != 0.0 else 0.0
    slower = (math.sqrt(ux * ux + uy * uy) - preferred) / params[SIGMA_SPEED]
    ahead = math.exp(-0.5 * (angle / params[SIGMA_ANGLE]) ** 2)
    return 1.0 - 0.5 * (ahead + math.exp(-0.5 * slower * slower))


@inline_kernel
def _add(
    rx: float,
    ry: float,
    vx: float,
    vy: float,
    d2: float,
    reach: float,
    agent: Pointer,
    params: Pointer,
    work: Pointer,
) -> None:
    """Add a neighbour to the table, unless it is behind or changes no sum."""
    ahead = rx * agent[VX] + ry * agent[VY] >= 0.0
    if not ahead and agent[PARITY] != 0.0:
        ahead = opposite_taken_for_parallel(rx, ry, agent[VX], agent[VY])
    if ahead:
        distance = max(math.sqrt(d2), CLOSEST)
        gap = distance - reach
        weight = 1.0 / max(gap * gap, CLOSEST * CLOSEST)
        work[0, TOTAL] += weight
        # The exponent is at least this for every candidate: the gap closes at most at `closing`.
        closing = agent[FASTEST] + max(0.0, -(vx * rx + vy * ry) / distance)
        a, b = params[INV_TTCA2], params[INV_DCA2]
        nothing = gap > 0.0 and gap * gap * a * b >= NEGLIGIBLE * (a + b * closing * closing)
        if agent[DESCENDS] != 0.0 or not nothing:
            row = int(work[0, 0]) + 1
            work[0, 0] = row
            if agent[DESCENDS] == 0.0:
                while row > 1 and work[row - 1, WEIGHT] < weight:
                    for c in range(7):
                        work[row, c] = work[row - 1, c]
                    row -= 1
            shrink = gap / distance
            work[row, 0], work[row, 1] = rx, ry
            work[row, 2], work[row, 3] = rx * shrink, ry * shrink
            work[row, 4], work[row, 5] = vx, vy
            work[row, WEIGHT] = weight


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
    """Row 0: number of neighbours, sum(k). Then d, q, v_j, k, heaviest first."""
    near, walls, work = near_table(near), wall_table(walls), work_table(work)
    work[0, 0], work[0, TOTAL] = 0.0, 0.0
    for j in range(near_count):
        reach = near[j, REACH]
        limit = params[RANGE] + params[FROM_SURFACE] * reach
        if near[j, D2] < limit * limit:
            _add(
                near[j, RX], near[j, RY], near[j, NVX], near[j, NVY], near[j, D2], reach,
                agent, params, work,
            )  # fmt: skip
    if params[WALLS] != 0.0:
        limit = params[RANGE] + params[FROM_SURFACE] * agent[RADIUS]
        for s in range(wall_count):
            if walls[s, WALL_D2] < limit * limit:
                _add(
                    walls[s, NX], walls[s, NY], 0.0, 0.0, walls[s, WALL_D2], agent[RADIUS],
                    agent, params, work,
                )  # fmt: skip
    return int(work[0, 0])


@declared_kernel(EXCESS)
def _excess(
    ux: float, uy: float, budget: float, agent: Pointer, work: Pointer, params: Pointer
) -> float:
    work = work_table(work)
    cost, most = 0.0, budget * work[0, TOTAL]
    for j in range(1, int(work[0, 0]) + 1):
        dx, dy, qx, qy = work[j, 0], work[j, 1], work[j, 2], work[j, 3]
        wx, wy = work[j, 4] - ux, work[j, 5] - uy
        across = dx * wy - dy * wx
        wx, wy = wx - dy * across, wy + dx * across
        speed2 = wx * wx + wy * wy
        towards = -(qx * wx + qy * wy)
        t = towards / speed2 if towards > 0.0 and speed2 > 0.0 else 0.0
        cx, cy = qx + t * wx, qy + t * wy
        exponent = t * t * params[INV_TTCA2] + (cx * cx + cy * cy) * params[INV_DCA2]
        if exponent < NEGLIGIBLE:
            cost += work[j, WEIGHT] * math.exp(-0.5 * exponent)
            if cost > most:
                break
    return float(cost / work[0, TOTAL])


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
    """The terms of the heaviest neighbours, with an eighth power in place of exp.

    exp(-y) >= 1 - y + y^2 / 2 - y^3 / 6 for y >= 0.
    """
    work = work_table(work)
    a, b = params[INV_TTCA2], params[INV_DCA2]
    for c in range(count):
        out[c] = 0.0
    for j in range(1, min(_HEAVIEST, int(work[0, 0])) + 1):
        dx, dy, qx, qy = work[j, 0], work[j, 1], work[j, 2], work[j, 3]
        vx, vy, weight = work[j, 4], work[j, 5], work[j, WEIGHT] / work[0, TOTAL]
        for c in range(count):
            wx, wy = vx - ux[c], vy - uy[c]
            across = dx * wy - dy * wx
            wx, wy = wx - dy * across, wy + dx * across
            towards = -(qx * wx + qy * wy)
            t = max(0.0, towards) / max(_TINY, wx * wx + wy * wy)
            cx, cy = qx + t * wx, qy + t * wy
            y = (t * t * a + (cx * cx + cy * cy) * b) / 16.0
            part = max(0.0, 1.0 - y * (1.0 - y * (0.5 - y / 6.0)))
            part *= part
            part *= part
            out[c] += weight * (part * part)
    return 1


def build(spec: TtcaDcaSpec) -> CompiledCost:
    """Compile-time functions with this spec's parameters."""
    params = [
        spec.range.value,
        1.0 if spec.range.measure == "surface" else 0.0,
        1.0 / spec.sigma_ttca**2,
        1.0 / spec.sigma_dca**2,
        spec.sigma_angle_goal,
        spec.sigma_speed_goal,
        float(spec.walls),
    ]
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        gradient=gradient,
        lower_bound=_lower_bound,
        params=np.array(params),
        weight=spec.weight,
    )
