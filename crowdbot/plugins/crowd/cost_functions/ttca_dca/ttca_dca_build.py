"""TtcaDca as a compiled cost.

With d the vector to a neighbour, R the sum of radii, w its velocity relative to the candidate:
q = d (|d| - R) / |d|, n = (-d_y, d_x), w' = w + n (n . w), t = max(0, -q . w' / |w'|^2),
D = |q + t w'|, E = exp(-((t / sigma_t)^2 + (D / sigma_d)^2) / 2), k = 1 / (|d| - R)^2.
Excess: sum(k E) / sum(k). Base: 1 - (exp(-(a / sigma_a)^2 / 2) + exp(-(s / sigma_s)^2 / 2)) / 2
with a the angle to the preferred velocity and s the difference in speed.
"""

from __future__ import annotations

import math

from crowdbot.plugin import (
    BASE,
    EXCESS,
    LOWER_BOUND,
    AgentRecord,
    CompiledCost,
    Pointer,
    as_record,
    as_rows,
    declared_kernel,
    record_values,
)
from crowdbot.plugins.crowd.cost_functions.ttca_dca.gradient_build import gradient
from crowdbot.plugins.crowd.cost_functions.ttca_dca.neighbours_build import prepare
from crowdbot.plugins.crowd.cost_functions.ttca_dca.records_build import (
    HEADER,
    NEGLIGIBLE,
    NEIGHBOUR,
    PARAMS,
)
from crowdbot.plugins.crowd.cost_functions.ttca_dca.ttca_dca import TtcaDcaSpec

_HEAVIEST = 2  # neighbours used in lower bounds
_TINY = 1e-300


@declared_kernel(BASE)
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    own = as_record(params, PARAMS)
    angle = abs(math.atan2(uy, ux)) if ux != 0.0 or uy != 0.0 else 0.0
    slower = (math.sqrt(ux * ux + uy * uy) - preferred) / own.sigma_speed
    ahead = math.exp(-0.5 * (angle / own.sigma_angle) ** 2)
    return 1.0 - 0.5 * (ahead + math.exp(-0.5 * slower * slower))


@declared_kernel(EXCESS)
def _excess(
    ux: float, uy: float, budget: float, agent: AgentRecord, work: Pointer, params: Pointer
) -> float:
    own, header = as_record(params, PARAMS), as_record(work, HEADER)
    rows, cost, most = as_rows(work, NEIGHBOUR), 0.0, budget * header.total
    for j in range(1, int(header.count) + 1):
        near = rows[j]
        dx, dy, qx, qy = near.dx, near.dy, near.qx, near.qy
        wx, wy = near.vx - ux, near.vy - uy
        across = dx * wy - dy * wx
        wx, wy = wx - dy * across, wy + dx * across
        speed2 = wx * wx + wy * wy
        towards = -(qx * wx + qy * wy)
        t = towards / speed2 if towards > 0.0 and speed2 > 0.0 else 0.0
        cx, cy = qx + t * wx, qy + t * wy
        exponent = t * t * own.inv_ttca2 + (cx * cx + cy * cy) * own.inv_dca2
        if exponent < NEGLIGIBLE:
            cost += near.weight * math.exp(-0.5 * exponent)
            if cost > most:
                break
    return float(cost / header.total)


@declared_kernel(LOWER_BOUND)
def _lower_bound(
    count: int,
    ux: Pointer,
    uy: Pointer,
    agent: AgentRecord,
    work: Pointer,
    params: Pointer,
    out: Pointer,
) -> int:
    """Return a lower bound: terms of the heaviest neighbours, with an eighth power instead of exp.

    exp(-y) >= 1 - y + y^2 / 2 - y^3 / 6 for y >= 0.
    """
    own, header, rows = as_record(params, PARAMS), as_record(work, HEADER), as_rows(work, NEIGHBOUR)
    a, b = own.inv_ttca2, own.inv_dca2
    for c in range(count):
        out[c] = 0.0
    for j in range(1, min(_HEAVIEST, int(header.count)) + 1):
        near = rows[j]
        dx, dy, qx, qy = near.dx, near.dy, near.qx, near.qy
        vx, vy, weight = near.vx, near.vy, near.weight / header.total
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
    """Return the compiled functions with this spec's parameters."""
    params = record_values(
        PARAMS,
        **spec.range.cost_params(),
        inv_ttca2=1.0 / spec.sigma_ttca**2,
        inv_dca2=1.0 / spec.sigma_dca**2,
        sigma_angle=spec.sigma_angle_goal,
        sigma_speed=spec.sigma_speed_goal,
        walls=float(spec.walls),
    )
    return CompiledCost(
        base=_base,
        prepare=prepare,
        excess=_excess,
        gradient=gradient,
        lower_bound=_lower_bound,
        params=params,
        weight=spec.weight,
        wall_reach=None if spec.walls else (0.0, 0.0),
    )
