"""The gradient for TtcaDca: turning and changing speed, as in Dutra et al.

It is not the derivative of the cost: the paper follows the derivatives along heading and speed of
the velocity relative to each neighbour, and this does the same, as the original engine does.
"""

from __future__ import annotations

import math

from crowdbot.plugin import (
    GRADIENT,
    AgentRecord,
    Pointer,
    array_kernel,
    as_record,
    as_rows,
    declared_kernel,
)
from crowdbot.plugins.crowd.cost_functions.ttca_dca.records_build import (
    HEADER,
    NEGLIGIBLE,
    NEIGHBOUR,
    PARAMS,
)

_STILL = 1e-3  # treated as zero: relative speeds squared (m^2/s^2), times (s), distances (m)


@array_kernel
def _by_neighbours(ux: float, uy: float, work: Pointer, params: Pointer) -> tuple[float, float]:
    own, header, rows = as_record(params, PARAMS), as_record(work, HEADER), as_rows(work, NEIGHBOUR)
    by_time, by_distance = own.inv_ttca2, own.inv_dca2
    turning = speeding = total = 0.0
    for j in range(1, int(header.count) + 1):
        near = rows[j]
        dx, dy, qx, qy = near.dx, near.dy, near.qx, near.qy
        wx, wy = near.vx - ux, near.vy - uy
        across = dx * wy - dy * wx
        wx, wy = wx - dy * across, wy + dx * across
        speed2 = wx * wx + wy * wy
        if speed2 <= _STILL:
            continue
        total += near.weight
        t = max(0.0, -(qx * wx + qy * wy) / speed2)
        cx, cy = qx + t * wx, qy + t * wy
        distance2 = cx * cx + cy * cy
        exponent = t * t * by_time + distance2 * by_distance
        if exponent >= NEGLIGIBLE:
            continue
        rate = 1.0 / math.sqrt(speed2)
        ex, ey = wx * rate, wy * rate
        t_turn = t_speed = d_turn = d_speed = 0.0
        if t > _STILL:
            fx, fy = qx + 2.0 * t * wx, qy + 2.0 * t * wy
            t_turn = -(fx * wy - fy * wx) / speed2
            t_speed = (fx * ex + fy * ey) / speed2
        if distance2 > _STILL * _STILL:  # times the distance, which cancels out
            d_turn = cx * (t_turn * wx + t * wy) + cy * (t_turn * wy - t * wx)
            d_speed = cx * (t_speed * wx - t * ex) + cy * (t_speed * wy - t * ey)
        factor = near.weight * math.exp(-0.5 * exponent)
        turning -= factor * (t_turn * t * by_time + d_turn * by_distance)
        speeding -= factor * (t_speed * t * by_time + d_speed * by_distance)
    if total > 0.0:
        turning, speeding = turning / total, speeding / total
    return turning, speeding


@declared_kernel(GRADIENT)
def gradient(
    ux: float, uy: float, agent: AgentRecord, work: Pointer, params: Pointer, out: Pointer
) -> int:
    """Write the derivatives along heading and speed, then along x and y."""
    own = as_record(params, PARAMS)
    turning, speeding = _by_neighbours(ux, uy, work, params)
    preferred, speed = agent.preferred, math.sqrt(ux * ux + uy * uy)
    angle = 0.0
    if speed > 0.0:
        across = ux * agent.pvy - uy * agent.pvx
        angle = math.atan2(across, ux * agent.pvx + uy * agent.pvy)
    inv = 1.0 / own.sigma_angle**2
    turning += 0.5 * angle * inv * math.exp(-0.5 * angle * angle * inv)
    faster, inv = speed - preferred, 1.0 / own.sigma_speed**2
    speeding += 0.5 * faster * inv * math.exp(-0.5 * faster * faster * inv)
    if speed * speed < 0.01:
        ex, ey, speed = agent.pvx / preferred, agent.pvy / preferred, preferred
    else:
        ex, ey = ux / speed, uy / speed
    a = speed * math.sin(turning)
    b = speed * (1.0 - math.cos(turning)) + speeding
    out[0], out[1] = ey * a + ex * b, ey * b - ex * a
    return 1
