"""Rollouts of the dynamic window: candidates × time × points; compiled."""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray

from crowdbot.core.interfaces import Array
from crowdbot.plugins.planners.dwa_points_build import minimum, unsigned

#: Steps of a rollout, s.
STEP = 0.125

#: Indices into the vector of parameters that the kernel takes.
A_MAX, ALPHA_MAX, HORIZON, TURN_TIME, RADIUS, MARGIN, COMFORT, GROWTH, PERIOD = range(9)
PROGRESS, HEADING, CLEARANCE, IMPACT, SMOOTHNESS, V_MAX, W_MAX = range(9, 16)
PARAMETERS = 16

#: A rollout may come this much closer to a point that is within the margin already, m.
_SLACK = 1e-3
#: More than what distances may be off by rounding, m.
_ROUNDING = 1e-9


@numba.njit(cache=True, error_model="numpy")
def _slewed(value: float, target: float, change: float) -> float:
    return min(max(target, value - change), value + change)


@numba.njit(cache=True, error_model="numpy")
def foreseen(points: Array, velocities: Array, p: Array) -> Array:
    """Where points are at each step of a rollout, the first of which is now; (S + 1, 2, K), m."""
    steps = math.ceil(p[HORIZON] / STEP)
    out = np.empty((steps + 1, 2, points.shape[0]))
    for k in range(steps + 1):
        for i in range(points.shape[0]):
            out[k, 0, i] = points[i, 0] + velocities[i, 0] * (k * STEP)
            out[k, 1, i] = points[i, 1] + velocities[i, 1] * (k * STEP)
    return out


@numba.njit(cache=True, error_model="numpy")
def _nearest(xs: Array, ys: Array, x: float, y: float, square: Array) -> float:
    """Distance from (x, y) to the nearest of K points; inf if there is none.

    Args:
        square: (K,) scratch.
    """
    for i in range(xs.shape[0]):
        dx, dy = xs[i] - x, ys[i] - y
        square[i] = dx * dx + dy * dy
    return math.sqrt(minimum(square))


@numba.njit(cache=True, error_model="numpy")
def reachable(points: Array, velocities: Array, p: Array) -> NDArray[np.bool_]:
    """(K,) which points can come near the robot within the horizon."""
    out = np.empty(points.shape[0], dtype=np.bool_)
    for i in range(points.shape[0]):
        speed = p[V_MAX] + math.hypot(velocities[i, 0], velocities[i, 1]) + p[GROWTH]
        near = p[RADIUS] + max(p[COMFORT], p[MARGIN]) + speed * p[HORIZON]
        out[i] = math.hypot(points[i, 0], points[i, 1]) < near
    return out


@numba.njit(cache=True, error_model="numpy")
def rollouts(ahead: Array) -> tuple[Array, Array]:
    """What rollouts among points as `foreseen` may share: known distances, and scratch.

    Known is, for each step, a place x, y and its distance to the nearest point, m.
    """
    known = np.zeros((ahead.shape[0], 3))
    known[:, 2] = -math.inf
    return known, np.empty(ahead.shape[2])


@numba.njit(cache=True, error_model="numpy")
def roll(
    ahead: Array, p: Array, v: float, w: float, vt: float, wt: float, known: Array, scratch: Array
) -> tuple[float, float, float, float, float]:
    """One candidate: slew to (vt, wt), keep the arc for the turning time, then go straight.

    The nearest point is looked for only where it may matter: it is no nearer than it was to the
    place where another rollout was at the same time, less the way between the two places.

    Args:
        ahead: points as `foreseen`.
        known, scratch: of `rollouts`.

    Returns:
        x, y (m) at the end or at the hit; heading after the turn (rad); time of the hit
        (s, the horizon if there is none); closeness, 0 (farther than comfort) to 1 (touching).
    """
    start = _nearest(ahead[0, 0], ahead[0, 1], 0.0, 0.0, scratch) - p[RADIUS]
    need = min(p[MARGIN], start - _SLACK)
    x = y = angle = close = 0.0
    for k in range(1, ahead.shape[0]):
        t = k * STEP
        goal = wt if t <= p[TURN_TIME] else 0.0
        v_next = _slewed(v, vt, p[A_MAX] * STEP)
        w_next = _slewed(w, goal, p[ALPHA_MAX] * STEP)
        middle = angle + (w + w_next) / 4.0 * STEP
        x += (v + v_next) / 2.0 * STEP * math.cos(middle)
        y += (v + v_next) / 2.0 * STEP * math.sin(middle)
        angle += (w + w_next) / 2.0 * STEP
        v, w = v_next, w_next
        dx, dy = x - known[k, 0], y - known[k, 1]
        least = known[k, 2] - math.sqrt(dx * dx + dy * dy) - _ROUNDING - p[RADIUS]
        if least >= need and _closeness(least, t, p) <= close:
            continue
        known[k, 0], known[k, 1] = x, y
        known[k, 2] = _nearest(ahead[k, 0], ahead[k, 1], x, y, scratch)
        gap = known[k, 2] - p[RADIUS]
        if gap < need:
            return x, y, angle, t, 1.0
        close = max(close, _closeness(gap, t, p))
    return x, y, angle, p[HORIZON], close


@numba.njit(cache=True, error_model="numpy")
def _closeness(gap: float, t: float, p: Array) -> float:
    """How much a gap (m) at a time (s) counts; falls as the gap grows."""
    doubt = 1.0 - (gap - p[GROWTH] * t) / p[COMFORT]
    return float(min(1.0, doubt) * (1.0 - 0.5 * t / p[HORIZON]))


@numba.njit(cache=True, error_model="numpy")
def _evenly(first: float, last: float, values: Array) -> None:
    """Fill (N,) with even steps from the first to the last, N > 1."""
    steps = values.shape[0] - 1
    for k in range(steps):
        values[k] = k * ((last - first) / steps) + first
    values[steps] = last


@numba.njit(cache=True, error_model="numpy")
def candidates(
    low: float, high: float, speeds: int, left: float, right: float, rates: int, wish: float
) -> Array:
    """Target velocities (C, 2): every speed with every yaw rate, slow to fast.

    Args:
        low, high: borders of the speeds, m/s; 0, or what is next to it, is one of them.
        speeds, rates: how many are tried of each, > 1.
        left, right: borders of the yaw rates, rad/s; 0, or what is next to it, is tried too.
        wish: one more yaw rate, rad/s.
    """
    v, w = np.empty(speeds + 1), np.empty(rates + 2)
    _evenly(low, high, v[:speeds])
    v[speeds] = max(low, min(0.0, high))
    v.sort()
    _evenly(left, right, w[:rates])
    w[rates], w[rates + 1] = wish, max(left, min(right, 0.0))
    out = np.empty((len(v) * len(w), 2))
    count = 0
    for k in range(len(v)):
        if k > 0 and v[k] == v[k - 1]:
            continue
        for j in range(len(w)):
            out[count, 0], out[count, 1] = v[k], w[j]
            count += 1
    return out[:count]


@numba.njit(cache=True, error_model="numpy")
def evaluate(
    points: Array,
    velocities: Array,
    p: Array,
    v: float,
    w: float,
    candidates: Array,
    direction: float,
    last: tuple[float, float],
) -> tuple[int, float]:
    """The best admissible candidate.

    A candidate is admissible if the robot, after following it, can still stop before the first
    predicted hit. Standing still is always a candidate's right: turning on the spot moves no
    point of a round robot.

    Args:
        points: (K, 2) base frame, m.
        velocities: (K, 2) base frame, m/s.
        p: (16,) parameters, in the order of the constants above.
        v: present speed, m/s.
        w: present yaw rate, rad/s.
        candidates: (C, 2) target v and w.
        direction: bearing in which progress counts, rad.
        last: last command.

    Returns:
        its index, -1 if none is admissible; its cost.
    """
    best, index = math.inf, -1
    ahead = foreseen(points, velocities, p)
    known, scratch = rollouts(ahead)
    ux, uy = math.cos(direction), math.sin(direction)
    for k in range(candidates.shape[0]):
        vt, wt = candidates[k, 0], candidates[k, 1]
        x, y, angle, hit, close = roll(ahead, p, v, w, vt, wt, known, scratch)
        speed = max(abs(v), abs(vt))
        if vt != 0.0 and hit < speed / p[A_MAX] + 2.0 * p[PERIOD]:
            continue
        made = (x * ux + y * uy) / (p[V_MAX] * p[HORIZON])
        off = unsigned(angle - direction) / math.pi
        change = abs(vt - last[0]) / p[V_MAX] + abs(wt - last[1]) / p[W_MAX]
        cost = (
            p[PROGRESS] * (1.0 - made)
            + p[HEADING] * off
            + p[CLEARANCE] * close
            + p[IMPACT] * (1.0 - hit / p[HORIZON])
            + p[SMOOTHNESS] * change
        )
        if cost < best:
            best, index = cost, k
    return index, best
