"""Choose the best of the dynamic window's candidates; compiled.

Most candidates cannot win, whatever the obstacles: lower bounds of the costs are computed first,
and rollouts start with the most promising candidate.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, array_kernel, kernel
from crowdbot.plugins.planners.dwa.parameters_build import (
    A_MAX,
    ALPHA_MAX,
    CLEARANCE,
    HEADING,
    HORIZON,
    IMPACT,
    PERIOD,
    PROGRESS,
    SMOOTHNESS,
    V_MAX,
    W_MAX,
)
from crowdbot.plugins.planners.dwa.rollouts_build import (
    ROUNDING,
    STEP,
    foreseen,
    reachable,
    roll,
    rollouts,
    slewed_planar,
    turn_of,
)
from crowdbot.plugins.planners.shared.points_build import unsigned


@array_kernel
def evaluate(
    points: Array,
    velocities: Array,
    p: Array,
    core: Array,
    now: tuple[float, float, float],
    candidates: Array,
    direction: float,
    facing: float,
    last: tuple[float, float, float],
) -> tuple[int, float]:
    """Return the best admissible candidate; of equal ones, the first.

    A candidate is admissible if the robot, after following it, can still stop before the first
    predicted hit. Standing still is always admissible, and so is turning on the spot for a round
    robot.

    Args:
        points: (K, 2) base frame, m.
        velocities: (K, 2) base frame, m/s.
        p: (17,) parameters, in the order of the constants of `parameters_build`.
        core: of the robot's outline, as `robot_outline_build.core_of`.
        now: present v, w, vy: m/s forward, rad/s, m/s to the left.
        candidates: (C, 3) targets v, w, vy; or (C, 2) without vy.
        direction: bearing along which progress is measured, rad.
        facing: bearing to which the robot should turn, rad.
        last: last command, v, w, vy.

    Returns:
        its index, -1 if none is admissible; its cost.
    """
    best, index = math.inf, -1
    ahead = foreseen(*reachable(points, velocities, p), p)
    known, turns, scratch = rollouts(ahead)
    toward = math.cos(direction), math.sin(direction)
    going, outlined = math.hypot(now[0], now[2]), core.shape[0] > 0
    least = _least_costs(p, now, candidates, toward, facing, last, turns)
    for _ in range(candidates.shape[0]):
        k = _least_of(least)
        if not least[k] <= best:
            break
        least[k] = math.inf
        vt, wt, vyt = target = _target(candidates, k)
        x, y, angle, hit, close = roll(ahead, p, core, now, target, known, turns, scratch)
        stop = max(going, math.hypot(vt, vyt)) / p[A_MAX]
        if outlined:
            stop = max(stop, max(abs(now[1]), abs(wt)) / p[ALPHA_MAX])
        moves = vt != 0.0 or vyt != 0.0 or (outlined and wt != 0.0)
        if moves and hit < stop + 2.0 * p[PERIOD]:
            continue
        cost = _cost(p, x, y, angle, hit, close, target, toward, facing, last)
        if cost < best or (cost == best and k < index):
            best, index = cost, k
    return index, best


@kernel
def _target(candidates: Array, k: int) -> tuple[float, float, float]:
    """Return v, w and vy of a candidate velocity; vy is 0 if it has none."""
    vy = candidates[k, 2] if candidates.shape[1] > 2 else 0.0
    return candidates[k, 0], candidates[k, 1], vy


@kernel
def _least_of(values: Array) -> int:
    """Return the index of the first minimum of (N,) numbers, N > 0."""
    at = 0
    for k in range(1, values.shape[0]):
        if values[k] < values[at]:
            at = k
    return at


@kernel
def _cost(
    p: Array, x: float, y: float, angle: float, hit: float, close: float,
    target: tuple[float, float, float], toward: tuple[float, float], facing: float,
    last: tuple[float, float, float],
) -> float:  # fmt: skip
    """Return the cost of a rollout to a target with the result of `roll`.

    `toward` is a unit vector.
    """
    made = (x * toward[0] + y * toward[1]) / (p[V_MAX] * p[HORIZON])
    off = unsigned(angle - facing) / math.pi
    change = abs(target[0] - last[0]) / p[V_MAX] + abs(target[1] - last[1]) / p[W_MAX]
    return float(
        p[PROGRESS] * (1.0 - made)
        + p[HEADING] * off
        + p[CLEARANCE] * close
        + p[IMPACT] * (1.0 - hit / p[HORIZON])
        + p[SMOOTHNESS] * (change + abs(target[2] - last[2]) / p[V_MAX])
    )


@array_kernel
def _least_costs(
    p: Array,
    now: tuple[float, float, float],
    candidates: Array,
    toward: tuple[float, float],
    facing: float,
    last: tuple[float, float, float],
    turns: Array,
) -> Array:
    """Return a lower bound of each candidate's cost (C,), as if without obstacles.

    A hit ends a rollout, perhaps with more progress or a better heading, which may outweigh the
    cost of the hit. So three terms are subtracted: the possible gain of a better heading over
    clearance, the impact's refund for steps beyond the horizon, and the possible gain of full-speed
    progress over impact.

    Args:
        toward: unit vector of the direction.
        turns: from `rollouts`.
        p, now, candidates, facing, last: as in `evaluate`.
    """
    out, pace = np.empty(candidates.shape[0]), np.empty((turns.shape[1], 2))
    over = (turns.shape[1] - 1) * STEP / p[HORIZON] - 1.0  # steps go beyond the horizon
    doubt = max(0.0, p[HEADING] - p[CLEARANCE]) + p[IMPACT] * over + ROUNDING
    going, before = math.hypot(now[0], now[2]), (math.nan, math.nan, math.nan)
    for k in range(candidates.shape[0]):
        target = _target(candidates, k)
        if target[0] != before[0] or target[2] != before[2]:
            _fill_pace(pace, now, target, p)
        before = target
        turn = turns[turn_of(turns, now[1], target[1], p)]
        x, y = _free_end(pace, turn)
        angle = turn[turn.shape[0] - 1, 0]
        free = _cost(p, x, y, angle, p[HORIZON], 0.0, target, toward, facing, last)
        speed = max(going, math.hypot(target[0], target[2])) / p[V_MAX]
        out[k] = free - doubt - max(0.0, p[PROGRESS] * speed - p[IMPACT]) * (1.0 + over)
    return out


@kernel
def _fill_pace(
    pace: Array, now: tuple[float, float, float], target: tuple[float, float, float], p: Array
) -> None:
    """Write the distance ahead and to the left, m, of each step of a rollout, (S + 1, 2)."""
    v, vy = now[0], now[2]
    for n in range(1, pace.shape[0]):
        v_next, vy_next = slewed_planar(v, vy, target[0], target[2], p[A_MAX] * STEP)
        pace[n, 0], pace[n, 1] = (v + v_next) / 2.0 * STEP, (vy + vy_next) / 2.0 * STEP
        v, vy = v_next, vy_next


@kernel
def _free_end(pace: Array, turn: Array) -> tuple[float, float]:
    """Return the end of a rollout without obstacles, x, y, m."""
    x = y = 0.0
    for n in range(1, turn.shape[0]):
        x += pace[n, 0] * turn[n, 1] - pace[n, 1] * turn[n, 2]
        y += pace[n, 0] * turn[n, 2] + pace[n, 1] * turn[n, 1]
    return x, y
