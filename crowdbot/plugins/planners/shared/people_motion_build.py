"""Velocities of people in a lidar's view, from their earlier positions."""

from __future__ import annotations

import math
from collections import deque

import numpy as np

from crowdbot.plugin import Array, Pose
from crowdbot.plugins.planners.shared.points_build import apparent_velocity

#: Slower apparent motion is that of legs, faster that of a newly visible person, m/s.
_STILL, _FASTEST = 0.3, 2.5


class PeopleMotion:
    """Estimates people's velocities from their earlier positions.

    Args:
        look_back: age of the scan to compare with, s; 0: everyone counts as standing.
    """

    def __init__(self, look_back: float) -> None:
        self._look_back = look_back
        self._seen: deque[tuple[float, Array]] = deque(maxlen=64)

    def velocities(self, t: float, pose: Pose, people: Array) -> Array:
        """Return velocities of people, base frame, m/s; 0 if standing or newly seen.

        Args:
            t: current time, s.
            pose: the robot's pose, in a fixed frame.
            people: (K, 2) their positions, base frame, m.
        """
        c, s = math.cos(pose.yaw), math.sin(pose.yaw)
        to_world = np.array([[c, s], [-s, c]])  # for row vectors
        now = people @ to_world + (pose.x, pose.y)
        while len(self._seen) > 1 and self._seen[1][0] <= t - self._look_back:
            self._seen.popleft()
        found = np.zeros_like(people)
        if self._seen and self._look_back > 0.0 and t - self._seen[0][0] >= 0.5 * self._look_back:
            then, before = self._seen[0]
            found = apparent_velocity(now, before, t - then, _STILL, _FASTEST) @ to_world.T
        self._seen.append((t, now))
        return found
