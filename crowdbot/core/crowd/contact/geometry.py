"""Discs and wall segments: nearest points and times to contact."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.support.compiling.compile import kernel

#: A contact farther than this from the ends of a segment clearly comes before one with an end, m.
_CORNER = 0.01


@kernel
def is_clearly_shorter(x: float, y: float, length: float) -> bool:
    """Return True if a vector is shorter than ``length`` in spite of rounding."""
    return x * x + y * y < (1.0 - 1e-12) * length * length


@kernel
def is_clearly_longer(x: float, y: float, length: float) -> bool:
    """Return True if a vector is longer than ``length`` in spite of rounding."""
    return x * x + y * y > (1.0 + 1e-12) * length * length


@kernel
def nearest_on_segment(
    px: float, py: float, ax: float, ay: float, bx: float, by: float
) -> tuple[float, float]:
    """Return the point of segment a-b nearest to p."""
    ex, ey = bx - ax, by - ay
    length2 = ex * ex + ey * ey
    s = 0.0
    if length2 > 0.0:
        s = min(1.0, max(0.0, ((px - ax) * ex + (py - ay) * ey) / length2))
    return ax + s * ex, ay + s * ey


@kernel
def time_to_disc(rx: float, ry: float, vx: float, vy: float, gap2: float) -> float:
    """Return the time until a disc with relative velocity v touches another; inf if never.

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
    return gap2 / (approach + math.sqrt(root))  # the form of the smaller root without cancellation


@kernel
def time_to_segment(
    vx: float, vy: float, radius: float, ax: float, ay: float, bx: float, by: float
) -> float:
    """Return the time until a disc at the origin with velocity v touches segment a-b; inf if never.

    The disc must not touch the segment yet.
    """
    sx, sy = bx - ax, by - ay
    cross, first = vx * sy - vy * sx, math.inf
    if not abs(cross) < 1e-5:  # not parallel
        # On contact, the touched point of the line is level with the centre.
        length = math.hypot(sx, sy)
        t = (ax * sy - ay * sx) / cross - radius * length / abs(cross)
        along, whole = (vx * t - ax) * sx + (vy * t - ay) * sy, sx * sx + sy * sy
        if t >= 0.0 and 0.0 <= along <= whole:
            if _CORNER * length < along < whole - _CORNER * length:
                return t  # the ends are touched later, in spite of rounding
            first = t
    for ex, ey in ((ax, ay), (bx, by)):
        first = min(first, time_to_disc(ex, ey, vx, vy, ex * ex + ey * ey - radius * radius))
    return first


@kernel
def crossing_time(
    vx: float, vy: float, radius: float, ax: float, ay: float, bx: float, by: float
) -> float:
    """Return the time as `time_to_segment`, computed like the original engine.

    There the interior of a segment counts if the centre will cross it, not the point of contact.
    """
    first = math.inf
    for ex, ey in ((ax, ay), (bx, by)):
        first = min(first, time_to_disc(ex, ey, vx, vy, ex * ex + ey * ey - radius * radius))
    sx, sy = bx - ax, by - ay
    cross = vx * sy - vy * sx
    if abs(cross) < 1e-5:
        return first
    t = (ax * sy - ay * sx) / cross
    along = (vx * t - ax) * sx + (vy * t - ay) * sy
    if t >= 0.0 and 0.0 <= along <= sx * sx + sy * sy:
        first = min(first, max(0.0, t - radius * math.hypot(sx, sy) / abs(cross)))
    return first


@kernel
def single_angle(ax: float, ay: float, bx: float, by: float) -> float:
    """Return the angle between two vectors in [0, pi] with the original engine's rounding.

    In single precision; 0 if a vector vanishes or rounding puts the cosine outside [-1, 1].
    """
    ax32, ay32, bx32, by32 = np.float32(ax), np.float32(ay), np.float32(bx), np.float32(by)
    dot = np.float32(np.float32(ax32 * bx32) + np.float32(ay32 * by32))
    a = np.float32(np.sqrt(np.float32(np.float32(ax32 * ax32) + np.float32(ay32 * ay32))))
    b = np.float32(np.sqrt(np.float32(np.float32(bx32 * bx32) + np.float32(by32 * by32))))
    lengths = np.float32(a * b)
    if lengths == np.float32(0.0):
        return 0.0
    cosine = float(np.float32(dot / lengths))
    return float(np.float32(math.acos(cosine))) if -1.0 <= cosine <= 1.0 else 0.0


@kernel
def opposite_taken_for_parallel(ax: float, ay: float, bx: float, by: float) -> bool:
    """Return True if the original engine's rounding gives angle 0 for two opposite vectors."""
    return ax * bx + ay * by < 0.0 and single_angle(ax, ay, bx, by) == 0.0
