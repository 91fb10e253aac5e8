"""Rollouts of the dynamic window: the robot's motion, and its distance to points; compiled."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, array_kernel, kernel
from crowdbot.plugins.planners.dwa.parameters_build import (
    A_MAX,
    ALPHA_MAX,
    COMFORT,
    GROWTH,
    HORIZON,
    MARGIN,
    RADIUS,
    REACH,
    TURN_TIME,
    V_MAX,
)
from crowdbot.plugins.planners.shared.follow_velocity_build import slewed
from crowdbot.plugins.planners.shared.points_build import minimum
from crowdbot.plugins.planners.shared.robot_outline_build import nearest_to_core

#: Time step of a rollout, s.
STEP = 0.125

#: A rollout may come this much closer to a point that is within the margin already, m.
_SLACK = 1e-3
#: Upper bound of rounding errors of distances, m.
ROUNDING = 1e-9


@kernel
def slewed_planar(v: float, vy: float, vt: float, vyt: float, change: float) -> tuple[float, float]:
    """Return the velocity after one step towards a target, with a limited change (v, vy)."""
    if vy == vyt:
        return slewed(v, vt, change), vy
    ahead, aside = vt - v, vyt - vy
    length = math.hypot(ahead, aside)
    share = min(1.0, change / length)
    return v + ahead * share, vy + aside * share


@array_kernel
def foreseen(points: Array, velocities: Array, p: Array) -> Array:
    """Return predicted points at each step of a rollout, starting now; (S + 1, 2, K), m."""
    steps = math.ceil(p[HORIZON] / STEP)
    out = np.empty((steps + 1, 2, points.shape[0]))
    for k in range(steps + 1):
        for i in range(points.shape[0]):
            out[k, 0, i] = points[i, 0] + velocities[i, 0] * (k * STEP)
            out[k, 1, i] = points[i, 1] + velocities[i, 1] * (k * STEP)
    return out


@kernel
def _nearest(
    points: Array, core: Array, x: float, y: float, angle: float, spin: float, square: Array
) -> float:
    """Return the distance from the core of the outline, at a pose, to the nearest of K points.

    inf if there is none; negative inside a polygon.

    Args:
        points: (2, K) m.
        core: see `robot_outline_build.core_of`; the core of a disc is its centre.
        spin: largest distance of the core from the centre, m.
        square: (K,) scratch.
    """
    if core.shape[0]:
        return float(nearest_to_core(points, core, x, y, angle, spin))
    xs, ys = points[0], points[1]
    for i in range(xs.shape[0]):
        dx, dy = xs[i] - x, ys[i] - y
        square[i] = dx * dx + dy * dy
    return math.sqrt(minimum(square))


@array_kernel
def reachable(points: Array, velocities: Array, p: Array) -> tuple[Array, Array]:
    """Return positions and velocities (K', 2) of points that may come near within the horizon."""
    near, moving, count = np.empty(points.shape), np.empty(points.shape), 0
    for i in range(points.shape[0]):
        x, y, vx, vy = points[i, 0], points[i, 1], velocities[i, 0], velocities[i, 1]
        speed = p[V_MAX] + math.sqrt(vx * vx + vy * vy) + p[GROWTH] + ROUNDING
        reach = p[REACH] + max(p[COMFORT], p[MARGIN]) + speed * p[HORIZON]
        if math.sqrt(x * x + y * y) < reach:
            near[count, 0], near[count, 1], moving[count, 0], moving[count, 1] = x, y, vx, vy
            count += 1
    return near[:count], moving[:count]


@array_kernel
def rollouts(ahead: Array) -> tuple[Array, Array, Array]:
    """Return data that rollouts share: known distances, turns, and scratch space.

    ``known`` holds, per step, a pose x, y (m), angle (rad) and its distance to the nearest point,
    m. For the turns see `turn_of`; candidates seldom have more than 24.
    """
    known = np.zeros((ahead.shape[0], 4))
    known[:, 3] = -math.inf
    return known, np.zeros((24, ahead.shape[0], 3)), np.empty(ahead.shape[2])


@kernel
def turn_of(turns: Array, w: float, target: float, p: Array) -> int:
    """Return the index of the turn (N, S + 1, 3) whose yaw rate (rad/s) goes to a target.

    Each turn holds, for every step, the angle after it (rad), and the cosine and sine of the angle
    in its middle. Its first row holds the two rates, and 1 if the others are filled. Many
    candidates share a turn.
    """
    at = 0
    for at in range(turns.shape[0]):  # without a free place, the last is overwritten
        if turns[at, 0, 2] == 0.0:
            break
        if turns[at, 0, 0] == w and turns[at, 0, 1] == target:
            return at
    turns[at, 0, 0], turns[at, 0, 1], turns[at, 0, 2] = w, target, 1.0
    angle, c, s, before = 0.0, 1.0, 0.0, 0.0
    for k in range(1, turns.shape[1]):
        goal = target if k * STEP <= p[TURN_TIME] else 0.0
        w_next = slewed(w, goal, p[ALPHA_MAX] * STEP)
        middle = angle + (w + w_next) / 4.0 * STEP
        angle += (w + w_next) / 2.0 * STEP
        if middle != before:  # constant after the turn
            c, s, before = math.cos(middle), math.sin(middle), middle
        turns[at, k, 0], turns[at, k, 1], turns[at, k, 2] = angle, c, s
        w = w_next
    return at


@kernel
def roll(
    ahead: Array,
    p: Array,
    core: Array,
    now: tuple[float, float, float],
    target: tuple[float, float, float],
    known: Array,
    turns: Array,
    scratch: Array,
) -> tuple[float, float, float, float, float]:
    """Roll out one candidate: slew to the target, keep the arc for the turning time, go straight.

    The nearest point is computed only where it may matter. Its distance is at least that of another
    rollout's pose at the same time, minus the distance between the poses and the swing of the
    outline's ends.

    Args:
        ahead: points from `foreseen`.
        core: core of the robot's outline, see `robot_outline_build.core_of`.
        now, target: velocities v, w, vy: m/s forward, rad/s, m/s to the left.
        known, turns, scratch: from `rollouts`.

    Returns:
        x, y (m) at the end or at the hit; heading after the turn (rad); time of the hit
        (s, the horizon if there is none); closeness, 0 (farther than comfort) to 1 (touching).
    """
    spin = p[REACH] - p[RADIUS]
    if known[0, 3] == -math.inf:  # all begin at the same pose
        known[0, 3] = _nearest(ahead[0], core, 0.0, 0.0, 0.0, spin, scratch)
    need = min(p[MARGIN], known[0, 3] - p[RADIUS] - _SLACK)
    turn = turns[turn_of(turns, now[1], target[1], p)]
    v, _, vy = now
    x = y = angle = close = 0.0
    for k in range(1, ahead.shape[0]):
        t = k * STEP
        v_next, vy_next = slewed_planar(v, vy, target[0], target[2], p[A_MAX] * STEP)
        angle, c, s = turn[k, 0], turn[k, 1], turn[k, 2]
        x += (v + v_next) / 2.0 * STEP * c - (vy + vy_next) / 2.0 * STEP * s
        y += (v + v_next) / 2.0 * STEP * s + (vy + vy_next) / 2.0 * STEP * c
        v, vy = v_next, vy_next
        dx, dy = x - known[k, 0], y - known[k, 1]
        least = known[k, 3] - math.sqrt(dx * dx + dy * dy) - ROUNDING - p[RADIUS]
        least -= spin * abs(angle - known[k, 2])
        if least >= need and _closeness(least, t, p) <= close:
            continue
        known[k, 0], known[k, 1], known[k, 2] = x, y, angle
        known[k, 3] = _nearest(ahead[k], core, x, y, angle, spin, scratch)
        gap = known[k, 3] - p[RADIUS]
        if gap < need:
            return x, y, angle, t, 1.0
        close = max(close, _closeness(gap, t, p))
    return x, y, angle, p[HORIZON], close


@kernel
def _closeness(gap: float, t: float, p: Array) -> float:
    """Return the weight of a gap (m) at a time (s); it falls as the gap grows."""
    doubt = 1.0 - (gap - p[GROWTH] * t) / p[COMFORT]
    return float(min(1.0, doubt) * (1.0 - 0.5 * t / p[HORIZON]))
