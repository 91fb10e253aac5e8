"""Task: a robot's start, its goal and its time limit."""

from __future__ import annotations

from dataclasses import dataclass

from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.person_task import PersonTask
from crowdbot.core.types.robot import RobotBody


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """Start pose and goal, in the world frame, which the odometry frame equals at t = 0.

    ``robot`` is the body and the drive of the robot; None where they are not known. ``person`` says
    what to do if the goal is a person: then ``goal`` is where the robot's place would be at the
    start, and moves with the person; ``goal_zone`` is a small polygon around it, or, of ``lead``,
    the zone to which the person is led.
    """

    start: Pose
    goal: tuple[float, float]
    goal_zone: Array
    time_limit: float
    robot: RobotBody | None = None
    person: PersonTask | None = None
