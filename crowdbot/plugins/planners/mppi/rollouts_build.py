"""Rollouts of MPPI: noisy controls, their costs, and the weighted mean; compiled.

Noise is drawn at knots and is linear between them. A rollout ends where it can no longer cost so
little that it counts.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, kernel
from crowdbot.plugins.planners.shared.braking_build import MotionState
from crowdbot.plugins.planners.shared.distance_field_build import CELL, CELLS

#: Indices into the parameter vector.
A_MAX, ALPHA_MAX, V_MIN, V_MAX, W_MAX, VY_MAX, DT, TEMPERATURE, CONTROL = range(9)
COMFORT, GROWTH, PROGRESS, HEADING, CLEARANCE, COLLISION, BACKWARD = range(9, 16)
V_NOISE, W_NOISE, TOP = range(16, 19)
PARAMETERS = 19
#: People are tested in every n-th step, walls and progress in every m-th.
_PEOPLE_EVERY, _WALLS_EVERY = 4, 2
#: A collision counts from this clearance on, m.
_TOUCH = 0.05
#: What is already too near may be passed but not approached, m.
_SLACK = 1e-3
#: Share of the cost of a hit that remains if the robot stands and a person walks into it.
_STANDING = 0.15
#: At most this many people are predicted, the nearest.
MOST_PEOPLE = 30
#: Rollouts that cost this many temperatures more than the least do not count: e^-9 = 1e-4.
_COUNTS = 9.0


class Samples(NamedTuple):
    """Arrays of the sampler.

    Attributes:
        plan: (T, 3) v, w, vy of the current plan.
        noise: (B, K, 3) standard normal numbers at the knots, drawn once, in single precision.
        costs: (B + S,) of rollouts, first those with noise.
        simple: (S, T, 3) simple plans that are rolled out as well.
        mean: (K, 3) of the noise, scratch.
        near: (T, N, 3) place of people who can come near in each step, and radius, m, scratch.
        counts: (T,) number of these, scratch.
    """

    plan: Array
    noise: NDArray[np.float32]
    costs: Array
    simple: Array
    mean: Array
    near: Array
    counts: NDArray[np.int64]


class Around(NamedTuple):
    """The surroundings that rollouts are tested against, as `plans_build.PlanWorld`."""

    people: Array
    field: Array
    corner: tuple[float, float]
    robot: Array
    goal: tuple[float, float]


@kernel
def shift(plan: Array) -> None:
    """Move the plan one step on; the last control is kept."""
    for n in range(plan.shape[0] - 1):
        for c in range(3):
            plan[n, c] = plan[n + 1, c]


@kernel
def _limited(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)


@kernel
def _wall_gap(around: Around, x: float, y: float, c: float, s: float) -> float:
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
def _predict(around: Around, p: Array, state: MotionState, samples: Samples) -> None:
    """Write the people who can come within reach of the robot's rollouts in each step."""
    size = 0.0
    for k in range(around.robot.shape[0]):
        x, y, r = around.robot[k, 0], around.robot[k, 1], around.robot[k, 2]
        size = max(size, math.sqrt(x * x + y * y) + r)
    fast = max(max(p[TOP], abs(p[V_MIN])) + p[VY_MAX], abs(state[3]) + abs(state[5]))
    for n in range(0, samples.plan.shape[0], _PEOPLE_EVERY):
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
def _control(p: Array, plan: Array, noise: NDArray[np.float32], segment: float) -> float:
    """Return the cost of noise along the plan, gamma u·e / sigma^2, summed over knots."""
    total = 0.0
    for k in range(noise.shape[0]):
        n = min(int(k * segment), plan.shape[0] - 1)
        total += plan[n, 0] * noise[k, 0] / p[V_NOISE] + plan[n, 1] * noise[k, 1] / p[W_NOISE]
    return total


@kernel
def _cost(
    around: Around,
    p: Array,
    state: MotionState,
    samples: Samples,
    which: int,
    need: tuple[float, float, float],
) -> float:
    """Return the cost of a rollout; inf as soon as it is more than counts.

    Args:
        p: parameters.
        state: x, y, yaw, v, w, vy of the robot.
        samples: the arrays.
        which: number of the rollout, as of ``samples.costs``.
        need: clearances to walls and to people below which a rollout counts as a hit, m; cost
            above which it does not count.
    """
    x, y, yaw, v, w, vy = state
    c, s, dt, steps = math.cos(yaw), math.sin(yaw), p[DT], samples.plan.shape[0]
    gx, gy = around.goal[0] - x, around.goal[1] - y
    start = away = math.sqrt(gx * gx + gy * gy)
    fast = p[V_MAX] + p[VY_MAX]
    scale = p[PROGRESS] / (0.5 * p[V_MAX] * steps * dt)
    noisy = which < samples.noise.shape[0]
    plan = samples.plan if noisy else samples.simple[max(0, which - samples.noise.shape[0])]
    noise = samples.noise[which if noisy else 0]
    segment = (steps - 1) / (noise.shape[0] - 1)
    control = _control(p, plan, noise, segment) if noisy else 0.0
    total = close = back = nv = nw = nvy = sv = sw = svy = 0.0
    dv, dw, knot = p[A_MAX] * dt, p[ALPHA_MAX] * dt, 0
    for n in range(steps):
        if noisy:
            if n >= knot * segment and knot < noise.shape[0] - 1:
                part = n - knot * segment
                sv = (noise[knot + 1, 0] - noise[knot, 0]) / segment * p[V_NOISE]
                sw = (noise[knot + 1, 1] - noise[knot, 1]) / segment * p[W_NOISE]
                svy = (noise[knot + 1, 2] - noise[knot, 2]) / segment * p[V_NOISE]
                nv = noise[knot, 0] * p[V_NOISE] + part * sv
                nw = noise[knot, 1] * p[W_NOISE] + part * sw
                nvy = noise[knot, 2] * p[V_NOISE] + part * svy
                knot += 1
            else:
                nv, nw, nvy = nv + sv, nw + sw, nvy + svy
        v = _limited(_limited(plan[n, 0] + nv, p[V_MIN], p[TOP]), v - dv, v + dv)
        w = _limited(_limited(plan[n, 1] + nw, -p[W_MAX], p[W_MAX]), w - dw, w + dw)
        if p[VY_MAX] > 0.0:
            vy = _limited(_limited(plan[n, 2] + nvy, -p[VY_MAX], p[VY_MAX]), vy - dv, vy + dv)
        turn = w * dt
        half = 1.0 - 0.5 * turn * turn
        c, s = c * half - s * turn, s * half + c * turn
        x += (v * c - vy * s) * dt
        y += (v * s + vy * c) * dt
        back -= min(v, 0.0) * dt
        if n % _WALLS_EVERY != 0:
            continue
        hit = 0.0
        rest = 1.0 - (n + 1) / steps
        gap = _wall_gap(around, x, y, c, s)
        if gap < need[0]:
            hit = 1.0 + rest
        close += 0.25 * _WALLS_EVERY * max(0.0, 1.0 - gap / p[COMFORT])
        if n % _PEOPLE_EVERY == 0:
            doubt = p[GROWTH] * (n + 1) * dt
            gap = _people_gap(
                around.robot, samples.near[n], samples.counts[n], (x, y, c, s), p[COMFORT] + doubt
            )
            if gap < need[1]:
                hit = max(hit, (_STANDING + math.sqrt(v * v + vy * vy) / p[V_MAX]) * rest)
            close += _PEOPLE_EVERY * max(0.0, 1.0 - (gap - doubt) / p[COMFORT])
        gx, gy = around.goal[0] - x, around.goal[1] - y
        away = math.sqrt(gx * gx + gy * gy)
        made = min(_WALLS_EVERY, steps - n) * (start - away)
        total += made
        known = p[CLEARANCE] * close / steps + p[BACKWARD] * back + p[CONTROL] * control
        if hit > 0.0:
            total += max(0.0, start - away) * (steps - n - _WALLS_EVERY)
            known += p[PROGRESS] - scale * total / steps
            return float(known + p[COLLISION] * hit)
        left = steps - n
        most = (total + left * (start - away + 0.5 * fast * left * dt)) / steps
        if known + p[PROGRESS] - scale * most > need[2]:
            return math.inf
    long = max(math.sqrt(gx * gx + gy * gy), 1e-6)
    off = 0.5 * (1.0 - (gx * c + gy * s) / long)
    return float(
        p[PROGRESS]
        - scale * total / steps
        + p[CLEARANCE] * close / steps
        + p[HEADING] * off
        + p[BACKWARD] * back
        + p[CONTROL] * control
    )


@kernel
def improve(
    around: Around,
    p: Array,
    state: MotionState,
    samples: Samples,
) -> float:
    """Replace the plan by the weighted mean of all rollouts; return the least cost.

    Sample 0 has no noise.
    """
    costs, least = samples.costs, math.inf
    c, s = math.cos(state[2]), math.sin(state[2])
    _predict(around, p, state, samples)
    people = samples.near[0]
    at = state[0], state[1], c, s
    wall = _wall_gap(around, state[0], state[1], c, s)
    person = _people_gap(around.robot, people, samples.counts[0], at, 1.0)
    count = costs.shape[0]
    for n in range(count):
        b = count - 1 - n  # simple ones first: good ones save others their end
        need = (
            min(_TOUCH, wall - _SLACK), min(_TOUCH, person - _SLACK),
            least + _COUNTS * p[TEMPERATURE],
        )  # fmt: skip
        costs[b] = _cost(around, p, state, samples, b, need)
        least = min(least, costs[b])
    _mean(p, samples, least)
    return least


@kernel
def _mean(p: Array, samples: Samples, least: float) -> None:
    """Replace the plan by the mean of the rollouts' controls, weighted by exp(-cost)."""
    plan, noise, mean = samples.plan, samples.noise, samples.mean
    noisy, simple = 0.0, 0.0
    for k in range(mean.shape[0]):
        for c in range(3):
            mean[k, c] = 0.0
    for b in range(samples.costs.shape[0]):
        over = (samples.costs[b] - least) / p[TEMPERATURE]
        weight = math.exp(-over) if over < _COUNTS else 0.0
        samples.costs[b] = weight
        if b >= noise.shape[0]:
            simple += weight
            continue
        noisy += weight
        if weight > 0.0:
            for k in range(mean.shape[0]):
                for c in range(3):
                    mean[k, c] += weight * noise[b, k, c]
    total, segment = noisy + simple, (plan.shape[0] - 1) / (mean.shape[0] - 1)
    for n in range(plan.shape[0]):
        k = min(int(n / segment), mean.shape[0] - 2)
        part = n / segment - k
        for c in range(3):
            size = p[W_NOISE] if c == 1 else p[V_NOISE]
            value = noisy * plan[n, c]
            value += size * ((1.0 - part) * mean[k, c] + part * mean[k + 1, c])
            for m in range(samples.simple.shape[0]):
                value += samples.costs[noise.shape[0] + m] * samples.simple[m, n, c]
            low, high = (p[V_MIN], p[TOP]) if c == 0 else (-p[VY_MAX], p[VY_MAX])
            if c == 1:
                low, high = -p[W_MAX], p[W_MAX]
            plan[n, c] = _limited(value / total, low, high)


def drawn(samples: int, steps: int, knots: int, simple: int, seed: int) -> Samples:
    """Return the arrays for a number of rollouts, steps, knots and simple plans.

    Args:
        samples, steps, knots, simple: counts.
        seed: of the noise.
    """
    noise = np.random.default_rng(seed).standard_normal((samples, knots, 3)).astype(np.float32)
    noise[0] = 0.0
    return Samples(
        plan=np.zeros((steps, 3)), noise=noise, costs=np.zeros(samples + simple),
        simple=np.zeros((simple, steps, 3)), mean=np.zeros((knots, 3)),
        near=np.zeros((steps, MOST_PEOPLE, 3)), counts=np.zeros(steps, np.int64),
    )  # fmt: skip
