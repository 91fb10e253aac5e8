"""A bully that knows people who walk, and one that knows the rule of fault to the letter."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import ClassVar

import numpy as np

from crowdbot.plugin import Array, Observation, PeopleTracker
from crowdbot.plugins.planners.adversaries.adversaries_build import Bully

#: Reaction and braking that the rule of fault expects, s and m/s², and its margin, m.
REACTION, BRAKING, MARGIN = 0.3, 1.0, 0.1
#: Radius of a person, m, and delay of the tracker and of the drive, s.
PERSON, DELAY = 0.25, 0.15


class Adversary(Bully):
    """A bully as a file's planner; knows people who walk, in the base frame."""

    role: ClassVar[str] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    def __init__(self) -> None:
        super().__init__()
        self._tracker, self._people = PeopleTracker(), np.zeros((0, 4))

    def people(self, obs: Observation, points: Array) -> Array:
        """Return (N, 4) x, y (m) and vx, vy (m/s) of walking people in the base frame."""
        rows = self._tracker.update(obs.t, obs.pose, points).rows[:, 1:]
        c, s = math.cos(obs.pose.yaw), math.sin(obs.pose.yaw)
        back = np.array([[c, -s], [s, c]])
        return np.column_stack([(rows[:, :2] - obs.pose[:2]) @ back, rows[:, 2:] @ back])


class Lawyer(Adversary):
    """Keeps to the letter of the rule of fault, and to nothing else.

    It drives straight on at people, and brakes when the first contact is as near in time as the
    rule asks for, with the velocities of people. So it stands when they touch it.
    """

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return the observation; see who walks where."""
        self._people = self.people(obs, points)
        return obs

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the blind command, or rest where the rule asks for braking."""
        return self.lawful(obs, points, v), w

    def lawful(self, obs: Observation, points: Array, v: float) -> float:
        """Return the speed, or 0 where the rule asks for braking, m/s."""
        now = max(0.0, obs.twist[0])
        needs = REACTION + DELAY + now / BRAKING
        soon = self.soonest(max(now, 0.1))
        return 0.0 if soon < needs else self.late(self.room(points), v)

    def soonest(self, v: float) -> float:
        """Return the time to the first contact with a walking person at a forward speed, s."""
        if not len(self._people):
            return math.inf
        x, y, vx, vy = self._people.T
        vx, reach = vx - v, max(self._half, self._front) + PERSON + MARGIN
        a, b = vx * vx + vy * vy + 1e-9, x * vx + y * vy
        c = x * x + y * y - reach**2
        root = b * b - a * c
        when = np.where(c <= 0.0, 0.0, (-b - np.sqrt(np.maximum(root, 0.0))) / a)
        meets = (b < 0.0) & (root > 0.0)
        return float(np.min(when[meets], initial=math.inf))


def goal_in_base(obs: Observation, x: float, y: float) -> Observation:
    """Return the observation with a goal in the base frame."""
    c, s = math.cos(obs.pose.yaw), math.sin(obs.pose.yaw)
    return replace(obs, goal=(obs.pose.x + c * x - s * y, obs.pose.y + s * x + c * y))
