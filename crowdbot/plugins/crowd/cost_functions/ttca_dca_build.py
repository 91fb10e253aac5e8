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

from crowdbot.plugin import (
    BASE,
    EXCESS,
    LOWER_BOUND,
    CompiledCost,
    Pointer,
    declared_kernel,
    work_table,
)
from crowdbot.plugins.crowd.cost_functions.ttca_dca import TtcaDcaSpec
from crowdbot.plugins.crowd.cost_functions.ttca_dca_gradient_build import gradient
from crowdbot.plugins.crowd.cost_functions.ttca_dca_neighbours_build import prepare
from crowdbot.plugins.crowd.cost_functions.ttca_dca_params_build import (
    INV_DCA2,
    INV_TTCA2,
    NEGLIGIBLE,
    SIGMA_ANGLE,
    SIGMA_SPEED,
    TOTAL,
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
        prepare=prepare,
        excess=_excess,
        gradient=gradient,
        lower_bound=_lower_bound,
        params=np.array(params),
        weight=spec.weight,
    )
