"""Scoring of overtaking in the same direction.

Bodies are the robot (0) and the people (1 to M); L = M + 1.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import (
    Array,
    Mask,
    References,
    Score,
    Trajectories,
    inline_kernel,
    kernel,
    truncate_at_arrival,
)
from crowdbot.plugin.for_metrics import (
    inf_to_nan,
    people,
    people_velocities,
    robot_of,
    robot_velocities,
    valid_agent_steps,
    valid_robot_steps,
)
from crowdbot.plugins.metrics.declared_build import DeclaredMetric, UndefinedError
from crowdbot.plugins.metrics.overtaking import OvertakingCountSpec

#: Tolerances for speed (m/s), angle (rad) and side (m), so that rounding does not decide.
TOLERANCE = 1e-9
#: Tolerance for skipping pairs, m: rounding must not skip a pair that counts.
_SLACK = 1e-3

Index = NDArray[np.intp]


class OvertakingCount(DeclaredMetric[OvertakingCountSpec]):
    """Scores ``overtaking_count``: people overtaken, minus those who overtook the robot.

    ``literal``: people overtaken. Without people the count is 0.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        if run.robot is None:
            raise UndefinedError("invalid_no_robot")
        counts = overtakes(OvertakingBodies.of(truncate_at_arrival(run), self.spec), self.spec)
        net = np.maximum(0, counts - counts.T)
        return [
            self.factory.ok(variant, n[0].sum(), _extras(n, counts))
            for variant, n in (("literal", counts), ("corrected", net))
        ]


class OvertakingBodies(NamedTuple):
    """Robot and people: x, y, ux, uy (direction), walks are (N, L); valid is (N-1, L)."""

    x: Array
    y: Array
    ux: Array
    uy: Array
    walks: Mask
    valid: Mask

    @classmethod
    def of(cls, run: Trajectories, spec: OvertakingCountSpec) -> OvertakingBodies:
        """Return all bodies of a run; bodies that do not walk have no direction."""
        robot, agents = robot_of(run), people(run)
        vectors = robot_velocities(run, spec.jump_speed), people_velocities(run, spec.jump_speed)
        vx, vy = (np.column_stack(pair) for pair in zip(*vectors, strict=True))
        speed = np.hypot(vx, vy)
        walks = speed > spec.heading_min_speed + TOLERANCE
        length = np.where(walks, speed, np.inf)
        steps = (
            valid_robot_steps(run.t, robot, spec.jump_speed),
            valid_agent_steps(run.t, agents, spec.jump_speed),
        )
        return cls(
            x=inf_to_nan(np.column_stack([robot.x, agents.x])),
            y=inf_to_nan(np.column_stack([robot.y, agents.y])),
            ux=np.where(walks, vx, 0.0) / length,
            uy=np.where(walks, vy, 0.0) / length,
            walks=walks,
            valid=np.column_stack(steps),
        )


class _Rule(NamedTuple):
    """The rule for who overtakes whom, with tolerances included.

    Attributes:
        level: bodies closer than this along the way are side by side, m.
        lateral: largest sideways distance that counts, m.
        cosine: cosine of the largest angle between both directions.
    """

    level: float
    lateral: float
    cosine: float


def overtakes(bodies: OvertakingBodies, spec: OvertakingCountSpec) -> NDArray[np.int64]:
    """Return how often the row overtook the column (L, L)."""
    size = bodies.x.shape[1]
    counts = np.zeros((size, size), dtype=np.int64)
    rule = _Rule(
        level=spec.overtake_eps,
        lateral=spec.overtake_lateral + TOLERANCE,
        cosine=float(np.cos(spec.overtake_angle)) - TOLERANCE,
    )
    _count(bodies, rule, np.arange(size), np.empty(size), counts)
    return counts


@kernel
def _count(
    bodies: OvertakingBodies, rule: _Rule, order: Index, at: Array, counts: NDArray[np.int64]
) -> None:
    """Count who overtakes whom, step by step.

    An overtaken body is near: not farther aside than the rule allows, and not farther behind than
        both can have moved. So only bodies close in x are compared.

    Args:
        bodies, rule: the motion and the rule.
        order: (L,) the bodies in any order; sorted by x afterwards.
        at: (L,) scratch space for x after the step.
        counts: (L, L) output: how often the row overtook the column.
    """
    size = bodies.x.shape[1]
    for k in range(bodies.valid.shape[0]):
        most = _place(bodies, k, at)
        _sort(order, at)
        behind = rule.level + 2.0 * most + _SLACK
        for place in range(size):
            a = order[place]
            if at[a] == math.inf:
                break
            if bodies.walks[k, a]:
                # In x, those behind by this much and aside by that much.
                reach = behind * abs(bodies.ux[k, a]) + rule.lateral * abs(bodies.uy[k, a]) + _SLACK
                for one_way in (-1, 1):
                    other = place + one_way
                    while 0 <= other < size and abs(at[order[other]] - at[a]) <= reach:
                        _count_pair(bodies, rule, behind, k, a, order[other], counts)
                        other += one_way


@inline_kernel
def _count_pair(
    bodies: OvertakingBodies,
    rule: _Rule,
    behind: float,
    k: int,
    a: int,
    b: int,
    counts: NDArray[np.int64],
) -> None:
    """Count it if a overtakes b on a step; farther behind than `behind` it cannot have been."""
    ahead, beside = _ahead(bodies, k, a, b, 1)
    # Test first what is nearly always false: a mispredicted branch costs more than the rest.
    if abs(ahead) > behind or abs(beside) > rule.lateral or ahead >= -rule.level:
        return
    if _same_way(bodies, rule.cosine, k, a, b):
        counts[a, b] += _armed(bodies, rule.level, k, a, b)


@kernel
def _place(bodies: OvertakingBodies, k: int, at: Array) -> float:
    """Write x of all bodies after a step, inf if invalid; return the longest move, m."""
    most = 0.0
    for b in range(at.shape[0]):
        at[b] = math.inf
        if bodies.valid[k, b]:
            at[b] = bodies.x[k + 1, b]
            dx, dy = at[b] - bodies.x[k, b], bodies.y[k + 1, b] - bodies.y[k, b]
            most = max(most, math.sqrt(dx * dx + dy * dy))
    return most


@kernel
def _sort(order: Index, at: Array) -> None:
    """Sort the bodies by x with insertion sort, since a step leaves them nearly sorted."""
    for i in range(1, order.shape[0]):
        body, place = order[i], i
        while place > 0 and at[order[place - 1]] > at[body]:
            order[place] = order[place - 1]
            place -= 1
        order[place] = body


@inline_kernel
def _ahead(bodies: OvertakingBodies, k: int, a: int, b: int, then: int) -> tuple[float, float]:
    """Return how far b is ahead of a and beside it at sample k, in a's direction, m."""
    dx = bodies.x[k + then, b] - bodies.x[k + then, a]
    dy = bodies.y[k + then, b] - bodies.y[k + then, a]
    ux, uy = bodies.ux[k, a], bodies.uy[k, a]
    return dx * ux + dy * uy, dx * uy - dy * ux


@inline_kernel
def _same_way(bodies: OvertakingBodies, cosine: float, k: int, a: int, b: int) -> bool:
    """Return True if b walks in nearly the same direction as a; ``cosine`` is the angle's limit."""
    ux, uy = bodies.ux[k], bodies.uy[k]
    return bool(bodies.walks[k, b] and ux[a] * ux[b] + uy[a] * uy[b] >= cosine)


@kernel
def _armed(bodies: OvertakingBodies, level: float, k: int, a: int, b: int) -> bool:
    """Return True if b was clearly ahead of a at sample k, or before they drew level."""
    for before in range(k, -1, -1):
        if not (bodies.walks[before, a] and bodies.valid[before, a] and bodies.valid[before, b]):
            return False
        if before < k and _ahead(bodies, before, a, b, 1)[0] < -level:
            return False  # b fell behind on that step already, by the direction of that step
        now = _ahead(bodies, before, a, b, 0)[0]
        if abs(now) > level:
            return bool(now > 0.0)
    return False


def _extras(n: NDArray[np.int64], counts: NDArray[np.int64]) -> Mapping[str, float]:
    extras = {"overtaken_by": float(counts[:, 0].sum())}
    if len(n) > 1:
        mean = float(n[1:].sum()) / (len(n) - 1)
        extras |= {"agent_mean": mean, "excess": float(n[0].sum()) - mean}
    return extras
