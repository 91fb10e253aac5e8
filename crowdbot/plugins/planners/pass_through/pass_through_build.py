"""Pass-through: executes the user's command unchanged."""

from __future__ import annotations

from collections.abc import Mapping

from crowdbot.plugin import Command, Observation, RobotLimits, SensorInfo, Task
from crowdbot.plugins.planners.pass_through.pass_through import PassThroughSpec
from crowdbot.plugins.planners.shared.user_input_build import UserInput


class PassThrough:
    """Passes on the user's command."""

    def __init__(self) -> None:
        self._user = UserInput()

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Find the joystick."""
        del task, seed
        self._user.reset(sensors, limits)

    def step(self, obs: Observation) -> Command:
        """Return the user's command."""
        return self._user.command(obs)


def build(spec: PassThroughSpec) -> PassThrough:
    """Build a planner from its spec."""
    del spec
    return PassThrough()
