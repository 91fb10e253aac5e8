"""Work that people do to evade a robot, until now and on a path, as in the primary score."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, Truth

#: Work per mass that a plan may bring a person to, J/kg; above `_DRIVEN` the person counts as
#: driven aside in `safe_efficiency`, and no longer matters.
_MOST, _DRIVEN = 0.15, 0.25
#: Only people whom the robot would reach within this time, s, and who are this near, m.
_HEADWAY, _REACH = 0.5, 2.0
#: People closer than this to each other touch, and do not evade by themselves, m.
_TOUCH = 0.01


class Forced:
    """The robot's work per mass (J/kg) against each person who accelerates away, by number.

    Args:
        robot: (D, 3) discs of the robot in its frame: x, y, radius, m.
    """

    def __init__(self, robot: Array) -> None:
        self._robot = robot
        self._so_far: dict[int, float] = {}
        self._last: tuple[float, Truth] | None = None

    def see(self, t: float, truth: Truth) -> None:
        """Add the work done since the last call; ``t`` is the time now, s."""
        if self._last is not None and t > self._last[0]:
            before, was = self._last
            numbers, old, new = np.intersect1d(
                was.people_id, truth.people_id, assume_unique=True, return_indices=True
            )
            places = np.stack([was.people[old], truth.people[new]])
            velocities = np.stack([was.people_velocity[old], truth.people_velocity[new]])
            poses = np.array([[*p] for p in (was.pose, truth.pose)])
            done = self._work(places, velocities, truth.people_radius[new], poses, t - before)[0]
            for k in np.flatnonzero(done).tolist():
                number = int(numbers[k])
                self._so_far[number] = self.work_on(number) + float(done[k])
        self._last = t, truth

    def work_on(self, number: int) -> float:
        """Return the work per mass against a person so far, J/kg."""
        return self._so_far.get(number, 0.0)

    def when(self, truth: Truth, people: Array, poses: Array, step: float) -> float:
        """Return the time at which a path drives someone aside, s; infinite if it does not.

        Args:
            truth: now.
            people: (T, N, 2) after each step, beside the path, m.
            poses: (T + 1, 3) of the robot now and after each step.
            step: s.
        """
        places = np.concatenate([truth.people[np.newaxis], people])
        ways = np.diff(places, axis=0) / step
        velocities = np.concatenate([truth.people_velocity[np.newaxis], ways])
        done = self._work(places, velocities, truth.people_radius, poses, step)
        so_far = np.array([self.work_on(n) for n in truth.people_id.tolist()])
        total = np.cumsum(done, axis=0)
        over = (so_far + total > _MOST) & (so_far < _DRIVEN) & (total > 0.0)
        steps = np.flatnonzero(over.any(axis=1))
        return math.inf if len(steps) == 0 else step * float(steps[0] + 1)

    def _work(
        self, places: Array, velocities: Array, radius: Array, poses: Array, dt: float
    ) -> Array:
        """Return the work per mass (T, N) in each step, J/kg; see `evasion` of the scores."""
        going = np.diff(poses[:, :2], axis=0)[:, np.newaxis] / dt
        middle = 0.5 * (places[1:] + places[:-1])
        base = 0.5 * (poses[1:] + poses[:-1])
        offset = middle - base[:, np.newaxis, :2]
        distance = np.hypot(offset[..., 0], offset[..., 1])
        normal = offset / np.maximum(distance, 1e-9)[..., np.newaxis]
        approach = np.maximum((going * normal).sum(axis=2), 0.0)
        away = np.maximum((np.diff(velocities, axis=0) / dt * normal).sum(axis=2), 0.0)
        counts = (distance < _REACH) & (approach > 0.0) & (away > 0.0)
        counts &= self._is_soon(offset, radius, base[:, 2], going)
        found = np.where(counts, dt * away * approach, 0.0)
        for k, n in np.argwhere(counts).tolist():
            gaps = np.hypot(*(middle[k] - middle[k, n]).T) - radius - radius[n]
            gaps[n] = math.inf
            if gaps.min() < _TOUCH:
                found[k, n] = 0.0
        return found

    def _is_soon(self, offset: Array, radius: Array, yaw: Array, going: Array) -> Array:
        """Return whether each person (T, N) who stood still would be reached within the headway."""
        way = _HEADWAY * going
        length = np.maximum((way**2).sum(axis=2), 1e-12)
        c, s = np.cos(yaw), np.sin(yaw)
        soon = np.zeros(offset.shape[:2], dtype=bool)
        for x, y, own in self._robot.tolist():
            to = offset - np.column_stack([c * x - s * y, s * x + c * y])[:, np.newaxis]
            along = np.clip((to * way).sum(axis=2) / length, 0.0, 1.0)
            nearest = to - along[..., np.newaxis] * way
            soon |= np.hypot(nearest[..., 0], nearest[..., 1]) < own + radius
        return soon
