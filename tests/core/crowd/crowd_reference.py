"""The two cost functions again, in plain numpy, straight from their formulas.

Everything is evaluated for all candidates at once and without any shortcut: no budget, no culling,
no table. Used to check that the compiled ones take the same decisions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.policy import CrowdView
from crowdbot.plugin import CostFunctionSpec
from crowdbot.plugins.crowd.cost_functions.rvo import RvoSpec
from crowdbot.plugins.crowd.cost_functions.ttca_dca.ttca_dca import TtcaDcaSpec

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Situation:
    """What one agent sees: itself, the preferred velocity, others (M, 5) x, y, vx, vy, radius."""

    position: Array
    velocity: Array
    radius: float
    preferred: Array
    max_speed: float
    others: Array
    walls: Array


def situation(view: CrowdView, i: int) -> Situation:
    """Agent i's; the preferred velocity is zero when it has arrived."""
    a = view.agents
    goal = view.goal[i] - view.position[i]
    distance = float(np.hypot(*goal))
    arrived = distance <= a.radius[i]
    preferred = np.zeros(2) if arrived else a.preferred_speed[i] * goal / distance
    people = np.column_stack([view.position, view.velocity, a.radius])
    seen = view.present & (np.arange(len(a)) != i)
    return Situation(
        position=view.position[i], velocity=view.velocity[i], radius=float(a.radius[i]),
        preferred=preferred, max_speed=float(a.max_speed[i]),
        others=np.concatenate([people[seen], view.robot]), walls=view.walls,
    )  # fmt: skip


def cost(spec: CostFunctionSpec, s: Situation, u: Array) -> Array:
    """Weighted cost (S,) of the candidates u (S, 2); inf is forbidden."""
    if isinstance(spec, TtcaDcaSpec):
        return spec.weight * _ttca_dca(spec, s, u)
    assert isinstance(spec, RvoSpec)
    return spec.weight * _rvo(spec, s, u)


def _in_range(value: float, surface: bool, s: Situation) -> Array:
    offset = s.others[:, :2] - s.position
    limit = value + (s.radius + s.others[:, 4] if surface else 0.0)
    return s.others[np.hypot(offset[:, 0], offset[:, 1]) < limit]


def _ttca_dca(spec: TtcaDcaSpec, s: Situation, u: Array) -> Array:
    weighted, weights = np.zeros(len(u)), 0.0
    for x, y, vx, vy, r in _in_range(spec.range.value, spec.range.measure == "surface", s):
        d = np.array([x, y]) - s.position
        if d @ s.velocity < 0.0:
            continue
        distance = max(float(np.hypot(*d)), 1e-6)
        gap = distance - s.radius - r
        q, n = d * gap / distance, np.array([-d[1], d[0]])
        w = np.array([vx, vy]) - u
        w = w + np.outer(w @ n, n)
        speed2 = np.sum(w * w, axis=1)
        t = np.maximum(0.0, -(w @ q) / np.where(speed2 > 0.0, speed2, 1.0))
        nearest = q + t[:, np.newaxis] * w
        dca = np.hypot(nearest[:, 0], nearest[:, 1])
        k = 1.0 / max(gap * gap, 1e-12)
        weighted += k * np.exp(-0.5 * ((t / spec.sigma_ttca) ** 2 + (dca / spec.sigma_dca) ** 2))
        weights += k
    avoid = weighted / weights if weights > 0.0 else weighted
    speed, wanted = np.hypot(u[:, 0], u[:, 1]), float(np.hypot(*s.preferred))
    cross = s.preferred[0] * u[:, 1] - s.preferred[1] * u[:, 0]
    angle = np.where(speed > 0.0, np.abs(np.arctan2(cross, u @ s.preferred)), 0.0)
    goal = np.exp(-0.5 * (angle / spec.sigma_angle_goal) ** 2)
    pace = np.exp(-0.5 * ((speed - wanted) / spec.sigma_speed_goal) ** 2)
    return np.asarray(avoid + 1.0 - 0.5 * (goal + pace))


def _rvo(spec: RvoSpec, s: Situation, u: Array) -> Array:
    surface = spec.range.measure == "surface"
    seen_as = 2.0 * u - s.velocity
    first = np.full(len(u), np.inf)
    for x, y, vx, vy, r in _in_range(spec.range.value, surface, s):
        offset = np.array([x, y]) - s.position
        if offset @ offset > (s.radius + r) ** 2:
            first = np.minimum(first, disc_time(offset, seen_as - [vx, vy], s.radius + r))
    for wall in s.walls:
        a, b = wall[:2] - s.position, wall[2:] - s.position
        along = np.clip(-(a @ (b - a)) / ((b - a) @ (b - a)), 0.0, 1.0)
        distance = float(np.hypot(*(a + along * (b - a))))
        if s.radius < distance <= spec.range.value + (s.radius if surface else 0.0):
            first = np.minimum(first, segment_time(a, b, seen_as, s.radius))
    miss = np.hypot(u[:, 0] - s.preferred[0], u[:, 1] - s.preferred[1])
    fast = np.hypot(u[:, 0], u[:, 1]) > s.max_speed * (1.0 + 1e-12)
    with np.errstate(divide="ignore"):
        return np.where(fast, np.inf, spec.w / first + miss)


def disc_time(offset: Array, v: Array, reach: float) -> Array:
    """Time (S,) until a point at the origin with velocity v (S, 2) is ``reach`` from offset."""
    a, b = np.sum(v * v, axis=1), -2.0 * (v @ offset)
    c = float(offset @ offset) - reach * reach
    root = b * b - 4.0 * a * c
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (-b - np.sqrt(root)) / (2.0 * a)
    return np.where((root > 0.0) & (b < 0.0) & (a > 0.0), t, np.inf)


def segment_time(a: Array, b: Array, v: Array, radius: float) -> Array:
    """Time (S,) until a disc at the origin touches segment a-b."""
    first = np.minimum(disc_time(a, v, radius), disc_time(b, v, radius))
    length = float(np.hypot(*(b - a)))
    along, normal = (b - a) / length, np.array([a[1] - b[1], b[0] - a[0]]) / length
    distance = float(a @ normal)
    closing = (v @ normal) * np.sign(distance)
    with np.errstate(divide="ignore", invalid="ignore"):
        touch = np.maximum(0.0, (abs(distance) - radius) / closing)
        at = v @ along * touch - a @ along
    hit = (closing > 1e-5 / length) & (at >= 0.0) & (at <= length)
    return np.minimum(first, np.where(hit, touch, np.inf))


def choice_costs(
    view: CrowdView, specs: list[CostFunctionSpec], candidates: Array, i: int
) -> tuple[Array, Array]:
    """Candidates (S, 2) of agent i in the world frame and their total costs (S,)."""
    s = situation(view, i)
    ex, ey = s.preferred
    u = np.column_stack(
        [
            candidates[:, 0] * ex - candidates[:, 1] * ey,
            candidates[:, 0] * ey + candidates[:, 1] * ex,
        ]
    )
    total = np.zeros(len(u))
    for spec in specs:
        total = total + cost(spec, s, u)
    return u, total


def agents_of(
    position: Array,
    speed: float | Array = 1.2,
    radius: float | Array = 0.33,
    max_speed: float | Array = 3.0,
    max_acceleration: float | Array = 5.0,
) -> Agents:
    """A table of agents that start at (N, 2)."""
    n = len(position)

    def all_of(value: float | Array) -> Array:
        return np.array(np.broadcast_to(value, (n,)), np.float64)

    return Agents.of(
        id=np.arange(n), x=position[:, 0].copy(), y=position[:, 1].copy(),
        preferred_speed=all_of(speed), radius=all_of(radius), max_speed=all_of(max_speed),
        max_acceleration=all_of(max_acceleration), mass=all_of(75.0),
    )  # fmt: skip
