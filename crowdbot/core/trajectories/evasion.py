"""People's reactions near the robot: accelerations, and the robot's share in them.

N samples, M people; world frame, SI units. Accelerations belong to steps, not samples.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.trajectories.encounters import (
    encounter,
    people,
    people_velocities,
    robot_velocities,
)
from crowdbot.core.trajectories.preprocess import samples_of_shorter
from crowdbot.core.trajectories.touched import touched
from crowdbot.core.trajectories.trajectories import Trajectories, cached_beside
from crowdbot.core.trajectories.trips import DISTANCE_TOLERANCE
from crowdbot.core.types.arrays import Array, Indices, Mask

#: Times closer than this are equal, s.
SAME_TIME = 1e-6

_T = TypeVar("_T", bound=np.generic)
_Both = tuple[Trajectories, Trajectories]


@dataclass(frozen=True, slots=True, kw_only=True)
class Evasion:
    """Accelerations of people on steps near the robot; 0 elsewhere.

    Attributes:
        dt: (N-1,) lengths of the steps, s.
        near: (N-1, M) steps on which a person is near and moves continuously.
        size: (N-1, M) magnitude of the acceleration, m/s².
        away: (N-1, M) the part that points away from the robot, never negative, m/s².
        approach: (N-1, M) speed of the robot towards the person, never negative, m/s.
        nx, ny: (N-1, M) direction from the robot to the person.
    """

    dt: Array
    near: Mask
    size: Array
    away: Array
    approach: Array
    nx: Array
    ny: Array

    @property
    def met(self) -> Mask:
        """Return people (M,) who are near on some step."""
        return np.asarray(self.near.any(axis=0))

    def push(self, share: Array | float = 1.0) -> Array:
        """Return the robot's work against each person's acceleration, per mass (M,), J/kg.

        Args:
            share: (N-1, M) of each step that counts.
        """
        return np.asarray(self.dt @ (self.away * self.approach * share))

    def work(self, mass: Array, share: Array | float = 1.0) -> float:
        """Return the robot's work against people who accelerate away from it, J.

        Args:
            mass: (M,) people's masses, kg.
            share: (N-1, M) of each step that counts.
        """
        return float(self.push(share) @ mass)

    def rms(self) -> float:
        """Return the root mean square acceleration over people and time near the robot, m/s²."""
        time = float(self.dt @ self.near.sum(axis=1))
        return float(np.sqrt(self.dt @ (self.size**2).sum(axis=1) / time)) if time > 0 else 0.0


def evasion(run: Trajectories, reach: float, jump_speed: float) -> Evasion:
    """Return accelerations within ``reach`` (m, centre to centre) of the robot, which must exist.

    ``jump_speed`` (m/s) detects teleports if none were recorded.
    """
    return run.cached(("evasion", reach, jump_speed), lambda: _evasion(run, reach, jump_speed))


def _evasion(run: Trajectories, reach: float, jump_speed: float) -> Evasion:
    """Compute accelerations only for the few people who are near at a time."""
    pair, dt = encounter(run, jump_speed), np.diff(run.t)
    limit = reach + DISTANCE_TOLERANCE
    step, agent = np.nonzero(pair.valid & (np.abs(_middle(pair.px)) <= limit))
    px, py = (_at_middle(p, step, agent) for p in (pair.px, pair.py))
    distance = np.hypot(px, py)
    rx, ry = (_middle(v)[step] for v in robot_velocities(run, jump_speed))
    ax, ay = (
        (v[step + 1, agent] - v[step, agent]) / dt[step] for v in people_velocities(run, jump_speed)
    )
    known = np.isfinite(ax) & np.isfinite(ay) & np.isfinite(rx) & np.isfinite(ry)
    near = known & (distance <= limit)
    there = near & (distance > 0.0)
    nx, ny = (np.divide(p, distance, out=np.zeros(p.shape), where=there) for p in (px, py))

    def spread(values: NDArray[_T]) -> NDArray[_T]:
        """Expand values to all steps and people; 0 if not near."""
        whole = np.zeros(pair.valid.shape, values.dtype)
        whole[step, agent] = values
        return whole

    return Evasion(
        dt=dt,
        near=spread(near),
        size=spread(np.where(near, np.hypot(ax, ay), 0.0)),
        away=spread(np.where(there, np.maximum(ax * nx + ay * ny, 0.0), 0.0)),
        approach=spread(np.where(there, np.maximum(rx * nx + ry * ny, 0.0), 0.0)),
        nx=spread(nx),
        ny=spread(ny),
    )


def own_legs(run: Trajectories, reach: float, jump_speed: float) -> Mask:
    """Return a mask of steps (N-1, M) near the robot on which nothing touches the person.

    A person pushed by others, a wall or the robot does not evade by itself; contacts are counted
    separately.
    """
    near = evasion(run, reach, jump_speed).near
    key = "own_legs", reach, jump_speed
    return run.cached(key, lambda: near & ~touched(run, near, jump_speed))


def ghost_run(run: Trajectories, alone: Trajectories) -> _Both | None:
    """Return the run, and its robot as a ghost among people who never met a robot.

    The ghost's values are what happens without a robot. Both have the length of the shorter record;
    None if they were not sampled at the same times after the start.
    """
    both = samples_of_shorter(run, alone)
    ghost = cached_beside(run, alone, "ghost", lambda: _ghost_run(*both))
    return None if ghost is None else (both[0], ghost)


def _ghost_run(run: Trajectories, alone: Trajectories) -> Trajectories | None:
    since, other = run.t - run.t[0], alone.t - alone.t[0]
    if len(since) != len(other) or np.any(np.abs(since - other) > SAME_TIME):
        return None
    return replace(run, agents=people(alone), trips=alone.trips, contacts=None)


def _middle(values: Array) -> Array:
    """Return the mean of both ends of each step."""
    return (values[1:] + values[:-1]) / 2.0


def _at_middle(values: Array, step: Indices, agent: Indices) -> Array:
    """Like `_middle`, for some steps and people."""
    return (values[step + 1, agent] + values[step, agent]) / 2.0
