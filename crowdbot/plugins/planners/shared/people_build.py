"""Discs of people around the legs that a lidar shows; compiled.

A planar lidar near the floor sees legs, while people touch with a wider disc. Runs of points as
narrow as a leg are paired, as leg detectors do (Arras, Mozos, Burgard, "Using boosted features for
the detection of people in 2D range data", ICRA 2007), and the near half of the disc around each
pair takes the place of their points, as if the lidar had seen it. Walls stay as they are.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, array_kernel, kernel
from crowdbot.plugins.planners.shared.points_build import nearest_per_sector

#: Points farther apart than this, and a share of their distance, belong to two bodies, m.
_GAP, _GAP_SHARE = 0.1, 0.015
#: The square of a distance that is less than that, however near they are, m^2.
_CLEARLY = 0.99 * _GAP**2
#: Widest run of points that may be one leg, and two legs side by side, m.
_LEG, _LEGS = 0.22, 0.55
#: Legs of one person are no farther apart than this, m.
_STEP = 0.5
#: Radius of a leg, m.
_RADIUS = 0.07
#: What is nearer than the end of a run by this covers it, m.
_IN_FRONT = 0.1
#: Legs nearer than this stay: the robot may be inside a disc, m.
_NEAR = 0.8
#: Points on the near half of a disc.
_ARC = 15


@kernel
def _runs(points: Array, first: NDArray[np.int64]) -> int:
    """Write where each run of neighbouring points begins; return how many there are."""
    count = 0
    for i in range(points.shape[0]):
        x, y, apart = points[i, 0], points[i, 1], math.inf
        if i:
            dx, dy = x - points[i - 1, 0], y - points[i - 1, 1]
            square = dx * dx + dy * dy
            if square < _CLEARLY:
                continue  # most of them
            apart = math.sqrt(square)
        if apart > _GAP + _GAP_SHARE * math.sqrt(x * x + y * y):  # hypot is five times as slow
            first[count] = i
            count += 1
    return count


@kernel
def _hidden(points: Array, edge: int, beside: int) -> bool:
    """Whether the end of a run is where something nearer begins to cover it."""
    if beside < 0 or beside >= points.shape[0]:
        return False
    x, y, p, q = points[edge, 0], points[edge, 1], points[beside, 0], points[beside, 1]
    if p * p + q * q >= x * x + y * y:
        return False  # most of them
    turn = abs(x * q - y * p) / max(math.hypot(x, y) * math.hypot(p, q), 1e-9)
    return turn < 0.05 and math.hypot(p, q) < math.hypot(x, y) - _IN_FRONT


@array_kernel
def _legs(points: Array, reach: float) -> Array:
    """Runs that may be legs, (L, 5).

    Columns: x, y of its middle, 1 if it is wide enough for both, its first point, its end.
    """
    first = np.empty(points.shape[0] + 1, dtype=np.int64)
    runs = _runs(points, first)
    first[runs] = points.shape[0]
    out = np.empty((runs, 5))
    count = 0
    for k in range(runs):
        a, b = first[k], first[k + 1] - 1
        x, y = 0.5 * (points[a, 0] + points[b, 0]), 0.5 * (points[a, 1] + points[b, 1])
        wide = math.hypot(points[b, 0] - points[a, 0], points[b, 1] - points[a, 1])
        away = math.hypot(x, y)
        if wide > _LEGS or away > reach or away == 0.0:
            continue
        if _hidden(points, a, a - 1) and _hidden(points, b, b + 1):
            continue
        depth = math.sqrt(max(0.0, _RADIUS**2 - 0.25 * wide**2))  # of the middle behind the chord
        out[count, 0], out[count, 1] = x + depth * x / away, y + depth * y / away
        out[count, 2] = 1.0 if wide > _LEG else 0.0
        out[count, 3], out[count, 4] = a, b + 1
        count += 1
    return out[:count]


@array_kernel
def _middles(legs: Array) -> Array:
    """Middles of pairs of legs, and of legs whose other one is not seen; (K, 2)."""
    used = np.zeros(legs.shape[0], dtype=np.bool_)
    out = np.empty((legs.shape[0], 2))
    count = 0
    for i in range(legs.shape[0]):
        if used[i]:
            continue
        best, other = _STEP, -1
        for j in range(i + 1, legs.shape[0]):
            dx, dy = legs[i, 0] - legs[j, 0], legs[i, 1] - legs[j, 1]
            if max(abs(dx), abs(dy)) >= best:
                continue  # most of them
            apart = math.hypot(dx, dy)
            if not used[j] and legs[i, 2] + legs[j, 2] == 0.0 and apart < best:
                best, other = apart, j
        out[count, 0], out[count, 1] = legs[i, 0], legs[i, 1]
        if other >= 0:
            used[other] = True
            out[count, 0] = 0.5 * (legs[i, 0] + legs[other, 0])
            out[count, 1] = 0.5 * (legs[i, 1] + legs[other, 1])
        count += 1
    return out[:count]


@array_kernel
def people_in(points: Array, reach: float) -> tuple[Array, Array]:
    """Where people stand, and what else there is.

    Args:
        points: (P, 2) base frame, m, those of one lidar in the order of its beams.
        reach: legs farther than this are left alone, m.

    Returns:
        (K, 2) middles of people; (Q, 2) points that are not legs, or legs very near.
    """
    legs = _legs(points, reach)
    kept = np.ones(points.shape[0], dtype=np.bool_)
    for k in range(legs.shape[0]):
        if math.hypot(legs[k, 0], legs[k, 1]) > _NEAR:
            for i in range(int(legs[k, 3]), int(legs[k, 4])):
                kept[i] = False
    rest, count = np.empty(points.shape), 0
    for i in range(points.shape[0]):
        if kept[i]:
            rest[count, 0], rest[count, 1] = points[i, 0], points[i, 1]
            count += 1
    return _middles(legs), rest[:count]


@array_kernel
def with_discs(points: Array, people: Array, radius: float) -> Array:
    """Points, and those that a lidar at the origin would see of discs (K, 2) of a radius.

    A disc around the origin adds nothing.

    Returns:
        (P', 2), the points first.
    """
    out = np.empty((points.shape[0] + people.shape[0] * _ARC, 2))
    count = points.shape[0]
    for i in range(count):  # a copy of the slice takes seconds to compile
        out[i, 0], out[i, 1] = points[i, 0], points[i, 1]
    for k in range(people.shape[0]):
        x, y = people[k, 0], people[k, 1]
        away = math.hypot(x, y)
        if away <= radius:
            continue
        half = math.acos(radius / away)  # what can be seen of a disc
        toward = math.atan2(-y, -x)
        for step in range(_ARC):
            angle = toward + half * (2.0 * step / (_ARC - 1) - 1.0)
            out[count, 0] = x + radius * math.cos(angle)
            out[count, 1] = y + radius * math.sin(angle)
            count += 1
    return out[:count]


@kernel
def carry(points: Array, velocities: Array, people: Array, going: Array, radius: float) -> None:
    """Give the points on people's discs, in place, the velocities (K, 2) of the people."""
    for i in range(points.shape[0]):
        best = radius + 0.05
        for k in range(people.shape[0]):
            dx, dy = points[i, 0] - people[k, 0], points[i, 1] - people[k, 1]
            if max(abs(dx), abs(dy)) >= best:
                continue  # most of them
            gap = math.hypot(dx, dy)
            if gap < best:
                best = gap
                velocities[i, 0], velocities[i, 1] = going[k, 0], going[k, 1]


@array_kernel
def people_and_points(
    seen: Array, reach: float, radius: float, sectors: int
) -> tuple[Array, Array, Array]:
    """What the robot has to do with: `people_in`, and the nearest points of all there is.

    Args:
        seen, reach: as for `people_in`, but that nobody is looked for where the radius is 0.
        radius: of the discs of people, m.
        sectors: as for `nearest_per_sector`, with the same reach.

    Returns:
        as `people_in`; (S, 2) as `nearest_per_sector`.
    """
    people, rest = people_in(seen, reach if radius > 0.0 else 0.0)
    return people, rest, nearest_per_sector(with_discs(rest, people, radius), sectors, reach)
