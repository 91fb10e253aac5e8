"""Planner of a robot that executes exactly the commands of the person at its stick."""

from __future__ import annotations

from collections.abc import Mapping

from crowdbot.core.planning.planner import Observation
from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task


class StickPlanner:
    """Returns the reading of the stick."""

    def __init__(self, stick: str) -> None:
        """Take the name of the sensor."""
        self._stick = stick

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Do nothing: the stick's readings are within the limits already."""
        del task, limits, sensors, seed

    def step(self, obs: Observation) -> Command:
        """Return the stick's command."""
        v, w, *aside = obs.readings[self._stick].values.tolist()
        return Command(v, w, aside[0] if aside else 0.0)
