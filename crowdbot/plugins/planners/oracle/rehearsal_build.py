"""Plans that are tried beside the crowd of the run, before one of them is driven."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from crowdbot.plugin import Array, Truth
from crowdbot.plugins.planners.oracle.forced_build import Forced
from crowdbot.plugins.planners.people_mpc.plan_world_build import STEP

#: A smaller gap counts as a touch, m.
_TOUCH = 0.02
#: Time between two looks at the crowd, as in recordings: coarser ones see too little work, s.
_LOOK = 0.0625
#: A robot that moves less between looks stands: who touches it then is not touched by it, m.
_STANDS = 0.05 * _LOOK
#: Where no one is nearer to a path than this, as if there was no robot, nothing is tried, m.
_FAR = 0.8


class TriedPath(NamedTuple):
    """A path that the robot simulates beside the crowd before driving it.

    Attributes:
        number: of the plan.
        path: (S, 3) poses after each step, m, rad.
        stops: True if the path ends in a stop instead of going on as planned; then no one may
            touch the robot where it stands either.
    """

    number: int
    path: Array
    stops: bool


class Rehearsal:
    """Finds the first of several plans that touches no one and drives no one aside.

    Attributes:
        steps: of a path that are tried.

    Args:
        time: how far ahead the crowd is simulated, s.
        robot: (D, 3) discs of the robot in its frame: x, y, radius, m.
    """

    def __init__(self, time: float, robot: Array) -> None:
        self.steps, self._robot = math.ceil(time / STEP), robot
        self._forced = Forced(robot)

    def see(self, t: float, truth: Truth) -> None:
        """Note how people moved since the last step."""
        self._forced.see(t, truth)

    def first_clear(
        self, truth: Truth, trials: Iterable[TriedPath], pose: tuple[float, ...]
    ) -> int:
        """Return the number of the first path on which the robot touches no one.

        If there is none, return the path with the latest touch; among equals, the one that
        drives a person aside latest.

        Args:
            truth: the ground truth, whose crowd can be foreseen.
            trials: paths in the order of preference; read only as far as needed.
            pose: the robot's pose now.
        """
        assert truth.foresee is not None
        latest, best = (-1.0, -1.0), 0
        for at, (number, path, stops) in enumerate(trials):
            poses = _looks(np.vstack([[pose], path[: self.steps]]))
            if at == 0 and self._is_far(truth, poses):
                return number
            people = truth.foresee(len(poses) - 1, _LOOK, poses)
            trouble = (
                self._touched(poses, people, truth.people_radius, stands=stops),
                self._forced.when(truth, people, poses, _LOOK),
            )
            if min(trouble) == math.inf:
                return number
            if trouble > latest:
                latest, best = trouble, number
        return best

    def _is_far(self, truth: Truth, poses: Array) -> bool:
        """Return True if no one comes near at the present velocities."""
        t = _LOOK * np.arange(1, len(poses))[:, np.newaxis, np.newaxis]
        people = truth.people + t * truth.people_velocity
        gaps = self._gaps(poses, people, truth.people_radius)
        return bool(np.min(gaps, initial=math.inf) > _FAR)

    def _gaps(self, poses: Array, people: Array, radius: Array) -> Array:
        """Return the gaps (T, N) between robot and people after each step, m."""
        c, s = np.cos(poses[1:, 2]), np.sin(poses[1:, 2])
        gaps = np.full(people.shape[:2], math.inf)
        for x, y, own in self._robot.tolist():
            dx = people[:, :, 0] - (poses[1:, 0] + c * x - s * y)[:, np.newaxis]
            dy = people[:, :, 1] - (poses[1:, 1] + s * x + c * y)[:, np.newaxis]
            gaps = np.minimum(gaps, np.hypot(dx, dy) - own - radius)
        return gaps

    def _touched(self, poses: Array, people: Array, radius: Array, *, stands: bool) -> float:
        """Return the time of the first touch, s; infinite without one.

        Args:
            poses: (T + 1, 3) of the robot now and after each step.
            people: (T, N, 2), m.
            radius: (N,), m.
            stands: True if touches of a robot that stands count, too.
        """
        moves = np.hypot(*np.diff(poses[:, :2], axis=0).T) > _STANDS
        moves |= stands
        hits = np.flatnonzero((self._gaps(poses, people, radius).min(axis=1) < _TOUCH) & moves)
        return math.inf if len(hits) == 0 else _LOOK * float(hits[0] + 1)


def _looks(poses: Array) -> Array:
    """Resample poses (T + 1, 3), `STEP` s apart, to the times of the contact checks."""
    steps = STEP * np.arange(len(poses))
    times = _LOOK * np.arange(int(steps[-1] / _LOOK) + 1)
    return np.column_stack([np.interp(times, steps, column) for column in poses.T])
