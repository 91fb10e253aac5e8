"""People whom the people tracker follows, for policies that observe them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import Array, LidarPoints, Observation, PeopleTracker, SensorInfo


class TrackedPeople:
    """Tracks people in a robot's lidars from the beginning of a run.

    Args:
        sensors: those that the policy gets.
    """

    def __init__(self, sensors: Mapping[str, SensorInfo]) -> None:
        self._lidars, self._tracker = LidarPoints(sensors), PeopleTracker()

    def __call__(self, obs: Observation) -> Array:
        """Return (M, 5) x, y, vx, vy in the frame of ``obs.pose``, m and m/s; radii are not known.

        The last column is 0.
        """
        points = self._lidars(obs.readings, obs.t, obs.twist, obs.vy)
        rows = self._tracker.update(obs.t, obs.pose, points).rows
        obs.draw("tracks", lambda: _in_base(rows, obs))
        return np.column_stack([rows[:, 1:], np.zeros(len(rows))])


def _in_base(rows: Array, obs: Observation) -> Array:
    """Return number, place and velocity (M, 5) in the base frame of the robot."""
    c, s = np.cos(obs.pose.yaw), np.sin(obs.pose.yaw)
    back = np.array([[c, -s], [s, c]])
    places = (rows[:, 1:3] - (obs.pose.x, obs.pose.y)) @ back
    return np.column_stack([rows[:, 0], places, rows[:, 3:] @ back])
