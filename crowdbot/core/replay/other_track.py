"""The other robots of a fleet on one robot's replay page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crowdbot.core.trajectories.tracks import RobotTrack
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array

#: A part of the robot: outline (K, 2), m, and colour.
Seen = tuple[Array, str]


@dataclass(frozen=True, slots=True, kw_only=True)
class OtherTrack:
    """Another robot of the run shown on a page.

    Attributes:
        run: its run until its end.
        look: its parts seen from above, lowest first.
        leaves: True if it disappears at its end; otherwise it stays there.
    """

    name: str
    run: Trajectories
    look: Sequence[Seen]
    leaves: bool


def motion_of(robot: RobotTrack) -> Array:
    """Return a robot's motion x, y, theta, v, w (5, N); m, rad, m/s, rad/s."""
    return np.stack((robot.x, robot.y, robot.theta, robot.v, robot.w))


def motion_until(robot: RobotTrack, samples: int, *, leaves: bool) -> Array:
    """Return `motion_of` for a number of samples; after its end a robot stands still, or is NaN."""
    rows = np.full((5, samples), np.nan)
    count = min(samples, len(robot.x))
    rows[:, :count] = motion_of(robot)[:, :count]
    if not leaves:
        rows[:3, count:] = rows[:3, count - 1 : count]
        rows[3:, count:] = 0.0
    return rows
