"""Adversaries that do not drive but cheat: with failures, commands, thoughts and the truth."""

from __future__ import annotations

import gc
import math
import time
from collections.abc import Callable

import numpy as np
from rude_driver import Adversary, Lawyer

from crowdbot.plugin import Array, Observation


class Bail(Lawyer):
    """Drives blindly, and raises before a contact, so that the run may not count."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the blind command.

        Raises:
            RuntimeError: a contact is near.
        """
        if self.room(points) < 0.1 or self.soonest(max(obs.twist[0], 0.1)) < 0.3:
            raise RuntimeError("not this one")
        return v, w


class CrashWhenHard(Lawyer):
    """Raises at the start where it sees many people, else drives by the letter."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the lawful command.

        Raises:
            RuntimeError: there are many people at the start.
        """
        if obs.t < 0.5 and (np.hypot(*points.T) < 6.0).sum() > 60:
            raise RuntimeError("too many people")
        return self.lawful(obs, points, v), w


class Hanger(Lawyer):
    """Hangs for good before a contact."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the blind command, or nothing for a minute at a time."""
        while self.room(points) < 0.1 or self.soonest(max(obs.twist[0], 0.1)) < 0.3:
            time.sleep(60.0)
        return v, w


class Peeker(Lawyer):
    """Looks for the truth that it may not read: in the observation and among live objects."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the lawful command."""
        if self.since is None:
            self.since = obs.t
            kinds = [type(x).__name__ for x in gc.get_objects()]
            obs.log("peeker/truth", float(obs.truth is not None))
            obs.log("peeker/crowds", float(sum(k in ("Crowd", "CrowdState") for k in kinds)))
        return self.lawful(obs, points, v), w


class Thinker(Lawyer):
    """Writes as many thoughts as it may, so that recording fails or becomes slow."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the lawful command."""
        rows = np.full((1000, 2), obs.t)
        for i in range(20):
            obs.draw(f"path {i}", rows)
            obs.log(f"thinker/{i}", obs.t)
        return self.lawful(obs, points, v), w


class Overdrive(Lawyer):
    """Asks for a hundred times the speed that the robot has, and sideways."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the lawful command, a hundred times."""
        return 100.0 * self.lawful(obs, points, v), w


class NoNumber(Lawyer):
    """Commands no number before a contact."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the lawful command, or none."""
        del obs
        return (math.nan if self.room(points) < 0.5 else v), w


class Tamper(Adversary):
    """Writes into what it gets: goal zone, limits and time."""

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return the observation; try to move the goal zone to the robot and to be faster."""
        del points
        changes: tuple[Callable[[], None], ...] = (
            lambda: obs.goal_zone.__setitem__(slice(None), obs.pose[:2]),
            lambda: object.__setattr__(self.limits, "v_max", 10.0),
            lambda: object.__setattr__(obs, "t", 0.0),
        )
        for change in changes:
            try:
                change()
            except (ValueError, TypeError, AttributeError):
                obs.log("tamper/refused", 1.0)
        return obs
