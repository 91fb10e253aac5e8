"""Predict people's motion from their last two samples: compiled parts of the codec.

Only float64 additions, multiplications, divisions and square roots are used, which round
identically on every machine.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.recording.motion.candidates import CandidateTable
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.arrays import Array

#: Number of speeds remembered per person.
SPEEDS = 3
_MOST = 2**63 - 1
#: A person whose acceleration differs by more from that towards a candidate is pushed, m^2/s^4.
_NEAR = 1e-12
#: Larger than its square root, m/s^2.
_BESIDE = 1e-5


@kernel
def best_speed(
    bits: int,
    v: float,
    up: float,
    uq: float,
    gain: float,
    ticks: int,
    speeds: Array,
    scratch: Array,
    scratch_bits: NDArray[np.int64],
) -> int:
    """Return the number of the speed that predicts the larger velocity component best."""
    best, least = 0, _MOST
    for s in range(SPEEDS + 1):
        scratch[0] = predicted(s, v, up, uq, gain, ticks, speeds)
        off = abs(bits - scratch_bits[0])
        if 0 <= off < least:
            best, least = s, off
    return best


@kernel
def predicted(
    taken: int, v: float, up: float, uq: float, gain: float, ticks: int, speeds: Array
) -> float:
    """Return the predicted larger component of the velocity.

    Args:
        taken: number of the target speed, from 1; 0: the target before, ``uq``.
        v: the component before.
        up: target of the smaller component.
    """
    if 1 <= taken <= SPEEDS:
        speed = speeds[taken - 1]
        rest = math.sqrt(max(speed * speed - up * up, 0.0))
        uq = -rest if uq < 0.0 else rest
    return known(towards(v, uq, gain, ticks))


@kernel
def target_velocity(before: float, now: float, gain: float) -> float:
    """Return the target velocity of a step; the present velocity where the step is unknown."""
    target = before + gain * (now - before)
    return target if math.isfinite(target) else now


@kernel
def towards(v: float, target: float, gain: float, ticks: int) -> float:
    """Return the velocity one step later, summed tick by tick."""
    change = (target - v) / (gain * ticks)
    for _ in range(ticks):
        v += change
    return v


@kernel
def moved(x: float, before: float, now: float, ticks: int) -> float:
    """Return the position one step later under linear velocity change, summed tick by tick."""
    change, v = (now - before) / ticks, before
    for _ in range(ticks):
        v += change
        x += v * TICK
    return x


@kernel
def known(value: float) -> float:
    """Return the value, or 0 if it is not finite, since NaN has several bit patterns."""
    return value if math.isfinite(value) else 0.0


@kernel
def chosen_candidate(
    table: CandidateTable, i: int, before: Array, now: Array, ahead: Array, ticks: int, last: int
) -> int:
    """Return the candidate that person i took between two samples, from 0; -1 if none.

    Args:
        before, now: (4, M) samples; x, y, vx, vy.
        ahead: (2, M) from `prefer`.
        ticks: number of ticks between the samples.
        last: the candidate of the last step, which is the most likely.
    """
    count = table.choices[i]
    if count == 0 or not math.isfinite(before[0, i] + before[1, i] + before[2, i] + before[3, i]):
        return -1
    rate = 1.0 / (ticks * TICK)
    ax, ay = rate * (now[2, i] - before[2, i]), rate * (now[3, i] - before[3, i])
    ex, ey = ahead[0, i], ahead[1, i]
    best, least = -1, _NEAR
    for c in range(-1, count):
        candidate = last if c < 0 else c
        if c >= 0 and _points_elsewhere(table, i, c, ex, ey, before, ax, ay):
            continue
        bx, by = acceleration(table, i, candidate, ex, ey, before)
        off = (bx - ax) * (bx - ax) + (by - ay) * (by - ay)
        if off < least:
            if c < 0:
                return last
            best, least = c, off
    return best


@kernel
def _points_elsewhere(
    table: CandidateTable, i: int, c: int, ex: float, ey: float, before: Array, ax: float, ay: float
) -> bool:
    """Return True if the acceleration towards a candidate surely points elsewhere than (ax, ay).

    It needs no division, and excludes most candidates: of two accelerations at most sqrt(_NEAR)
    apart, the one is at most that far beside the line along the other.
    """
    k = table.first[i] + c
    cx, cy = table.unit[k, 0], table.unit[k, 1]
    ux, uy = cx * ex - cy * ey - before[2, i], cx * ey + cy * ex - before[3, i]
    return bool(abs(ux * ay - uy * ax) > _BESIDE * (abs(ux) + abs(uy)))


@kernel
def prefer(table: CandidateTable, before: Array, goal: Array, ahead: Array) -> None:
    """Write people's preferred velocities, (2, M) m/s; arguments as in `chosen_candidate`.

    They are computed as the product of direction and speed, as in the crowd.
    """
    for i in range(ahead.shape[1]):
        gx, gy = goal[0, i] - before[0, i], goal[1, i] - before[1, i]
        away = math.sqrt(gx * gx + gy * gy)
        pace, speed = table.speed[i] / away, table.speed[i]
        gx, gy = pace * gx, pace * gy
        length = math.sqrt(gx * gx + gy * gy)
        walks = (away > table.radius[i]) & (length > 0.0)
        ahead[0, i] = speed * (gx / length) if walks else 0.0
        ahead[1, i] = speed * (gy / length) if walks else 0.0


@kernel
def acceleration(
    table: CandidateTable, i: int, candidate: int, ex: float, ey: float, before: Array
) -> tuple[float, float]:
    """Return person i's acceleration towards a candidate, m/s^2; (ex, ey) is from `prefer`."""
    c = table.first[i] + candidate
    cx, cy = table.unit[c, 0], table.unit[c, 1]
    relaxation, limit = table.relaxation[i], table.limit[i]
    ax = (cx * ex - cy * ey - before[2, i]) / relaxation
    ay = (cx * ey + cy * ex - before[3, i]) / relaxation
    square = ax * ax + ay * ay
    if square <= limit * limit:
        return ax, ay
    share = limit / math.sqrt(square)
    return ax * share, ay * share


@kernel
def accelerate(before: Array, pull: Array, ticks: int, after: Array) -> None:
    """Write x, y, vx, vy (4, M) after this many ticks, summed as in the crowd.

    Args:
        before: (4, M).
        pull: (2, M) acceleration of each person in all of these ticks, m/s^2.
        ticks: number of ticks.
        after: (4, M) output.
    """
    for c in range(4):
        for i in range(after.shape[1]):
            after[c, i] = before[c, i]
    for _ in range(ticks):
        for c in range(2):
            for i in range(after.shape[1]):
                after[c + 2, i] += pull[c, i] * TICK
                after[c, i] += after[c + 2, i] * TICK
    for c in range(4):
        for i in range(after.shape[1]):
            after[c, i] = known(after[c, i])
