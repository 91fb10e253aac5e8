"""Task: where a robot starts, and where it has to get in what time."""

from __future__ import annotations

from dataclasses import dataclass

from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import RobotBody


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """Start pose and goal, in the world frame, which the odometry frame equals at t = 0.

    ``robot`` is the body and the drive of the robot; None where they are not known.
    """

    start: Pose
    goal: tuple[float, float]
    goal_zone: Array
    time_limit: float
    robot: RobotBody | None = None
