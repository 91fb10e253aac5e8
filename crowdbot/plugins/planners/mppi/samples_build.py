"""Samples of MPPI: noisy plans, the rollouts that follow them, and their weighted mean; compiled.

Noise is drawn at knots and is linear between them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, kernel
from crowdbot.plugins.planners.mppi.lanes_build import (
    KEPT,
    LANES,
    RolloutLanes,
    begin,
    go_on,
    keep,
    move,
    next_knot,
    resting_lanes,
    slew,
    weigh,
)
from crowdbot.plugins.planners.shared.braking_build import MotionState

#: Indices into the parameter vector.
A_MAX, ALPHA_MAX, V_MIN, V_MAX, W_MAX, VY_MAX, DT, TEMPERATURE, CONTROL = range(9)
COMFORT, GROWTH, PROGRESS, HEADING, CLEARANCE, COLLISION, BACKWARD = range(9, 16)
V_NOISE, W_NOISE, TOP = range(16, 19)
PARAMETERS = 19
#: People are tested in every n-th step, walls and progress in every m-th.
PEOPLE_EVERY, WALLS_EVERY = 4, 2
#: At most this many people are predicted, the nearest.
MOST_PEOPLE = 30
#: Rollouts that cost this many temperatures more than the least do not count: e^-9 = 1e-4.
COUNTS = 9.0


class Samples(NamedTuple):
    """The sampler's arrays: plan, noise and costs.

    Attributes:
        plan: (T, 3) v, w, vy of the current plan.
        noise: (K, 3, B) standard normal numbers at the knots, drawn once, in single precision; B
            is the number of rollouts, rounded up to full lanes.
        costs: of rollouts, first those with noise.
        simple: (S, T, 3) simple plans that are rolled out as well; at most `LANES`.
        mean: (K, 3) of the noise, scratch.
        near: (T, N, 3) place of people who can come near in each step, and radius, m, scratch.
        counts: (T,) number of these, scratch.
        lanes: rollouts on their way, scratch.
        kept: (T / 2, KEPT, LANES) what they pass, scratch.
    """

    plan: Array
    noise: NDArray[np.float32]
    costs: Array
    simple: Array
    mean: Array
    near: Array
    counts: NDArray[np.int64]
    lanes: RolloutLanes
    kept: Array


@kernel
def shift(plan: Array) -> None:
    """Shift the plan by one step; the last control is repeated."""
    for n in range(plan.shape[0] - 1):
        for c in range(3):
            plan[n, c] = plan[n + 1, c]


@kernel
def _limited(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)


@kernel
def drive(
    goal: tuple[float, float],
    p: Array,
    state: MotionState,
    samples: Samples,
    first: int,
    noisy: bool,
) -> None:
    """Move rollouts along noisy or simple plans, from number ``first``, and store their poses."""
    begin(samples.lanes, state)
    if noisy:
        _weigh(p, samples, first)
    lanes, plan = samples.lanes, samples.plan
    axes, dv, dw = 3 if p[VY_MAX] > 0.0 else 2, p[A_MAX] * p[DT], p[ALPHA_MAX] * p[DT]
    share, knot = 1.0 if noisy else 0.0, 0  # simple plans are not added to the plan
    for n in range(plan.shape[0]):
        if noisy:
            knot = _noise(p, samples, (first, axes), n, knot)
        else:
            _simple(samples, n, axes)
        slew(lanes.v, share * plan[n, 0], lanes.more[0], (p[V_MIN], p[TOP], dv))
        slew(lanes.w, share * plan[n, 1], lanes.more[1], (-p[W_MAX], p[W_MAX], dw))
        if axes > 2:
            slew(lanes.vy, share * plan[n, 2], lanes.more[2], (-p[VY_MAX], p[VY_MAX], dv))
        move(lanes, p[DT])
        if n % WALLS_EVERY == 0:
            keep(lanes, goal, samples.kept[n // WALLS_EVERY])


@kernel
def _weigh(p: Array, samples: Samples, first: int) -> None:
    """Add up the cost of noise along the plan."""
    plan, noise, till = samples.plan, samples.noise, first + LANES
    long = (plan.shape[0] - 1) / (noise.shape[0] - 1)
    for k in range(noise.shape[0]):
        n = min(int(k * long), plan.shape[0] - 1)
        both = noise[k, 0, first:till], noise[k, 1, first:till]
        at, sizes = (plan[n, 0], plan[n, 1]), (p[V_NOISE], p[W_NOISE])
        weigh(samples.lanes.control, at, both, sizes)


@kernel
def _noise(p: Array, samples: Samples, part: tuple[int, int], n: int, knot: int) -> int:
    """Write what noise adds in step n; return the number of the next knot.

    Args:
        p: parameters.
        samples: the arrays.
        part: number of the first rollout, and of axes.
        n: the step.
        knot: the next knot.
    """
    noise, (first, axes), till = samples.noise, part, part[0] + LANES
    long = (samples.plan.shape[0] - 1) / (noise.shape[0] - 1)
    fresh = n >= knot * long and knot < noise.shape[0] - 1
    for k in range(axes):
        more, grow = samples.lanes.more[k], samples.lanes.grow[k]
        if fresh:
            both = noise[knot, k, first:till], noise[knot + 1, k, first:till]
            size = p[W_NOISE] if k == 1 else p[V_NOISE]
            next_knot((more, grow), both, size, n - knot * long, long)
        else:
            go_on(more, grow)
    return knot + 1 if fresh else knot


@kernel
def _simple(samples: Samples, n: int, axes: int) -> None:
    """Write step n of the simple plans."""
    for k in range(axes):
        for i in range(samples.simple.shape[0]):
            samples.lanes.more[k, i] = samples.simple[i, n, k]


@kernel
def weighted_mean(p: Array, samples: Samples, least: float) -> None:
    """Replace the plan by the mean of the rollouts' controls, weighted by exp(-cost)."""
    plan, noise, mean = samples.plan, samples.noise, samples.mean
    noisy, simple, count = 0.0, 0.0, samples.costs.shape[0] - samples.simple.shape[0]
    for k in range(mean.shape[0]):
        for c in range(3):
            mean[k, c] = 0.0
    for b in range(samples.costs.shape[0]):
        over = (samples.costs[b] - least) / p[TEMPERATURE]
        weight = math.exp(-over) if over < COUNTS else 0.0
        samples.costs[b] = weight
        if b >= count:
            simple += weight
            continue
        noisy += weight
        if weight > 0.0:
            for k in range(mean.shape[0]):
                for c in range(3):
                    mean[k, c] += weight * noise[k, c, b]
    total, segment = noisy + simple, (plan.shape[0] - 1) / (mean.shape[0] - 1)
    for n in range(plan.shape[0]):
        k = min(int(n / segment), mean.shape[0] - 2)
        part = n / segment - k
        for c in range(3):
            size = p[W_NOISE] if c == 1 else p[V_NOISE]
            value = noisy * plan[n, c]
            value += size * ((1.0 - part) * mean[k, c] + part * mean[k + 1, c])
            for m in range(samples.simple.shape[0]):
                value += samples.costs[count + m] * samples.simple[m, n, c]
            low, high = (p[V_MIN], p[TOP]) if c == 0 else (-p[VY_MAX], p[VY_MAX])
            if c == 1:
                low, high = -p[W_MAX], p[W_MAX]
            plan[n, c] = _limited(value / total, low, high)


def drawn(samples: int, steps: int, knots: int, simple: int, seed: int) -> Samples:
    """Return new arrays of a sampler, with its noise drawn.

    Args:
        samples, steps, knots, simple: counts.
        seed: of the noise.
    """
    full = np.zeros((knots, 3, math.ceil(samples / LANES) * LANES), np.float32)
    noise = np.random.default_rng(seed).standard_normal((samples, knots, 3))
    full[:, :, 1:samples] = noise[1:].transpose(1, 2, 0)
    return Samples(
        plan=np.zeros((steps, 3)), noise=full, costs=np.zeros(samples + simple),
        simple=np.zeros((simple, steps, 3)), mean=np.zeros((knots, 3)),
        near=np.zeros((steps, MOST_PEOPLE, 3)), counts=np.zeros(steps, np.int64),
        lanes=resting_lanes(), kept=np.zeros((math.ceil(steps / WALLS_EVERY), KEPT, LANES)),
    )  # fmt: skip
