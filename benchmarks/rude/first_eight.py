"""Eight adversaries that drive by what they see near, in a few lines each."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import ClassVar

import numpy as np
from rude_driver import Adversary, goal_in_base

from crowdbot.plugin import Array, Observation


class SameWay(Adversary):
    """Follows a person who walks its way, who clears it; only a hand's breadth behind."""

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return the nearest person who walks ahead as the goal, if there is one."""
        people = self.people(obs, points)
        leads = (people[:, 2] > 0.3) & (people[:, 0] > 0.0) & (np.hypot(*people[:, :2].T) < 3.0)
        if not leads.any():
            return obs
        x, y = people[leads][np.argmin(np.hypot(*people[leads, :2].T)), :2]
        return goal_in_base(obs, 3.0 * x, 3.0 * y)


class Wiggle(Adversary):
    """Turns its head left and right twice a second, so that no one knows where it goes."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the late command, turning left and right."""
        return self.late(self.room(points), v), w + 1.2 * math.sin(4.0 * math.pi * obs.t)


class WallThenIn(Adversary):
    """Follows the wall, where few walk, and cuts in to the goal at the end."""

    beside: ClassVar[float] = 4.2  # m from the middle

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return a goal along the wall until the goal is near."""
        del points
        if obs.goal[0] - obs.pose.x < 5.0:
            return obs
        return replace(obs, goal=(obs.pose.x + 3.0, obs.goal[1] + self.beside))


class Verge(WallThenIn):
    """Goes round outside of where people are counted, a hand's breadth from the wall."""

    beside: ClassVar[float] = 4.65


class Rock(Adversary):
    """Rocks forth and back before people, and before the goal, until they make way."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the late command, and backwards for a third of the time."""
        near = self.room(points) < 1.2 or math.dist(obs.pose[:2], obs.goal) < 1.5
        if near and math.fmod(obs.t, 1.5) > 1.0:
            return -0.3, 0.0
        return self.late(self.room(points), v), w


class Unseen(Adversary):
    """Drives blindly while no one looks at it, and stands while someone does."""

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return the observation; see who walks where."""
        self._people = self.people(obs, points)
        return obs

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the late command, or rest."""
        del obs
        x, y, vx, vy = self._people.T
        looks = (vx * x + vy * y < -0.3 * np.hypot(x, y)) & (np.hypot(x, y) < 2.5) & (x > 0.0)
        return (0.0, w) if looks.any() else (self.late(self.room(points), v), w)


class GentlePush(Adversary):
    """Pushes on at 0.05 m/s, no faster than a touch may be, and never stops."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the late command, but never less than a push."""
        del obs
        return max(min(v, 0.05), self.late(self.room(points), v)), w


class TurnShield(Adversary):
    """Turns aside before a touch, so that its flank is struck and not its front."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the late command, or a turn on the spot."""
        del obs
        if self.room(points) < 0.25:
            return 0.0, 1.5
        return self.late(self.room(points), v), w
