"""Points around a robot: thinning, apparent motion, isolated points; compiled."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, Mask, array_kernel, kernel, rough_angle, stable_order

#: More than a rough angle is off, turns.
_DOUBT = 5e-6


@kernel
def wrapped(angle: float) -> float:
    """Return an angle in [-pi, pi], rad."""
    return angle - 2.0 * math.pi * round(angle / (2.0 * math.pi))


@kernel
def unsigned(angle: float) -> float:
    """Return the absolute value of an angle, in [0, pi] rad."""
    return abs(wrapped(angle))


@kernel
def minimum(values: Array) -> float:
    """Return the minimum of (N,) numbers without NaN, inf if empty. Overwrites them.

    It halves the array repeatedly, so that several numbers are compared at once.
    """
    count = values.shape[0]
    while count > 1:
        half = (count + 1) // 2
        upper = values[half:count]
        for i in range(upper.shape[0]):
            a, b = values[i], upper[i]
            values[i] = b if b < a else a
        count = half
    return float(values[0]) if count else math.inf


@kernel
def _sector(x: float, y: float, sectors: int) -> int:
    """Return the index of the sector of the full turn that contains a point."""
    if x != 0.0 or y != 0.0:
        at = (rough_angle(x, y) / (2.0 * math.pi) + 0.5) * sectors
        within = at - math.floor(at)
        if _DOUBT * sectors < within < 1.0 - _DOUBT * sectors:
            return int(at)
    return int((math.atan2(y, x) / (2.0 * math.pi) + 0.5) * sectors) % sectors


@array_kernel
def nearest_per_sector(points: Array, sectors: int, reach: float) -> Array:
    """Thin points to the nearest one of each sector around the origin.

    In a narrow sector, the nearest point blocks the robot's path to those behind it.

    Args:
        points: (P, 2) base frame, m.
        sectors: number of equal sectors of the full turn.
        reach: points farther than this are dropped, m.

    Returns:
        (K, 2) with K <= sectors, in the order of their bearing.
    """
    best = np.full(sectors, reach * reach)
    index = np.full(sectors, -1, dtype=np.int64)
    for i in range(points.shape[0]):
        x, y = points[i, 0], points[i, 1]
        square = x * x + y * y
        if square >= reach * reach:
            continue
        at = _sector(x, y, sectors)
        if square < best[at]:
            best[at], index[at] = square, i
    out = np.empty((sectors, 2))
    count = 0
    for at in range(sectors):
        if index[at] >= 0:
            out[count, 0], out[count, 1] = points[index[at], 0], points[index[at], 1]
            count += 1
    return out[:count]


@array_kernel
def apparent_velocity(
    now: Array, before: Array, dt: float, slowest: float, fastest: float
) -> Array:
    """Return each point's motion since an earlier scan, from its nearest neighbour there.

    On the front of an approaching body this is the approach speed; where a surface slides along
    itself it is zero. Motion below ``slowest`` is sampling noise, motion above ``fastest`` a point
    that was hidden before: both count as standing.

    Args:
        now: (K, 2) points in a frame at rest, m.
        before: (L, 2) points ``dt`` seconds ago, same frame.
        dt: s.
        slowest: m/s.
        fastest: m/s.

    Returns:
        (K, 2) velocities in that frame, m/s.
    """
    out = np.zeros((now.shape[0], 2))
    if before.shape[0] == 0 or dt <= 0.0:
        return out
    low, high = (slowest * dt) ** 2, (fastest * dt) ** 2
    order = stable_order(before[:, 0])
    across = np.empty((before.shape[0], 2))  # in that order
    for k in range(before.shape[0]):
        across[k, 0], across[k, 1] = before[order[k], 0], before[order[k], 1]
    # Ignore points farther away than anything can move.
    far, first = fastest * dt + 1e-9 * (1.0 + fastest * dt), 0
    for i in range(now.shape[0]):
        x, y = now[i, 0], now[i, 1]
        first = _first_from(across, x, first)
        best, nearest = far * far, -1
        for way in (1, -1):  # along x away from the point, until no point can be nearer
            k = first if way > 0 else first - 1
            while 0 <= k < across.shape[0]:
                dx, dy = x - across[k, 0], y - across[k, 1]
                if dx * dx > best:
                    break
                square = dx * dx + dy * dy
                if square < best or (square == best and order[k] < nearest):
                    best, nearest = square, order[k]
                k += way
        if nearest >= 0 and low < best < high:
            out[i, 0] = (x - before[nearest, 0]) / dt
            out[i, 1] = (y - before[nearest, 1]) / dt
    return out


@array_kernel
def apparent_velocities(
    now: Array,
    before: Array,
    people: Array,
    others: Array,
    dt: float,
    slowest: float,
    fastest: float,
) -> tuple[Array, Array]:
    """Apply `apparent_velocity` to points, against earlier people and other points."""
    return (
        apparent_velocity(now, before, dt, slowest, fastest),
        apparent_velocity(people, others, dt, slowest, fastest),
    )


@kernel
def _first_from(points: Array, least: float, guess: int) -> int:
    """Return the first index of points sorted by x whose x is at least ``least``."""
    while guess < points.shape[0] and points[guess, 0] < least:
        guess += 1
    while guess > 0 and not points[guess - 1, 0] < least:
        guess -= 1
    return guess


@array_kernel
def apart(points: Array, others: Array, distance: float) -> Mask:
    """Return a mask of points farther than a distance from all others.

    Args:
        points: (K, 2); NaN points are not apart.
        others: (L, 2), same frame.
        distance: m.

    Returns:
        (K,).
    """
    out = np.ones(points.shape[0], np.bool_)
    clearly = (1.0 + 1e-12) * distance * distance
    for i in range(points.shape[0]):
        for j in range(others.shape[0]):
            dx, dy = points[i, 0] - others[j, 0], points[i, 1] - others[j, 1]
            # Cheaper than the length, and the same except for rounding.
            if not dx * dx + dy * dy > clearly and not math.hypot(dx, dy) > distance:
                out[i] = False
                break
    return out


@kernel
def walkers(people: Array, velocities: Array, near: float, speed: float) -> tuple[int, int]:
    """Count people (K, 2) nearer than ``near`` (m), and those among them above ``speed`` (m/s)."""
    count = walk = 0
    for i in range(people.shape[0]):
        if math.hypot(people[i, 0], people[i, 1]) < near:
            count += 1
            walk += math.hypot(velocities[i, 0], velocities[i, 1]) > speed
    return count, walk
