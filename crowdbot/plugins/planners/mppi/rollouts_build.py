"""Costs of MPPI's rollouts, and the update of the plan; compiled.

A rollout ends early once its cost is so large that its weight is negligible.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from crowdbot.plugin import Array, inline_kernel, kernel
from crowdbot.plugins.planners.mppi.lanes_build import AWAY, BACK, LANES, VY, C, S, V, X, Y
from crowdbot.plugins.planners.mppi.samples_build import (
    BACKWARD,
    CLEARANCE,
    COLLISION,
    COMFORT,
    CONTROL,
    COUNTS,
    DT,
    GROWTH,
    HEADING,
    PEOPLE_EVERY,
    PROGRESS,
    TEMPERATURE,
    TOP,
    V_MAX,
    V_MIN,
    VY_MAX,
    WALLS_EVERY,
    Samples,
    drive,
    weighted_mean,
)
from crowdbot.plugins.planners.shared.braking_build import MotionState
from crowdbot.plugins.planners.shared.distance_field_build import CELL, CELLS

#: A collision counts from this clearance on, m.
_TOUCH = 0.05
#: What is already too near may be passed but not approached, m.
_SLACK = 1e-3
#: Share of the cost of a hit that remains if the robot stands and a person walks into it.
_STANDING = 0.15


class RolloutObstacles(NamedTuple):
    """Obstacles and people against which rollouts are tested, as `plans_build.PlanWorld`."""

    people: Array
    field: Array
    corner: tuple[float, float]
    robot: Array
    goal: tuple[float, float]


@kernel
def _wall_gap(around: RolloutObstacles, x: float, y: float, c: float, s: float) -> float:
    """Return the gap from the robot to what stands, m."""
    best = math.inf
    for k in range(around.robot.shape[0]):
        u = x + c * around.robot[k, 0] - s * around.robot[k, 1] - around.corner[0]
        v = y + s * around.robot[k, 0] + c * around.robot[k, 1] - around.corner[1]
        i, j = int(u / CELL), int(v / CELL)
        if u >= 0.0 and v >= 0.0 and i < CELLS and j < CELLS:
            best = min(best, around.field[i, j] - around.robot[k, 2])
    return best


@kernel
def _people_gap(
    robot: Array, near: Array, count: int, pose: tuple[float, float, float, float], far: float
) -> float:
    """Return the gap from the robot to people (N, 3), m; at most ``far``."""
    x, y, c, s = pose
    best = far
    for k in range(robot.shape[0]):
        px, py = x + c * robot[k, 0] - s * robot[k, 1], y + s * robot[k, 0] + c * robot[k, 1]
        for i in range(count):
            dx, dy = near[i, 0] - px, near[i, 1] - py
            most, square = best + robot[k, 2] + near[i, 2], dx * dx + dy * dy
            if most > 0.0 and square < most * most:
                best = min(best, math.sqrt(square) - robot[k, 2] - near[i, 2])
    return best


@kernel
def _predict(around: RolloutObstacles, p: Array, state: MotionState, samples: Samples) -> None:
    """Write the people who can come within reach of the robot's rollouts in each step."""
    size = 0.0
    for k in range(around.robot.shape[0]):
        x, y, r = around.robot[k, 0], around.robot[k, 1], around.robot[k, 2]
        size = max(size, math.sqrt(x * x + y * y) + r)
    fast = max(max(p[TOP], abs(p[V_MIN])) + p[VY_MAX], abs(state[3]) + abs(state[5]))
    for n in range(0, samples.plan.shape[0], PEOPLE_EVERY):
        t, count = (n + 1) * p[DT], 0
        for i in range(around.people.shape[0]):
            ex = around.people[i, 0] + t * around.people[i, 2]
            ey = around.people[i, 1] + t * around.people[i, 3]
            dx, dy = ex - state[0], ey - state[1]
            reach = fast * t + size + around.people[i, 4] + p[COMFORT] + p[GROWTH] * t
            if dx * dx + dy * dy < reach * reach:
                samples.near[n, count, 0], samples.near[n, count, 1] = ex, ey
                samples.near[n, count, 2] = around.people[i, 4]
                count += 1
        samples.counts[n] = count


@kernel
def _among_people(
    around: RolloutObstacles,
    p: Array,
    samples: Samples,
    n: int,
    pose: tuple[float, float, float, float],
    need: float,
) -> tuple[bool, float]:
    """Return True if a person is nearer than needed at step n, and the share of closeness.

    Args:
        around: the surroundings.
        p: parameters.
        samples: the arrays.
        n: the step.
        pose: x, y (m), cosine and sine of the heading.
        need: clearance below which it counts as a hit, m.
    """
    doubt = p[GROWTH] * (n + 1) * p[DT]
    near, count = samples.near[n], samples.counts[n]
    gap = _people_gap(around.robot, near, count, pose, p[COMFORT] + doubt)
    close = PEOPLE_EVERY * (1.0 - (gap - doubt) / p[COMFORT]) if gap - doubt < p[COMFORT] else 0.0
    return gap < need, close


@kernel
def _turned_away(around: RolloutObstacles, samples: Samples, i: int) -> float:
    """Return how far lane i ends turned away from the goal: 0, towards it, to 1, backwards."""
    kept, lanes = samples.kept, samples.lanes
    last = kept.shape[0] - 1
    gx, gy = around.goal[0] - kept[last, X, i], around.goal[1] - kept[last, Y, i]
    long = max(math.sqrt(gx * gx + gy * gy), 1e-6)
    return float(0.5 * (1.0 - (gx * lanes.c[i] + gy * lanes.s[i]) / long))


@inline_kernel
def _contact(
    around: RolloutObstacles,
    p: Array,
    samples: Samples,
    i: int,
    m: int,
    need: tuple[float, ...],
    close: float,
) -> tuple[float, float]:
    """Return the weight of a hit at kept sample m, 0 without, and the closeness until then.

    Args:
        around, p, samples, i, need: as in `_cost`.
        m: number of the sample, among those that are kept.
        close: sum of closeness until the sample before.
    """
    kept, n, hit = samples.kept, m * WALLS_EVERY, 0.0
    x, y, c, s = kept[m, X, i], kept[m, Y, i], kept[m, C, i], kept[m, S, i]
    rest = 1.0 - (n + 1) / samples.plan.shape[0]
    gap = _wall_gap(around, x, y, c, s)
    if gap < need[0]:
        hit = 1.0 + rest
    if gap < p[COMFORT]:
        close += 0.25 * WALLS_EVERY * (1.0 - gap / p[COMFORT])
    if n % PEOPLE_EVERY == 0:
        hard, near = _among_people(around, p, samples, n, (x, y, c, s), need[1])
        if hard:
            v, vy = kept[m, V, i], kept[m, VY, i]
            hit = max(hit, (_STANDING + math.sqrt(v * v + vy * vy) / p[V_MAX]) * rest)
        close += near
    return hit, close


@kernel
def _cost(
    around: RolloutObstacles,
    p: Array,
    samples: Samples,
    i: int,
    start: float,
    need: tuple[float, ...],
) -> float:
    """Return the cost of the rollout in lane i; inf as soon as it is more than counts.

    Args:
        around: the surroundings.
        p: parameters.
        samples: the arrays, lanes moved.
        i: the lane.
        start: distance to the goal now, m.
        need: clearances to walls and to people below which a rollout counts as a hit, m; cost
            above which it does not count.
    """
    kept, steps, dt = samples.kept, samples.plan.shape[0], p[DT]
    fast = p[V_MAX] + p[VY_MAX]
    scale = p[PROGRESS] / (0.5 * p[V_MAX] * steps * dt)
    fixed, per_step, made = (
        p[CONTROL] * samples.lanes.control[i],
        p[CLEARANCE] / steps,
        scale / steps,
    )
    left_over, total, close = need[2] - p[PROGRESS], 0.0, 0.0
    for m in range(kept.shape[0]):
        n = m * WALLS_EVERY
        hit, close = _contact(around, p, samples, i, m, need, close)
        away = kept[m, AWAY, i]
        total += min(WALLS_EVERY, steps - n) * (start - away)
        if hit > 0.0:
            total += max(0.0, start - away) * (steps - n - WALLS_EVERY)
            known = p[CLEARANCE] * close / steps + p[BACKWARD] * kept[m, BACK, i] + fixed
            known += p[PROGRESS] - scale * total / steps
            return float(known + p[COLLISION] * hit)
        left = steps - n
        most = total + left * (start - away + 0.5 * fast * left * dt)
        known = per_step * close + p[BACKWARD] * kept[m, BACK, i] + fixed
        if known - made * most > left_over:
            return math.inf
    return float(
        p[PROGRESS]
        - scale * total / steps
        + p[CLEARANCE] * close / steps
        + p[HEADING] * _turned_away(around, samples, i)
        + p[BACKWARD] * samples.lanes.back[i]
        + fixed
    )


@kernel
def improve(
    around: RolloutObstacles,
    p: Array,
    state: MotionState,
    samples: Samples,
) -> float:
    """Replace the plan by the weighted mean of all rollouts; return the least cost.

    Sample 0 has no noise.
    """
    c, s = math.cos(state[2]), math.sin(state[2])
    _predict(around, p, state, samples)
    at = state[0], state[1], c, s
    wall = _wall_gap(around, state[0], state[1], c, s) - _SLACK
    person = _people_gap(around.robot, samples.near[0], samples.counts[0], at, 1.0) - _SLACK
    need = min(_TOUCH, wall), min(_TOUCH, person)
    simple = samples.simple.shape[0]
    noisy = samples.costs.shape[0] - simple
    drive(around.goal, p, state, samples, 0, False)  # first: good ones save others their end
    least = _price(around, p, state, samples, (noisy, simple), (*need, math.inf))
    for first in range(0, noisy, LANES):
        drive(around.goal, p, state, samples, first, True)
        part = first, min(LANES, noisy - first)
        least = _price(around, p, state, samples, part, (*need, least))
    weighted_mean(p, samples, least)
    return least


@kernel
def _price(
    around: RolloutObstacles,
    p: Array,
    state: MotionState,
    samples: Samples,
    part: tuple[int, int],
    need: tuple[float, float, float],
) -> float:
    """Write the costs of the lanes; return the least cost so far.

    Args:
        around: the surroundings.
        p: parameters.
        state: of the robot.
        samples: the arrays, lanes moved.
        part: number of the first rollout, as in ``samples.costs``; number of rollouts.
        need: clearances to walls and to people, m; the least cost before.
    """
    gx, gy, least = around.goal[0] - state[0], around.goal[1] - state[1], need[2]
    start, counts = math.sqrt(gx * gx + gy * gy), COUNTS * p[TEMPERATURE]
    for i in range(part[1]):
        cost = _cost(around, p, samples, i, start, (need[0], need[1], least + counts))
        samples.costs[part[0] + i] = cost
        least = min(least, cost)
    return least
