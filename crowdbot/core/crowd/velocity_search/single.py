"""Candidates in single precision, as the original engine computes them; for parity only.

The outer ring of a fan often lies at exactly the largest speed. Whether its candidates count as
too fast is then a matter of rounding, so the rounding has to be the original's.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.crowd.velocity_search.candidates import (
    ALONG_CURRENT,
    CURRENT,
    UNIT,
    FanOptions,
    Sampling,
    radius_of,
)
from crowdbot.core.crowd.velocity_search.minstd import between, following
from crowdbot.core.crowd.velocity_search.records import AgentRecord
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array


def polar(sampling: Sampling) -> Array:
    """Return angle and ring (S, 2) of the regular candidates; the ring of the base is 0."""
    s = sampling
    half, closed = np.float32(0.5 * s.opening), math.isclose(s.opening, 2.0 * math.pi)
    step = np.float32(2.0) * half / np.float32(s.angles if closed else max(1, s.angles - 1))
    steps = np.full(s.angles, step, np.float32)
    steps[0] = -half
    theta = np.cumsum(steps, dtype=np.float32)  # step by step, with the original's rounding
    first, last = (1, s.speeds) if s.include_base else (1, s.speeds + 1)
    rings = [np.column_stack([theta, np.full(s.angles, float(k))]) for k in range(first, last)]
    return np.concatenate([np.zeros((1 if s.include_base else 0, 2)), *rings])


@kernel
def single_candidates(
    agent: AgentRecord, options: FanOptions, regular: Array, world: Array
) -> None:
    """Fill ``world`` (S, 2) with candidates in the world frame; draws random ones again.

    Args:
        regular: (S, 2) from `polar`, not used for random ones.
    """
    base, drawn, half = options.base, options.drawn, options.half
    ex, ey = _direction(agent, options.direction)
    scale = np.float32(radius_of(agent, options.radius))
    bx = np.float32(agent.vx if base == CURRENT else 0.0)
    by = np.float32(agent.vy if base == CURRENT else 0.0)
    rings = 0.0 if drawn else regular[-1, 1]
    state = int(agent.random)
    for s in range(world.shape[0]):
        if drawn:
            state = following(state)
            angle = float(between(state, -half, half))
            state = following(state)
            length = np.float32(between(state, 0.0, float(scale)))
        else:
            angle = regular[s, 0]
            length = np.float32(scale / np.float32(rings)) * np.float32(regular[s, 1])
        cosine, sine = math.cos(angle), math.sin(angle)
        x = np.float32(np.float32(cosine * float(ex) - sine * float(ey)) * length)
        y = np.float32(np.float32(sine * float(ex) + cosine * float(ey)) * length)
        world[s, 0], world[s, 1] = float(np.float32(bx + x)), float(np.float32(by + y))
    agent.random = float(state)


@kernel
def _direction(agent: AgentRecord, kind: int) -> tuple[np.float32, np.float32]:
    if kind == UNIT:
        return np.float32(1.0), np.float32(0.0)
    if kind == ALONG_CURRENT:
        return _normalised(np.float32(agent.vx), np.float32(agent.vy))
    x, y = _normalised(
        np.float32(agent.gx) - np.float32(agent.px), np.float32(agent.gy) - np.float32(agent.py)
    )
    speed = np.float32(agent.preferred)
    return _normalised(np.float32(x * speed), np.float32(y * speed))


@kernel
def _normalised(x: np.float32, y: np.float32) -> tuple[np.float32, np.float32]:
    length = np.float32(np.sqrt(np.float32(np.float32(x * x) + np.float32(y * y))))
    if length == np.float32(0.0):
        return np.float32(0.0), np.float32(0.0)
    return np.float32(x / length), np.float32(y / length)
