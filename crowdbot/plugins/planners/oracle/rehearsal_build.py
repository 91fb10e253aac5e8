"""Plans that are tried beside the crowd of the run, before one of them is driven."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from crowdbot.plugin import Array, Truth
from crowdbot.plugins.planners.people_mpc.plan_world_build import STEP

#: A smaller gap counts as a touch, m.
_TOUCH = 0.02
#: A robot that moves less in a step stands: who touches it then is not touched by it, m.
_STANDS = 0.05 * STEP
#: Where no one is nearer to a path than this, as if there was no robot, nothing is tried, m.
_FAR = 0.8


class Rehearsal:
    """Finds the first of several plans that touches no one.

    Attributes:
        steps: of a path that are tried.

    Args:
        time: how far the crowd is asked, s.
        robot: (D, 3) discs of the robot in its frame: x, y, radius, m.
    """

    def __init__(self, time: float, robot: Array) -> None:
        self.steps, self._robot = math.ceil(time / STEP), robot

    def first_clear(
        self, truth: Truth, paths: Iterable[tuple[int, Array]], pose: tuple[float, ...]
    ) -> int:
        """Return the number of a path; if all touch someone, of the one that does so last.

        Args:
            truth: of a crowd that can be foreseen.
            paths: number and poses (S, 3) after each step, the wanted one first. They are read
                only as far as needed.
            pose: now.
        """
        assert truth.foresee is not None
        latest, best = -1.0, 0
        for at, (number, path) in enumerate(paths):
            poses = np.vstack([[pose], path[: self.steps]])
            if at == 0 and self._is_far(truth, poses):
                return number
            people = truth.foresee(len(poses) - 1, STEP, poses)
            touch = self._touched(poses, people, truth.people_radius)
            if touch == math.inf:
                return number
            if touch > latest:
                latest, best = touch, number
        return best

    def _is_far(self, truth: Truth, poses: Array) -> bool:
        """Return True if no one comes near at the present velocities."""
        t = STEP * np.arange(1, len(poses))[:, np.newaxis, np.newaxis]
        people = truth.people + t * truth.people_velocity
        gaps = self._gaps(poses, people, truth.people_radius)
        return bool(np.min(gaps, initial=math.inf) > _FAR)

    def _gaps(self, poses: Array, people: Array, radius: Array) -> Array:
        """Return the gaps (T, N) between robot and people after each step, m."""
        c, s = np.cos(poses[1:, 2]), np.sin(poses[1:, 2])
        found = np.full(people.shape[:2], math.inf)
        for x, y, own in self._robot.tolist():
            dx = people[:, :, 0] - (poses[1:, 0] + c * x - s * y)[:, np.newaxis]
            dy = people[:, :, 1] - (poses[1:, 1] + s * x + c * y)[:, np.newaxis]
            found = np.minimum(found, np.hypot(dx, dy) - own - radius)
        return found

    def _touched(self, poses: Array, people: Array, radius: Array) -> float:
        """Return the time of the first touch while the robot moves, s; infinite without one."""
        moves = np.hypot(*np.diff(poses[:, :2], axis=0).T) > _STANDS
        hits = np.flatnonzero((self._gaps(poses, people, radius).min(axis=1) < _TOUCH) & moves)
        return math.inf if len(hits) == 0 else STEP * float(hits[0] + 1)


__all__ = ["Rehearsal"]
