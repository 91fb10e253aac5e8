"""Discs and wall segments: nearest points and times to contact."""

from __future__ import annotations

import math

from numba import njit


@njit(cache=True, error_model="numpy")
def nearest_on_segment(
    px: float, py: float, ax: float, ay: float, bx: float, by: float
) -> tuple[float, float]:
    """Point of segment a-b nearest to p."""
    ex, ey = bx - ax, by - ay
    length2 = ex * ex + ey * ey
    s = 0.0
    if length2 > 0.0:
        s = min(1.0, max(0.0, ((px - ax) * ex + (py - ay) * ey) / length2))
    return ax + s * ex, ay + s * ey


@njit(cache=True, error_model="numpy")
def time_to_disc(rx: float, ry: float, vx: float, vy: float, gap2: float) -> float:
    """Time until a disc that moves at v relative to another touches it; inf if never.

    Args:
        rx, ry: centre of the other disc minus own centre, m.
        vx, vy: own velocity minus the other's, m/s.
        gap2: squared distance minus squared sum of radii, m^2; must be positive.
    """
    approach = rx * vx + ry * vy
    speed2 = vx * vx + vy * vy
    root = approach * approach - speed2 * gap2
    if approach <= 0.0 or root <= 0.0:
        return math.inf
    return gap2 / (approach + math.sqrt(root))  # the cancellation-free form of the smaller root


@njit(cache=True, error_model="numpy")
def time_to_segment(
    px: float,
    py: float,
    vx: float,
    vy: float,
    radius: float,
    ax: float,
    ay: float,
    bx: float,
    by: float,
) -> float:
    """Time until a disc at p with velocity v touches segment a-b; 0 if it does already."""
    nx, ny = nearest_on_segment(px, py, ax, ay, bx, by)
    distance2 = (px - nx) ** 2 + (py - ny) ** 2
    if distance2 <= radius * radius:
        return 0.0
    first = math.inf
    for ex, ey in ((ax, ay), (bx, by)):
        gap2 = (ex - px) ** 2 + (ey - py) ** 2 - radius * radius
        first = min(first, time_to_disc(ex - px, ey - py, vx, vy, gap2))
    sx, sy = bx - ax, by - ay
    length = math.hypot(sx, sy)
    if length == 0.0:
        return first
    height = ((px - ax) * sy - (py - ay) * sx) / length  # signed distance to the line
    towards = -(vx * sy - vy * sx) / length * math.copysign(1.0, height)
    if towards * length <= 1e-5:
        return first
    t_centre = abs(height) / towards
    along = ((px + vx * t_centre - ax) * sx + (py + vy * t_centre - ay) * sy) / (length * length)
    if 0.0 <= along <= 1.0:
        first = min(first, max(0.0, (abs(height) - radius) / towards))
    return first
