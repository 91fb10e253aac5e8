"""SensorContext: the robot and the task that a sensor is built for."""

from __future__ import annotations

from dataclasses import dataclass

from crowdbot.core.types.robot import RobotModel
from crowdbot.core.types.task import Task


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorContext:
    """The robot that carries a sensor, and the robot's task.

    Attributes:
        robot: body, drive and limits.
        task: start, goal and time limit, as the planner gets them.
    """

    robot: RobotModel
    task: Task
