"""Motion of many rollouts in parallel; compiled.

Each loop iterates over rollouts and uses few arrays, so that the compiler can vectorise it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, kernel
from crowdbot.plugins.planners.shared.braking_build import MotionState

Noise = NDArray[np.float32]
#: Rollouts that move side by side.
LANES = 128
#: Rows of what `keep` writes: place, m, direction, velocity, m/s, way driven backwards and
#: distance to the goal, m.
X, Y, C, S, V, VY, BACK, AWAY = range(8)
KEPT = 8


class RolloutLanes(NamedTuple):
    """State of rollouts that are computed in parallel, (LANES,) each.

    Attributes:
        x, y, c, s: place, m, and direction: cosine and sine of the heading.
        v, w, vy: velocity, m/s and rad/s.
        back: way driven backwards, m.
        control: cost of noise along the plan, gamma u·e / sigma^2, summed over knots.
        more: (3, LANES) what noise adds to v, w, vy; grow: (3, LANES) its change in a step.
    """

    x: Array
    y: Array
    c: Array
    s: Array
    v: Array
    w: Array
    vy: Array
    back: Array
    control: Array
    more: Array
    grow: Array


def resting_lanes() -> RolloutLanes:
    """Return rollouts' states at rest."""

    def one() -> Array:
        return np.zeros(LANES)

    return RolloutLanes(
        x=one(), y=one(), c=one(), s=one(), v=one(), w=one(), vy=one(), back=one(), control=one(),
        more=np.zeros((3, LANES)), grow=np.zeros((3, LANES)),
    )  # fmt: skip


@kernel
def begin(lanes: RolloutLanes, state: MotionState) -> None:
    """Set each rollout to a state: x, y, yaw, v, w, vy."""
    c, s = math.cos(state[2]), math.sin(state[2])
    for i in range(lanes.x.shape[0]):
        lanes.x[i], lanes.y[i], lanes.c[i], lanes.s[i] = state[0], state[1], c, s
        lanes.v[i], lanes.w[i], lanes.vy[i] = state[3], state[4], state[5]
        lanes.back[i] = lanes.control[i] = 0.0
        for k in range(3):
            lanes.more[k, i] = lanes.grow[k, i] = 0.0


@kernel
def weigh(
    control: Array, plan: tuple[float, float], noise: tuple[Noise, Noise], p: tuple[float, float]
) -> None:
    """Add the cost of noise along the plan at a knot.

    Args:
        control: (LANES,) added to.
        plan: v, w.
        noise: (LANES,) of each.
        p: standard deviation of each.
    """
    first, second = noise
    for i in range(control.shape[0]):
        control[i] += plan[0] * first[i] / p[0] + plan[1] * second[i] / p[1]


@kernel
def next_knot(
    noise: tuple[Array, Array],
    knots: tuple[Noise, Noise],
    size: float,
    part: float,
    long: float,
) -> None:
    """Start the interpolation of noise between two knots.

    Args:
        noise: (LANES,) what is added now, and its change in a step; written.
        knots: (LANES,) standard normal numbers of both.
        size: standard deviation.
        part: steps since the first knot.
        long: steps between knots.
    """
    more, grow = noise
    here, following = knots
    for i in range(more.shape[0]):
        change = (following[i] - here[i]) / long * size
        grow[i] = change
        more[i] = here[i] * size + part * change


@kernel
def go_on(more: Array, grow: Array) -> None:
    """Advance the interpolated noise by one step."""
    for i in range(more.shape[0]):
        more[i] += grow[i]


@kernel
def slew(value: Array, target: float, more: Array, limits: tuple[float, float, float]) -> None:
    """Move a velocity to a target plus noise, within limits of value and change."""
    low, high, change = limits
    for i in range(value.shape[0]):
        wish = min(max(target + more[i], low), high)
        value[i] = min(max(wish, value[i] - change), value[i] + change)


@kernel
def move(lanes: RolloutLanes, dt: float) -> None:
    """Rotate and move all rollouts for a time step, s."""
    c, s, w, v, vy = lanes.c, lanes.s, lanes.w, lanes.v, lanes.vy
    for i in range(c.shape[0]):
        turn, before = w[i] * dt, c[i]
        half = 1.0 - 0.5 * turn * turn
        c[i] = before * half - s[i] * turn
        s[i] = s[i] * half + before * turn
    x, y, back = lanes.x, lanes.y, lanes.back
    for i in range(c.shape[0]):
        x[i] += (v[i] * c[i] - vy[i] * s[i]) * dt
    for i in range(c.shape[0]):
        y[i] += (v[i] * s[i] + vy[i] * c[i]) * dt
    for i in range(c.shape[0]):
        back[i] -= min(v[i], 0.0) * dt


@kernel
def keep(lanes: RolloutLanes, goal: tuple[float, float], kept: Array) -> None:
    """Write position, heading, velocity and goal distance of all rollouts (KEPT, LANES)."""
    x, y = lanes.x, lanes.y
    _copy(x, kept[X])
    _copy(y, kept[Y])
    _copy(lanes.c, kept[C])
    _copy(lanes.s, kept[S])
    _copy(lanes.v, kept[V])
    _copy(lanes.vy, kept[VY])
    _copy(lanes.back, kept[BACK])
    away = kept[AWAY]
    for i in range(x.shape[0]):
        gx, gy = goal[0] - x[i], goal[1] - y[i]
        away[i] = math.sqrt(gx * gx + gy * gy)


@kernel
def _copy(source: Array, target: Array) -> None:
    for i in range(source.shape[0]):
        target[i] = source[i]
