"""The other robots of a fleet, as the replay page of one of them shows them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from crowdbot.core.replay.encode import deflate, nested
from crowdbot.core.trajectories.trajectories import Trajectories
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


def other_robot(t: Array, other: OtherTrack) -> tuple[dict[str, Any], str]:
    """What the page needs to draw it: plain data, and x, y, theta, v at the times ``t``.

    Where it is not there any more, all are NaN.
    """
    robot = other.run.robot
    assert robot is not None  # runs of robots
    rows = np.full((4, len(t)), np.nan)
    count = min(len(t), len(robot.x))
    rows[:, :count] = np.stack((robot.x, robot.y, robot.theta, robot.v))[:, :count]
    if not other.leaves:
        rows[:3, count:] = rows[:3, count - 1 : count]
        rows[3, count:] = 0.0
    about = {
        "name": other.name,
        "radius": robot.radius,
        "outline": nested(other.run.robot_footprint),
        "goal": robot.goal,
        "goalRadius": robot.goal_radius,
        "goalTime": robot.goal_time,
        "zone": nested(other.run.goal_zone),
        "look": [[c, np.round(np.asarray(o), 3).tolist()] for o, c in other.look],
    }
    return about, deflate(rows.astype("<f4").tobytes())
