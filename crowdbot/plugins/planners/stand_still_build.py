"""Stand still: zero, always."""

from __future__ import annotations

from collections.abc import Mapping

from crowdbot.plugin import Command, Observation, RobotLimits, SensorInfo, Task
from crowdbot.plugins.planners.stand_still import StandStillSpec


class StandStill:
    """Asks for no velocity."""

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Nothing to remember."""
        del task, limits, sensors, seed

    def step(self, obs: Observation) -> Command:
        """Zero."""
        del obs
        return Command(0.0, 0.0)


def build(spec: StandStillSpec) -> StandStill:
    """A planner from its spec."""
    del spec
    return StandStill()
