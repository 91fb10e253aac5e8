"""Rollouts of the dynamic window: candidates × time × points; compiled."""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray

from crowdbot.plugins.planners.dwa_points_build import unsigned

Array = NDArray[np.float64]

#: Steps of a rollout, s.
STEP = 0.125

#: Indices into the vector of parameters that the kernel takes.
A_MAX, ALPHA_MAX, HORIZON, TURN_TIME, RADIUS, MARGIN, COMFORT, GROWTH, PERIOD = range(9)
PROGRESS, HEADING, CLEARANCE, IMPACT, SMOOTHNESS, V_MAX, W_MAX = range(9, 16)
PARAMETERS = 16

#: A rollout may come this much closer to a point that is within the margin already, m.
_SLACK = 1e-3


@numba.njit(cache=True, error_model="numpy")
def _slewed(value: float, target: float, change: float) -> float:
    return min(max(target, value - change), value + change)


@numba.njit(cache=True, error_model="numpy")
def _nearest(points: Array, velocities: Array, t: float, x: float, y: float) -> float:
    """Distance from (x, y) to the nearest point, moved on by t seconds."""
    best = math.inf
    for i in range(points.shape[0]):
        dx = points[i, 0] + velocities[i, 0] * t - x
        dy = points[i, 1] + velocities[i, 1] * t - y
        d2 = dx * dx + dy * dy
        if d2 < best:
            best = d2
    return math.sqrt(best)


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
def roll(
    points: Array, velocities: Array, p: Array, v: float, w: float, vt: float, wt: float
) -> tuple[float, float, float, float, float]:
    """One candidate: slew to (vt, wt), keep the arc for the turning time, then go straight.

    Returns:
        x, y (m) at the end or at the hit; heading after the turn (rad); time of the hit
        (s, the horizon if there is none); closeness, 0 (farther than comfort) to 1 (touching).
    """
    start = _nearest(points, velocities, 0.0, 0.0, 0.0) - p[RADIUS]
    need = min(p[MARGIN], start - _SLACK)
    x = y = angle = close = 0.0
    steps = math.ceil(p[HORIZON] / STEP)
    for k in range(1, steps + 1):
        t = k * STEP
        goal = wt if t <= p[TURN_TIME] else 0.0
        v_next = _slewed(v, vt, p[A_MAX] * STEP)
        w_next = _slewed(w, goal, p[ALPHA_MAX] * STEP)
        middle = angle + (w + w_next) / 4.0 * STEP
        x += (v + v_next) / 2.0 * STEP * math.cos(middle)
        y += (v + v_next) / 2.0 * STEP * math.sin(middle)
        angle += (w + w_next) / 2.0 * STEP
        v, w = v_next, w_next
        gap = _nearest(points, velocities, t, x, y) - p[RADIUS]
        if gap < need:
            return x, y, angle, t, 1.0
        doubt = 1.0 - (gap - p[GROWTH] * t) / p[COMFORT]
        close = max(close, min(1.0, doubt) * (1.0 - 0.5 * t / p[HORIZON]))
    return x, y, angle, p[HORIZON], close


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
    ux, uy = math.cos(direction), math.sin(direction)
    for k in range(candidates.shape[0]):
        vt, wt = candidates[k, 0], candidates[k, 1]
        x, y, angle, hit, close = roll(points, velocities, p, v, w, vt, wt)
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
