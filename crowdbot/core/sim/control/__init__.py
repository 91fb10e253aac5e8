"""Control modes, which convert commands to motion. All output the same ``robot_state``."""

from __future__ import annotations

from pydrake.systems.framework import DiagramBuilder

from crowdbot.core.sim.control.controlled import ControlledRobot
from crowdbot.core.sim.control.differential_drive import add_differential_drive
from crowdbot.core.sim.control.force import add_force
from crowdbot.core.sim.control.kinematic import add_kinematic
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.robot import RobotModel

_MODES = {
    "differential_drive": add_differential_drive,
    "force": add_force,
    "kinematic": add_kinematic,
}


def add_robot(
    builder: DiagramBuilder,
    parts: EnvironmentParts,
    model: RobotModel,
    control: str,
    tick: float = TICK,
) -> ControlledRobot:
    """Add a robot to a diagram, with one of the control modes, every ``tick`` seconds."""
    return _MODES[control](builder, parts, model, tick)


__all__ = ["ControlledRobot", "add_robot"]
