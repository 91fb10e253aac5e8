"""How people walk whom a lidar shows: from where they were a moment ago."""

from __future__ import annotations

import math
from collections import deque

import numpy as np

from crowdbot.plugin import Array, Pose
from crowdbot.plugins.planners.shared.points_build import apparent_velocity

#: Apparent motion below this is that of legs, above that a person who was hidden, m/s.
_STILL, _FASTEST = 0.3, 2.5


class PeopleMotion:
    """Remembers where people were.

    Args:
        look_back: age of the scan that is compared with, s; 0 takes all as standing.
    """

    def __init__(self, look_back: float) -> None:
        self._look_back = look_back
        self._seen: deque[tuple[float, Array]] = deque(maxlen=64)

    def velocities(self, t: float, pose: Pose, people: Array) -> Array:
        """Velocities of people, base frame, m/s; 0 of those who stand, or were not seen before.

        Args:
            t: now, s.
            pose: of the robot, in a frame that stays.
            people: (K, 2) where they are, base frame, m.
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
