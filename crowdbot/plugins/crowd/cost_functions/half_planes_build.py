"""The best velocity in a disc under linear constraints a . u >= c, by incremental search.

Source of the method: Seidel, "Small-dimensional linear programming and convex hulls made easy",
1991; its use and the least-violation problem: van den Berg et al., ISRR 2009, section 5.

Constraints are those of the half-planes n . u >= c in ``work``, two in a row, or their
differences: with a pivot i, "plane j is violated no more than plane i".
"""

from __future__ import annotations

import math

from crowdbot.plugin import (
    Pointer,
    array_kernel,
)

_PARALLEL = 1e-10


@array_kernel
def put(work: Pointer, k: int, nx: float, ny: float, c: float) -> None:
    """Write half-plane k to ``work``; rows have eight columns, row 0 is reserved."""
    at = 8 + 4 * k
    work[at], work[at + 1], work[at + 2] = nx, ny, c


@array_kernel
def violation(work: Pointer, k: int, ux: float, uy: float) -> float:
    """Return how far velocity u is outside half-plane k, m/s."""
    at = 8 + 4 * k
    return float(work[at + 2] - work[at] * ux - work[at + 1] * uy)


@array_kernel
def _constraint(work: Pointer, j: int, pivot: int) -> tuple[float, float, float]:
    at = 8 + 4 * j
    ax, ay, c = work[at], work[at + 1], work[at + 2]
    if pivot >= 0:
        at = 8 + 4 * pivot
        ax, ay, c = ax - work[at], ay - work[at + 1], c - work[at + 2]
    return ax, ay, c


@array_kernel
def _on_border(
    work: Pointer, i: int, pivot: int, speed: float, gx: float, gy: float, furthest: bool
) -> tuple[bool, float, float]:
    """Return the best point on the border of constraint i under the earlier ones, if any."""
    ax, ay, c = _constraint(work, i, pivot)
    length = math.hypot(ax, ay)
    if length <= _PARALLEL:
        return False, 0.0, 0.0
    ax, ay, c = ax / length, ay / length, c / length
    half2 = speed * speed - c * c
    if half2 < 0.0:
        return False, 0.0, 0.0
    px, py, tx, ty = c * ax, c * ay, -ay, ax
    high = math.sqrt(half2)
    low = -high
    for j in range(i):
        bx, by, d = _constraint(work, j, pivot)
        slope, rest = bx * tx + by * ty, d - bx * px - by * py
        if abs(slope) <= _PARALLEL:
            if rest > _PARALLEL and (pivot < 0 or math.hypot(bx, by) > _PARALLEL):
                return False, 0.0, 0.0
        elif slope > 0.0:
            low = max(low, rest / slope)
        else:
            high = min(high, rest / slope)
        if low > high:
            return False, 0.0, 0.0
    along = gx * tx + gy * ty
    nearest = min(high, max(low, along))
    s = (high if along > 0.0 else low) if furthest else nearest
    return True, px + s * tx, py + s * ty


@array_kernel
def _search(
    work: Pointer, count: int, pivot: int, speed: float, gx: float, gy: float, furthest: bool
) -> tuple[int, float, float]:
    """Find the point nearest to g, or furthest along g; return the unmet constraint, or count."""
    size = math.hypot(gx, gy)
    scale = speed / size if size > 0.0 and (furthest or size > speed) else 1.0
    ux, uy = gx * scale, gy * scale
    for i in range(count):
        ax, ay, c = _constraint(work, i, pivot)
        if ax * ux + ay * uy >= c or (pivot >= 0 and math.hypot(ax, ay) <= _PARALLEL):
            continue
        found, x, y = _on_border(work, i, pivot, speed, gx, gy, furthest)
        if not found:
            return i, ux, uy
        ux, uy = x, y
    return count, ux, uy


@array_kernel
def best_velocity(
    work: Pointer, count: int, speed: float, px: float, py: float
) -> tuple[float, float]:
    """Return the velocity within ``speed`` nearest to (px, py) in all half-planes.

    If there is none, return the velocity with the smallest largest violation.
    """
    failed, ux, uy = _search(work, count, -1, speed, px, py, False)
    worst = 0.0
    for i in range(failed, count):
        if violation(work, i, ux, uy) <= worst:
            continue
        # The new worst plane: go as far as no other plane is violated more.
        at = 8 + 4 * i
        stopped, x, y = _search(work, i, i, speed, work[at], work[at + 1], True)
        if stopped == i:
            ux, uy = x, y
        worst = violation(work, i, ux, uy)
    return ux, uy
