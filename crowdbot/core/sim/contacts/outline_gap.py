"""Distance of a robot's outline from walls and pillars, and its nearest point."""

from __future__ import annotations

import math

from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.crowd.contact.robot_contact import extent_of, from_outline
from crowdbot.core.sensing.raycast import from_segment
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array

#: Points that touch within this distance are one contact, such as a box side along a wall, m.
_AT_ONCE = 1e-3
#: Relative and absolute (m) differences of distances that are more than rounding.
_CLEARLY, _SLACK = 1.0 + 1e-9, 1e-9


@kernel
def gap_to_walls(walls: Array, pillars: Array, x: float, y: float) -> float:
    """Return the distance from a point to the nearest wall or pillar, m; inf if there is none."""
    nearest = math.inf
    for i in range(walls.shape[0]):
        dx, dy = from_segment(walls[i], x, y)
        if dx * dx + dy * dy <= nearest * nearest * _CLEARLY:  # roots are expensive
            nearest = min(nearest, math.hypot(dx, dy))
    for i in range(pillars.shape[0]):
        nearest = min(nearest, math.hypot(x - pillars[i, 0], y - pillars[i, 1]) - pillars[i, 2])
    return nearest


@kernel
def outline_gap(
    walls: Array, pillars: Array, outline: Array, x: float, y: float, yaw: float
) -> float:
    """Return the distance of an outline to the nearest wall or pillar surface, m; inf without any.

    Args:
        walls: (S, 4), pillars: (P, 3), as in `EnvironmentParts`.
        outline: (K, 2) in the robot's frame, m, before rounding: empty (its origin), a segment, or
            a convex polygon, counter-clockwise; a wall inside it has distance 0.
        x, y, yaw: the robot's pose.
    """
    if outline.shape[0] == 0:
        return float(gap_to_walls(walls, pillars, x, y))
    return _gap(walls, pillars, outline, x, y, math.cos(yaw), math.sin(yaw))


@kernel
def _gap(
    walls: Array, pillars: Array, outline: Array, x: float, y: float, c: float, s: float
) -> float:
    """Like `outline_gap`, of an outline with corners; c, s: cosine and sine of the heading."""
    nearest, extent = math.inf, extent_of(outline)
    for i in range(walls.shape[0]):
        dx, dy = from_segment(walls[i], x, y)
        if dx * dx + dy * dy > (nearest + extent + _SLACK) ** 2:
            continue
        ax, ay = _into(walls[i, 0], walls[i, 1], x, y, c, s)
        bx, by = _into(walls[i, 2], walls[i, 3], x, y, c, s)
        nearest = min(nearest, _to_segment(outline, ax, ay, bx, by))
    for i in range(pillars.shape[0]):
        px, py = _into(pillars[i, 0], pillars[i, 1], x, y, c, s)
        nearest = min(nearest, from_outline(outline, px, py)[0] - pillars[i, 2])
    return nearest


@kernel
def is_clear(
    walls: Array, pillars: Array, outline: Array, extent: float, x: float, y: float, c: float,
    s: float, least: float,
) -> bool:  # fmt: skip
    """Return True if `outline_gap` is at least ``least``, m, without computing most of it.

    Args:
        walls to y: as in `outline_gap`.
        extent: distance of the outline's farthest corner from its origin, m.
        c, s: cosine and sine of the heading; not used for a disc.
    """
    for i in range(walls.shape[0]):
        dx, dy = from_segment(walls[i], x, y)
        if dx * dx + dy * dy > (max(0.0, least) + extent + _SLACK) ** 2:
            continue
        if outline.shape[0] == 0:
            if math.hypot(dx, dy) < least:
                return False
            continue
        ax, ay = _into(walls[i, 0], walls[i, 1], x, y, c, s)
        bx, by = _into(walls[i, 2], walls[i, 3], x, y, c, s)
        if _to_segment(outline, ax, ay, bx, by) < least:
            return False
    if outline.shape[0] == 0:
        return gap_to_walls(walls[:0], pillars, x, y) >= least
    return _gap(walls[:0], pillars, outline, x, y, c, s) >= least


@kernel
def touched_at(
    walls: Array, pillars: Array, outline: Array, x: float, y: float, yaw: float
) -> tuple[float, float]:
    """Return the outline's point nearest to walls and pillars, in the robot's frame, m.

    If several points are equally near, such as both corners of a side, return their middle.
    Arguments as in `outline_gap`.
    """
    limit = outline_gap(walls, pillars, outline, x, y, yaw) + _AT_ONCE
    sum_x, sum_y, count = 0.0, 0.0, 0
    c, s = math.cos(yaw), math.sin(yaw)
    for i in range(walls.shape[0]):
        ax, ay = _into(walls[i, 0], walls[i, 1], x, y, c, s)
        bx, by = _into(walls[i, 2], walls[i, 3], x, y, c, s)
        for k in range(max(1, outline.shape[0])):
            cx, cy = (outline[k, 0], outline[k, 1]) if outline.shape[0] else (0.0, 0.0)
            px, py = nearest_on_segment(cx, cy, ax, ay, bx, by)
            if math.hypot(px - cx, py - cy) <= limit:
                sum_x, sum_y, count = sum_x + px, sum_y + py, count + 1
        for ex, ey in ((ax, ay), (bx, by)):
            if outline.shape[0] and from_outline(outline, ex, ey)[0] <= limit:
                sum_x, sum_y, count = sum_x + ex, sum_y + ey, count + 1
    for i in range(pillars.shape[0]):
        px, py = _into(pillars[i, 0], pillars[i, 1], x, y, c, s)
        away, ux, uy = math.hypot(px, py), 1.0, 0.0
        if outline.shape[0]:
            away, ux, uy, _, _ = from_outline(outline, px, py)
        elif away > 0.0:
            ux, uy = px / away, py / away
        if away - pillars[i, 2] <= limit:
            sum_x, sum_y = sum_x + px - pillars[i, 2] * ux, sum_y + py - pillars[i, 2] * uy
            count += 1
    return (sum_x / count, sum_y / count) if count else (math.nan, math.nan)


@kernel
def _into(px: float, py: float, x: float, y: float, c: float, s: float) -> tuple[float, float]:
    """Return a world point in the frame at (x, y) whose heading has cosine c and sine s."""
    return c * (px - x) + s * (py - y), c * (py - y) - s * (px - x)


@kernel
def _to_segment(outline: Array, ax: float, ay: float, bx: float, by: float) -> float:
    """Return the distance from an outline (two points or more) to segment a-b, m; 0 inside."""
    nearest = min(from_outline(outline, ax, ay)[0], from_outline(outline, bx, by)[0])
    count = outline.shape[0]
    for k in range(count):
        cx, cy = outline[k, 0], outline[k, 1]
        px, py = nearest_on_segment(cx, cy, ax, ay, bx, by)
        nearest = min(nearest, math.hypot(px - cx, py - cy))
        dx, dy = outline[(k + 1) % count, 0], outline[(k + 1) % count, 1]
        if _cross(ax, ay, bx, by, cx, cy, dx, dy):
            return 0.0
    return max(0.0, nearest)


@kernel
def _cross(
    ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> bool:
    """Return True if segments a-b and c-d cross, ends excluded."""
    c = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    d = (bx - ax) * (dy - ay) - (by - ay) * (dx - ax)
    a = (dx - cx) * (ay - cy) - (dy - cy) * (ax - cx)
    b = (dx - cx) * (by - cy) - (dy - cy) * (bx - cx)
    return bool(c * d < 0.0 and a * b < 0.0)
