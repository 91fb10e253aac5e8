"""Overlap of two robots' outlines, compiled.

An outline is a point, a segment or a convex polygon, rounded by a radius. Each corner within reach
of the other outline touches it; depth, direction and position of the contact are averages over
these corners, weighted by depth, so that they change continuously.
"""

from __future__ import annotations

import math

from crowdbot.core.crowd.contact.robot_contact import R_BODY, R_YAW, RX, RY, extent_of, from_outline
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array, Mask


@kernel
def mark_within_reach(robots: Array, reach: Array, marks: Mask) -> int:
    """Mark the pairs of robots that are near enough to touch, in any orientation.

    Args:
        robots: (N, 8) rows as in `crowdbot.core.crowd.contact.robot_contact`.
        reach: (N,) distance of each robot's farthest point from its origin, m.
        marks: (N, N) output for i < j.

    Returns:
        the number of marked pairs.
    """
    found = 0
    for i in range(robots.shape[0]):
        for j in range(i + 1, robots.shape[0]):
            dx, dy = robots[i, RX] - robots[j, RX], robots[i, RY] - robots[j, RY]
            around = reach[i] + reach[j]
            marks[i, j] = dx * dx + dy * dy <= around * around
            found += marks[i, j]
    return found


@kernel
def overlap_of_robots(
    a: Array, outline_a: Array, b: Array, outline_b: Array
) -> tuple[float, float, float, float, float]:
    """Return the overlap of robot a and robot b.

    Args:
        a, b: (8,) rows as in `crowdbot.core.crowd.contact.robot_contact`.
        outline_a, outline_b: (K, 2) in their frames, before rounding, m.

    Returns:
        depth (m), 0 without contact; unit normal from a to b; the point where they meet (m). World
        frame.
    """
    reach = a[R_BODY] + b[R_BODY]
    around = extent_of(outline_a) + extent_of(outline_b) + reach
    if (a[RX] - b[RX]) ** 2 + (a[RY] - b[RY]) ** 2 >= around * around:
        return 0.0, 1.0, 0.0, 0.0, 0.0
    deepest, weight, nx, ny, x, y = _corners_within(a, outline_a, b, outline_b, reach)
    other, more, mx, my, u, v = _corners_within(b, outline_b, a, outline_a, reach)
    weight += more
    if weight == 0.0:
        return 0.0, 1.0, 0.0, 0.0, 0.0
    # Seen from b, normals point the other way.
    nx, ny, x, y = nx - mx, ny - my, (x + u) / weight, (y + v) / weight
    length = math.hypot(nx, ny)
    if length == 0.0:
        nx, ny, length = b[RX] - a[RX], b[RY] - a[RY], math.hypot(b[RX] - a[RX], b[RY] - a[RY])
    if length == 0.0:
        nx, ny, length = 1.0, 0.0, 1.0
    return max(deepest, other), nx / length, ny / length, x, y


@kernel
def _corners_within(
    a: Array, outline_a: Array, b: Array, outline_b: Array, reach: float
) -> tuple[float, float, float, float, float, float]:
    """Return depths, normals and positions of a's corners within reach of b's outline, summed.

    Returns:
        the largest depth (m); the sum of depths; and depth-weighted sums of normals towards b and
        of positions. World frame.
    """
    deepest = weight = nx = ny = px = py = 0.0
    for k in range(max(1, outline_a.shape[0])):
        x, y = a[RX], a[RY]
        if outline_a.shape[0] > 0:
            c, s = math.cos(a[R_YAW]), math.sin(a[R_YAW])
            x += c * outline_a[k, 0] - s * outline_a[k, 1]
            y += s * outline_a[k, 0] + c * outline_a[k, 1]
        gap, ux, uy = _away(b, outline_b, x, y)
        depth = reach - gap
        if depth <= 0.0:
            continue
        # Halfway between the two surfaces.
        middle = a[R_BODY] - 0.5 * depth
        deepest, weight = max(deepest, depth), weight + depth
        nx, ny = nx - depth * ux, ny - depth * uy
        px, py = px + depth * (x - middle * ux), py + depth * (y - middle * uy)
    return deepest, weight, nx, ny, px, py


@kernel
def _away(robot: Array, outline: Array, x: float, y: float) -> tuple[float, float, float]:
    """Return a point's distance from an outline before rounding (m), and direction away from it."""
    dx, dy = x - robot[RX], y - robot[RY]
    if outline.shape[0] == 0:
        distance = math.hypot(dx, dy)
        if distance == 0.0:
            return 0.0, 1.0, 0.0
        return distance, dx / distance, dy / distance
    c, s = math.cos(robot[R_YAW]), math.sin(robot[R_YAW])
    gap, ux, uy, _, _ = from_outline(outline, c * dx + s * dy, c * dy - s * dx)
    return gap, c * ux - s * uy, s * ux + c * uy
