"""Rollouts of MPPI: noisy controls, their costs, and the weighted mean; compiled."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from crowdbot.plugin import Array, kernel
from crowdbot.plugins.planners.shared.distance_field_build import CELL, CELLS

#: Indices into the parameter vector.
A_MAX, ALPHA_MAX, V_MIN, V_MAX, W_MAX, VY_MAX, DT, TEMPERATURE, CONTROL = range(9)
COMFORT, GROWTH, PROGRESS, HEADING, CLEARANCE, COLLISION, BACKWARD = range(9, 16)
V_NOISE, W_NOISE, TOP = range(16, 19)
PARAMETERS = 19
#: People are tested in every n-th step, and walls in every m-th.
_PEOPLE_EVERY, _WALLS_EVERY = 4, 2
#: A collision counts from this clearance on, m.
_TOUCH = 0.05
#: What is already too near may be passed but not approached, m.
_SLACK = 1e-3


class Samples(NamedTuple):
    """Arrays of the sampler.

    Attributes:
        plan: (T, 3) v, w, vy of the current plan.
        noise: (B, T, 3) standard normal numbers, drawn once.
        costs: (B,).
    """

    plan: Array
    noise: Array
    costs: Array


class Around(NamedTuple):
    """The surroundings that rollouts are tested against, as `plans_build.World`."""

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
def _field_at(field: Array, corner: tuple[float, float], x: float, y: float) -> float:
    """Return the distance to what stands in a cell, m; far outside of the grid."""
    i, j = int((x - corner[0]) / CELL), int((y - corner[1]) / CELL)
    if x < corner[0] or y < corner[1] or i >= CELLS or j >= CELLS:
        return math.inf
    return float(field[i, j])


@kernel
def _limited(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)


@kernel
def _gap(around: Around, x: float, y: float, c: float, s: float, t: float, people: bool) -> float:
    """Return the gap from the robot to walls, or to people in ``t`` seconds, m."""
    best = math.inf
    for k in range(around.robot.shape[0]):
        px = x + c * around.robot[k, 0] - s * around.robot[k, 1]
        py = y + s * around.robot[k, 0] + c * around.robot[k, 1]
        r = around.robot[k, 2]
        if not people:
            best = min(best, _field_at(around.field, around.corner, px, py) - r)
            continue
        for i in range(around.people.shape[0]):
            dx = around.people[i, 0] + t * around.people[i, 2] - px
            dy = around.people[i, 1] + t * around.people[i, 3] - py
            most, square = best + r + around.people[i, 4], dx * dx + dy * dy
            if most > 0.0 and square >= most * most:
                continue  # most cases
            best = min(best, math.sqrt(square) - r - around.people[i, 4])
    return best


@kernel
def _cost(
    around: Around,
    p: Array,
    state: tuple[float, float, float, float, float, float],
    plan: Array,
    noise: Array,
    need: tuple[float, float],
) -> float:
    """Return the cost of a plan with some noise.

    Args:
        p: parameters.
        state: x, y, yaw, v, w, vy of the robot.
        plan: (T, 3).
        noise: (T, 3) standard normal.
        need: clearances to walls and to people below which a rollout counts as a hit, m.
    """
    x, y, yaw, v, w, vy = state
    c, s, dt, steps = math.cos(yaw), math.sin(yaw), p[DT], plan.shape[0]
    gx, gy = around.goal[0] - x, around.goal[1] - y
    start = math.sqrt(gx * gx + gy * gy)
    total = close = control = back = 0.0
    dv, dw = p[A_MAX] * dt, p[ALPHA_MAX] * dt
    for n in range(steps):
        vn, wn, vyn = p[V_NOISE] * noise[n, 0], p[W_NOISE] * noise[n, 1], p[V_NOISE] * noise[n, 2]
        control += plan[n, 0] * vn / p[V_NOISE] ** 2 + plan[n, 1] * wn / p[W_NOISE] ** 2
        v = _limited(_limited(plan[n, 0] + vn, p[V_MIN], p[TOP]), v - dv, v + dv)
        w = _limited(_limited(plan[n, 1] + wn, -p[W_MAX], p[W_MAX]), w - dw, w + dw)
        if p[VY_MAX] > 0.0:
            vy = _limited(_limited(plan[n, 2] + vyn, -p[VY_MAX], p[VY_MAX]), vy - dv, vy + dv)
        turn = w * dt
        half = 1.0 - 0.5 * turn * turn
        c, s = c * half - s * turn, s * half + c * turn
        x += (v * c - vy * s) * dt
        y += (v * s + vy * c) * dt
        back -= min(v, 0.0) * dt
        t = (n + 1) * dt
        if n % _WALLS_EVERY == 0:
            gap = _gap(around, x, y, c, s, t, False)
            if gap < need[0]:
                rest = 1.0 - t / (steps * dt)
                return float(p[COLLISION] * (1.0 + rest) + p[PROGRESS] + p[CONTROL] * control)
            close += 0.25 * _WALLS_EVERY * max(0.0, 1.0 - gap / p[COMFORT])
        if n % _PEOPLE_EVERY == 0:
            gap = _gap(around, x, y, c, s, t, True)
            if gap < need[1]:
                rest = 1.0 - t / (steps * dt)
                return float(p[COLLISION] * (1.0 + rest) + p[PROGRESS] + p[CONTROL] * control)
            close += _PEOPLE_EVERY * max(0.0, 1.0 - (gap - p[GROWTH] * t) / p[COMFORT])
        gx, gy = around.goal[0] - x, around.goal[1] - y
        total += math.sqrt(gx * gx + gy * gy)
    long = max(math.sqrt(gx * gx + gy * gy), 1e-6)
    made = (start - total / steps) / (0.5 * p[V_MAX] * steps * dt)
    off = 0.5 * (1.0 - (gx * c + gy * s) / long)
    return float(
        p[PROGRESS] * (1.0 - made)
        + p[CLEARANCE] * close / steps
        + p[HEADING] * off
        + p[BACKWARD] * back
        + p[CONTROL] * control
    )


@kernel
def improve(
    around: Around,
    p: Array,
    state: tuple[float, float, float, float, float, float],
    samples: Samples,
) -> float:
    """Replace the plan by the weighted mean of its noisy variants; return the least cost.

    Sample 0 has no noise.
    """
    plan, noise, costs = samples.plan, samples.noise, samples.costs
    least = math.inf
    c, s = math.cos(state[2]), math.sin(state[2])
    need = (
        min(_TOUCH, _gap(around, state[0], state[1], c, s, 0.0, False) - _SLACK),
        min(_TOUCH, _gap(around, state[0], state[1], c, s, 0.0, True) - _SLACK),
    )
    for b in range(noise.shape[0]):
        costs[b] = _cost(around, p, state, plan, noise[b], need)
        least = min(least, costs[b])
    total = 0.0
    for b in range(noise.shape[0]):
        costs[b] = math.exp(-(costs[b] - least) / p[TEMPERATURE])
        total += costs[b]
    for n in range(plan.shape[0]):
        mean_v = mean_w = mean_vy = 0.0
        for b in range(noise.shape[0]):
            if costs[b] > 1e-4:
                mean_v += costs[b] * noise[b, n, 0]
                mean_w += costs[b] * noise[b, n, 1]
                mean_vy += costs[b] * noise[b, n, 2]
        v = plan[n, 0] + p[V_NOISE] * mean_v / total
        w = plan[n, 1] + p[W_NOISE] * mean_w / total
        vy = plan[n, 2] + p[V_NOISE] * mean_vy / total
        plan[n, 0] = _limited(v, p[V_MIN], p[TOP])
        plan[n, 1] = _limited(w, -p[W_MAX], p[W_MAX])
        plan[n, 2] = _limited(vy, -p[VY_MAX], p[VY_MAX])
    return least


def drawn(samples: int, steps: int, seed: int) -> Samples:
    """Return the arrays for a number of rollouts and steps; the noise is that of the seed."""
    noise = np.random.default_rng(seed).standard_normal((samples, steps, 3))
    noise[0] = 0.0
    return Samples(np.zeros((steps, 3)), noise, np.zeros(samples))
