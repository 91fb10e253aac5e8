"""Replace legs in lidar points by discs of people; compiled.

A planar lidar near the floor sees legs, while people collide with a wider disc. Runs of points as
narrow as a leg are paired, as leg detectors do (Arras, Mozos, Burgard, "Using boosted features for
the detection of people in 2D range data", ICRA 2007), and the near half of the disc around each
pair replaces their points, as if the lidar had seen it. Walls stay unchanged.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, array_kernel, kernel
from crowdbot.plugins.planners.shared.points_build import nearest_per_sector

#: Points farther apart than this plus a share of their distance belong to two bodies, m.
_GAP, _GAP_SHARE = 0.1, 0.015
#: Lower bound of the squared distance between bodies, however near, m^2.
_CLEARLY = 0.99 * _GAP**2
#: Largest width of one leg, and of two legs side by side, m.
_LEG, _LEGS = 0.22, 0.55
#: Largest distance between the legs of one person, m.
_STEP = 0.5
#: Radius of a leg, m.
_RADIUS = 0.07
#: A point nearer than the end of a run by this occludes it, m.
_IN_FRONT = 0.1
#: Legs nearer than this are kept: the robot may be inside a disc, m.
_NEAR = 0.8
#: Number of points on the near half of a disc.
_ARC = 15


@kernel
def _runs(points: Array, first: NDArray[np.int64]) -> int:
    """Write the start of each run of neighbouring points; return the number of runs."""
    count = 0
    for i in range(points.shape[0]):
        x, y, apart = points[i, 0], points[i, 1], math.inf
        if i:
            dx, dy = x - points[i - 1, 0], y - points[i - 1, 1]
            square = dx * dx + dy * dy
            if square < _CLEARLY:
                continue  # most cases
            apart = math.sqrt(square)
        if apart > _GAP + _GAP_SHARE * math.sqrt(x * x + y * y):  # hypot is five times as slow
            first[count] = i
            count += 1
    return count


@kernel
def _hidden(points: Array, edge: int, beside: int) -> bool:
    """Return True if the end of a run is occluded by something nearer."""
    if beside < 0 or beside >= points.shape[0]:
        return False
    x, y, p, q = points[edge, 0], points[edge, 1], points[beside, 0], points[beside, 1]
    if p * p + q * q >= x * x + y * y:
        return False  # most cases
    turn = abs(x * q - y * p) / max(math.hypot(x, y) * math.hypot(p, q), 1e-9)
    return turn < 0.05 and math.hypot(p, q) < math.hypot(x, y) - _IN_FRONT


@array_kernel
def _legs(points: Array, reach: float) -> Array:
    """Return the runs that may be legs, (L, 5).

    Columns: x, y of its middle, 1 if it is wide enough for two legs, its first point, its end.
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
        depth = math.sqrt(max(0.0, _RADIUS**2 - 0.25 * wide**2))  # distance behind the chord
        out[count, 0], out[count, 1] = x + depth * x / away, y + depth * y / away
        out[count, 2] = 1.0 if wide > _LEG else 0.0
        out[count, 3], out[count, 4] = a, b + 1
        count += 1
    return out[:count]


@array_kernel
def _middles(legs: Array) -> Array:
    """Return the middles of leg pairs, and of single legs whose other one is hidden; (K, 2)."""
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
                continue  # most cases
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
    """Return people detected in points, and the remaining points.

    Args:
        points: (P, 2) base frame, m, those of one lidar in the order of its beams.
        reach: legs farther than this are ignored, m.

    Returns:
        (K, 2) centres of people; (Q, 2) points that are not legs, and very near legs.
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
    """Return the points, plus those of discs (K, 2) of a radius as a lidar at the origin sees them.

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
        half = math.acos(radius / away)  # visible half of a disc
        toward = math.atan2(-y, -x)
        for step in range(_ARC):
            angle = toward + half * (2.0 * step / (_ARC - 1) - 1.0)
            out[count, 0] = x + radius * math.cos(angle)
            out[count, 1] = y + radius * math.sin(angle)
            count += 1
    return out[:count]


@kernel
def carry(points: Array, velocities: Array, people: Array, going: Array, radius: float) -> None:
    """Give points on people's discs the velocities of these people (K, 2), in place."""
    for i in range(points.shape[0]):
        best = radius + 0.05
        for k in range(people.shape[0]):
            dx, dy = points[i, 0] - people[k, 0], points[i, 1] - people[k, 1]
            if max(abs(dx), abs(dy)) >= best:
                continue  # most cases
            gap = math.hypot(dx, dy)
            if gap < best:
                best = gap
                velocities[i, 0], velocities[i, 1] = going[k, 0], going[k, 1]


@array_kernel
def people_and_points(
    seen: Array, reach: float, radius: float, sectors: int
) -> tuple[Array, Array, Array]:
    """Return people (as `people_in`) and the nearest points of everything.

    Args:
        seen, reach: as for `people_in`; without people if the radius is 0.
        radius: of the discs of people, m.
        sectors: as for `nearest_per_sector`, with the same reach.

    Returns:
        as `people_in`; (S, 2) as `nearest_per_sector`.
    """
    people, rest = people_in(seen, reach if radius > 0.0 else 0.0)
    return people, rest, nearest_per_sector(with_discs(rest, people, radius), sectors, reach)
