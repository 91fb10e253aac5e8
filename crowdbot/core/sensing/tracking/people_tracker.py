"""PeopleTracker: people around a robot from its lidars, with velocities and persistent ids."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from crowdbot.core.sensing.tracking import clusters, step, still_map
from crowdbot.core.sensing.tracking import tracks as k
from crowdbot.core.support.immutable import immutable
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose

#: Most tracks, and most runs of points that may be legs, at a time.
_MOST_TRACKS, _MOST_LEGS = 400, 800


class Tracks(NamedTuple):
    """People at one time, in the frame of the pose that the tracker was given.

    Attributes:
        id: (N,) number of each, constant while the tracker follows it.
        position: (N, 2) centre, m.
        velocity: (N, 2) m/s.
        spread: (N,) standard deviation of the position along each axis, m.
        unseen: (N,) time since it was last seen, s; above 0 while something hides it.
    """

    id: Array
    position: Array
    velocity: Array
    spread: Array
    unseen: Array

    @property
    def rows(self) -> Array:
        """Return (N, 5) id, x, y, vx, vy, as in recordings."""
        return np.column_stack([self.id, self.position, self.velocity])


class PeopleTracker:
    """Tracks people by legs or bodies in the points of all lidars.

    Runs of points as narrow as legs are assigned to tracks, nearest first; each track is a Kalman
    filter with constant velocity. A track counts as a person once it has moved or shows two legs.
    Objects that stay for seconds enter a static map, and no track starts there. Hidden people are
    predicted for two seconds.

    Args:
        reach: people farther than this are not looked for, m.
    """

    def __init__(self, reach: float = 8.0) -> None:
        self._reach = reach
        self._memory = step.Memory(
            tracks=np.zeros((_MOST_TRACKS, k.COLUMNS)),
            state=np.zeros(2, np.int64),
            still=still_map.new_map(),
            legs=np.zeros((_MOST_LEGS, clusters.COLUMNS)),
            nearest=np.zeros(step.SECTORS),
            first=np.zeros(_MOST_TRACKS, np.int64),
            second=np.zeros(_MOST_TRACKS, np.int64),
            owner=np.zeros(_MOST_LEGS, np.int64),
        )
        self.reset()
        for t in (0.0, 0.1):  # compile what is not compiled yet
            self.update(t, Pose(0.0, 0.0, 0.0), np.ones((1, 2)))
        self.reset()

    def reset(self) -> None:
        """Forget everything."""
        self._memory.still[:] = 0.0
        self._memory.state[:] = 0
        self._t: float | None = None

    def update(self, t: float, pose: Pose, points: Array) -> Tracks:
        """Update the tracks with a scan, and return the people at its time.

        Args:
            t: time of the scan, s, later than that of the last one.
            pose: the robot's pose in a frame at rest, such as that of odometry.
            points: (P, 2) of all lidars, base frame, m, as `LidarPoints` gives them.
        """
        dt = 0.0 if self._t is None else max(0.0, t - self._t)
        self._t = t
        here = (pose.x, pose.y, pose.yaw)
        step.step(np.ascontiguousarray(points), here, t, dt, self._reach, self._memory)
        return self._people(t)

    def _people(self, t: float) -> Tracks:
        rows = self._memory.tracks[: self._memory.state[0]]
        rows = rows[rows[:, k.PERSON] == 1.0]
        return Tracks(
            id=immutable(rows[:, k.ID].copy()),
            position=immutable(rows[:, k.X : k.Y + 1].copy()),
            velocity=immutable(rows[:, k.VX : k.VY + 1].copy()),
            spread=immutable(np.sqrt(np.maximum(rows[:, k.PP], 0.0))),
            unseen=immutable(t - rows[:, k.SEEN]),
        )
