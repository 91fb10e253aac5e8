"""Stand still: always command zero."""

from __future__ import annotations

from collections.abc import Mapping

from crowdbot.plugin import Command, Observation, RobotLimits, SensorInfo, Task
from crowdbot.plugins.planners.stand_still import StandStillSpec


class StandStill:
    """Always commands zero velocity."""

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Do nothing."""
        del task, limits, sensors, seed

    def step(self, obs: Observation) -> Command:
        """Return a zero command."""
        del obs
        return Command(0.0, 0.0)


def build(spec: StandStillSpec) -> StandStill:
    """Build a planner from its spec."""
    del spec
    return StandStill()
