"""The other robots of a fleet, as the replay page of one of them shows them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crowdbot.core.trajectories.trajectories import RobotTrack, Trajectories
from crowdbot.core.types.arrays import Array

#: A part of the robot: outline (K, 2), m, and colour.
Seen = tuple[Array, str]


@dataclass(frozen=True, slots=True, kw_only=True)
class OtherTrack:
    """Another robot of the run that a page shows.

    Attributes:
        run: what it did until it ended.
        look: its parts as seen from above, the lowest first.
        leaves: whether it is gone after its end; otherwise it stands where it ended.
    """

    name: str
    run: Trajectories
    look: Sequence[Seen]
    leaves: bool


def motion_of(robot: RobotTrack) -> Array:
    """x, y, theta, v, w (5, N)."""
    return np.stack((robot.x, robot.y, robot.theta, robot.v, robot.w))


def motion_until(robot: RobotTrack, samples: int, *, leaves: bool) -> Array:
    """`motion_of` for so many samples; after its end it stands, or all is NaN."""
    rows = np.full((5, samples), np.nan)
    count = min(samples, len(robot.x))
    rows[:, :count] = motion_of(robot)[:, :count]
    if not leaves:
        rows[:3, count:] = rows[:3, count - 1 : count]
        rows[3:, count:] = 0.0
    return rows
