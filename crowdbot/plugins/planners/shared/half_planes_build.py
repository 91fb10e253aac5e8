"""Half-planes of velocities that avoid moving discs, and the best velocity in all; compiled.

Van den Berg, Guy, Lin, Manocha, "Reciprocal n-body collision avoidance", ISRR 2011: the velocity
obstacle of a disc within a time, and the linear program in the plane, solved one constraint after
the other. A half-plane is a row x, y, dx, dy: velocities to the left of the line through (x, y)
along (dx, dy) are allowed.
"""

from __future__ import annotations

import math

from crowdbot.plugin import Array, kernel

_PARALLEL = 1e-9


@kernel
def avoid(
    place: tuple[float, float],
    own: tuple[float, float],
    other: tuple[float, float],
    radius: float,
    time: float,
    step: float,
    share: float,
    out: Array,
) -> None:
    """Write the half-plane of own velocities that avoid a disc.

    Args:
        place: centre of the disc as seen from the robot, m.
        own, other: velocities of the robot and of the disc, m/s.
        radius: of both together, m.
        time: for which they should not touch, s.
        step: time in which they should part where they already do, s.
        share: of the evasion that the robot takes; 0.5 if the other one takes the rest.
        out: (4,).
    """
    px, py = place
    rx, ry = own[0] - other[0], own[1] - other[1]
    square = px * px + py * py
    inside = square <= radius * radius
    within = step if inside else time
    wx, wy = rx - px / within, ry - py / within
    long = math.sqrt(wx * wx + wy * wy)
    toward = wx * px + wy * py
    if inside or (toward < 0.0 and toward * toward > radius * radius * long * long):
        if long < _PARALLEL:
            away = max(math.sqrt(square), _PARALLEL)
            nx, ny = (-px / away, -py / away) if square > 0.0 else (-1.0, 0.0)
        else:
            nx, ny = wx / long, wy / long
        ux, uy = (radius / within - long) * nx, (radius / within - long) * ny
        out[2], out[3] = ny, -nx
    else:
        leg = math.sqrt(square - radius * radius)
        if px * wy - py * wx > 0.0:
            dx, dy = (px * leg - py * radius) / square, (px * radius + py * leg) / square
        else:
            dx, dy = -(px * leg + py * radius) / square, -(py * leg - px * radius) / square
        along = rx * dx + ry * dy
        ux, uy = along * dx - rx, along * dy - ry
        out[2], out[3] = dx, dy
    out[0], out[1] = own[0] + share * ux, own[1] + share * uy


@kernel
def violation(line: Array, x: float, y: float) -> float:
    """Return how far a velocity lies beyond a half-plane, m/s; negative inside."""
    return float(line[2] * (line[1] - y) - line[3] * (line[0] - x))


@kernel
def _on_line(
    lines: Array, count: int, top: float, wish: tuple[float, float], is_direction: bool
) -> tuple[bool, float, float]:
    """Return the best velocity on line ``count`` that the lines before it allow."""
    x, y, dx, dy = lines[count, 0], lines[count, 1], lines[count, 2], lines[count, 3]
    along = x * dx + y * dy
    root = along * along + top * top - x * x - y * y
    if root < 0.0:
        return False, 0.0, 0.0
    low, high = -along - math.sqrt(root), -along + math.sqrt(root)
    for i in range(count):
        cross = dx * lines[i, 3] - dy * lines[i, 2]
        beyond = lines[i, 2] * (y - lines[i, 1]) - lines[i, 3] * (x - lines[i, 0])
        if abs(cross) < _PARALLEL:
            if beyond < 0.0:
                return False, 0.0, 0.0
            continue
        t = beyond / cross
        if cross >= 0.0:
            high = min(high, t)
        else:
            low = max(low, t)
        if low > high:
            return False, 0.0, 0.0
    if is_direction:
        t = high if wish[0] * dx + wish[1] * dy > 0.0 else low
    else:
        t = min(high, max(low, dx * (wish[0] - x) + dy * (wish[1] - y)))
    return True, x + t * dx, y + t * dy


@kernel
def _within(
    lines: Array, count: int, top: float, wish: tuple[float, float], is_direction: bool
) -> tuple[int, float, float]:
    """Return the first line that cannot be kept (``count``: none), and the best velocity."""
    x, y = wish
    long = math.sqrt(x * x + y * y)
    if is_direction:
        x, y = x * top, y * top
    elif long > top:
        x, y = x * top / long, y * top / long
    for i in range(count):
        if violation(lines[i], x, y) > 0.0:
            found, u, v = _on_line(lines, i, top, wish, is_direction)
            if not found:
                return i, x, y
            x, y = u, v
    return count, x, y


@kernel
def best_velocity(
    lines: Array, count: int, hard: int, top: float, wish: tuple[float, float], scratch: Array
) -> tuple[float, float]:
    """Return the velocity in all half-planes nearest to a wanted one, or the least violating.

    Args:
        lines: (L, 4), the first ``count`` are in use; the first ``hard`` are never violated.
        top: largest speed, m/s.
        wish: m/s.
        scratch: (L, 4).
    """
    failed, x, y = _within(lines, count, top, wish, False)
    worst = 0.0
    for i in range(failed, count):
        if violation(lines[i], x, y) <= worst:
            continue
        made = hard
        for j in range(hard):
            for c in range(4):
                scratch[j, c] = lines[j, c]
        for j in range(hard, i):
            made += _between(lines, i, j, scratch[made])
        end, u, v = _within(scratch, made, top, (-lines[i, 3], lines[i, 2]), True)
        if end == made:
            x, y = u, v
        worst = violation(lines[i], x, y)
    return x, y


@kernel
def _between(lines: Array, i: int, j: int, out: Array) -> int:
    """Write the line on which two lines are violated alike; 0 if there is none, else 1."""
    cross = lines[i, 2] * lines[j, 3] - lines[i, 3] * lines[j, 2]
    if abs(cross) < _PARALLEL:
        if lines[i, 2] * lines[j, 2] + lines[i, 3] * lines[j, 3] > 0.0:
            return 0
        out[0], out[1] = 0.5 * (lines[i, 0] + lines[j, 0]), 0.5 * (lines[i, 1] + lines[j, 1])
    else:
        bx, by = lines[i, 0] - lines[j, 0], lines[i, 1] - lines[j, 1]
        t = (lines[j, 2] * by - lines[j, 3] * bx) / cross
        out[0], out[1] = lines[i, 0] + t * lines[i, 2], lines[i, 1] + t * lines[i, 3]
    dx, dy = lines[j, 2] - lines[i, 2], lines[j, 3] - lines[i, 3]
    long = max(math.sqrt(dx * dx + dy * dy), _PARALLEL)
    out[2], out[3] = dx / long, dy / long
    return 1
