"""Who passes whom on the way in the same direction, computed.

Bodies are the robot (0) and the people (1 to M); L = M + 1.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.interfaces import (
    Array,
    Mask,
    References,
    Score,
    ScoreFactory,
    Trajectories,
    truncate_at_arrival,
)
from crowdbot.core.trajectories.encounters import (
    people,
    people_velocities,
    robot_of,
    robot_velocities,
)
from crowdbot.core.trajectories.preprocess import inf_to_nan, valid_agent_steps, valid_robot_steps
from crowdbot.plugins.metrics.overtaking import OVERTAKING_COUNT, OvertakingCountSpec

#: Slack of the rules on speed (m/s), angle (rad) and side (m), so that rounding decides nothing.
TOLERANCE = 1e-9
#: Samples that are looked at together; bounds the memory that L x L tables take.
CHUNK = 8
#: Farther than anybody, m. Not inf: some BLAS kernels multiply it by a padding of zeros.
_FAR = 1e300

Index = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class OvertakingCount:
    """Needs no reference run; without people nobody is overtaken."""

    spec: OvertakingCountSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """``literal``: all times the robot passed; ``corrected``: less those it was passed."""
        del refs
        factory = ScoreFactory(OVERTAKING_COUNT)
        if run.robot is None:
            return factory.all_undefined("invalid_no_robot")
        counts = overtakes(OvertakingBodies.of(truncate_at_arrival(run), self.spec), self.spec)
        net = np.maximum(0, counts - counts.T)
        return [
            factory.ok(variant, n[0].sum(), _extras(n, counts))
            for variant, n in (("literal", counts), ("corrected", net))
        ]


@dataclass(frozen=True, slots=True)
class OvertakingBodies:
    """Robot and people: x, y, ux, uy (direction), walks are (N, L); valid is (N-1, L)."""

    x: Array
    y: Array
    ux: Array
    uy: Array
    walks: Mask
    valid: Mask

    @classmethod
    def of(cls, run: Trajectories, spec: OvertakingCountSpec) -> OvertakingBodies:
        """All bodies of a run; who does not walk has no direction."""
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

    def ahead(self, k: Index, a: Index, b: Index, *, then: int = 0) -> tuple[Array, Array]:
        """How far b is ahead of a, and beside it, in the direction of a at sample k, m."""
        dx, dy = (
            self.x[k + then, b] - self.x[k + then, a],
            self.y[k + then, b] - self.y[k + then, a],
        )
        ux, uy = self.ux[k, a], self.uy[k, a]
        return dx * ux + dy * uy, dx * uy - dy * ux


def overtakes(bodies: OvertakingBodies, spec: OvertakingCountSpec) -> NDArray[np.int64]:
    """How often row overtook column (L, L)."""
    size = bodies.x.shape[1]
    counts = np.zeros((size, size), dtype=np.int64)
    for k, a, b in _crossings(bodies, spec):
        beside = np.abs(bodies.ahead(k, a, b, then=1)[1])
        cosine = bodies.ux[k, a] * bodies.ux[k, b] + bodies.uy[k, a] * bodies.uy[k, b]
        same_way = bodies.walks[k, b] & (cosine >= np.cos(spec.overtake_angle) - TOLERANCE)
        counted = same_way & (beside <= spec.overtake_lateral + TOLERANCE)
        k, a, b = k[counted], a[counted], b[counted]
        armed = bodies.ahead(k, a, b)[0] > spec.overtake_eps
        for row in np.flatnonzero(~armed):  # level now; who was ahead before?
            armed[row] = _armed(bodies, spec, int(k[row]), int(a[row]), int(b[row]))
        np.add.at(counts, (a[armed], b[armed]), 1)
    return counts


def _crossings(
    bodies: OvertakingBodies, spec: OvertakingCountSpec
) -> Iterator[tuple[Index, Index, Index]]:
    """Steps k on which b falls behind a, and was not behind before.

    Who falls behind during a step was no farther ahead than both may have moved: that leaves few
    pairs, found by one product of matrices.
    """
    x, y, ux, uy = (np.nan_to_num(v) for v in (bodies.x, bodies.y, bodies.ux, bodies.uy))
    moves = np.where(bodies.valid, np.hypot(np.diff(x, axis=0), np.diff(y, axis=0)), 0.0)
    half = moves.max(axis=1, initial=0.0)[:, None] + spec.overtake_eps + TOLERANCE
    middle = x[:-1] * ux[:-1] + y[:-1] * uy[:-1] + (half - spec.overtake_eps - TOLERANCE)
    drives = bodies.walks[:-1] & bodies.valid
    left = np.stack([ux[:-1], uy[:-1], np.where(drives, -middle, _FAR)], axis=2)
    right = np.stack([x, y, np.ones_like(x)], axis=1)
    size = x.shape[1]
    offset, near = np.empty((CHUNK, size, size)), np.empty((CHUNK, size, size), dtype=bool)
    for start in range(0, len(moves), CHUNK):
        rows = slice(start, min(start + CHUNK, len(moves)))
        count = rows.stop - start
        # how far b is ahead of a, minus the middle of where it may be
        np.matmul(left[rows], right[rows], out=offset[:count])
        np.abs(offset[:count], out=offset[:count])
        np.less_equal(offset[:count], half[rows, :, None], out=near[:count])
        k, pair = np.divmod(np.flatnonzero(near[:count]), size * size)
        a, b = np.divmod(pair, size)
        k += start
        keep = (a != b) & bodies.valid[k, b]
        k, a, b = k[keep], a[keep], b[keep]
        now, then = bodies.ahead(k, a, b)[0], bodies.ahead(k, a, b, then=1)[0]
        falls = (now >= -spec.overtake_eps) & (then < -spec.overtake_eps)
        yield k[falls], a[falls], b[falls]


def _armed(bodies: OvertakingBodies, spec: OvertakingCountSpec, k: int, a: int, b: int) -> bool:
    """Whether b was clearly ahead of a before it fell behind; looks back while they are level."""
    for before in range(k, -1, -1):
        if not (bodies.walks[before, a] and bodies.valid[before, a] and bodies.valid[before, b]):
            return False
        at = np.array([before]), np.array([a]), np.array([b])
        if before < k and bodies.ahead(*at, then=1)[0][0] < -spec.overtake_eps:
            return False  # it fell behind on that step already, by the direction of that step
        now = bodies.ahead(*at)[0][0]
        if abs(now) > spec.overtake_eps:
            return bool(now > 0)
    return False


def _extras(n: NDArray[np.int64], counts: NDArray[np.int64]) -> Mapping[str, float]:
    extras = {"overtaken_by": float(counts[:, 0].sum())}
    if len(n) > 1:
        mean = float(n[1:].sum()) / (len(n) - 1)
        extras |= {"agent_mean": mean, "excess": float(n[0].sum()) - mean}
    return extras
