"""Differential drive: wheel motors turn the wheels, friction with the floor moves the robot."""

from __future__ import annotations

from pydrake.multibody.tree import PdControllerGains
from pydrake.systems.framework import DiagramBuilder

from crowdbot.core.interfaces import EnvironmentParts, RobotModel
from crowdbot.core.sim.control.controlled import ControlledRobot, push_on
from crowdbot.core.sim.plant import add_plant, place_robot
from crowdbot.core.sim.robot_state import add_robot_state

# Implicit velocity gain, N m s; stable from 0.1 to 50 (docs/decisions/0004).
WHEEL_GAINS = PdControllerGains(p=0.0, d=1.0)


def add_differential_drive(
    builder: DiagramBuilder, parts: EnvironmentParts, model: RobotModel
) -> ControlledRobot:
    """Wheels under velocity control, up to their effort limit."""
    rig = add_plant(builder, parts, model, WHEEL_GAINS)
    plant, drive = rig.plant, model.drive

    def desire(v: float, w: float) -> tuple[float, ...]:
        across = 0.5 * drive.track * w
        return 0.0, 0.0, (v - across) / drive.command_radius, (v + across) / drive.command_radius

    return ControlledRobot(
        state=add_robot_state(builder, rig),
        desired=plant.get_desired_state_input_port(rig.model),
        desire=desire,
        desired_size=4,
        push=push_on(rig),
        push_port=plant.get_applied_generalized_force_input_port(),
        place=lambda context, start: place_robot(
            rig, plant.GetMyMutableContextFromRoot(context), start
        ),
        rig=rig,
    )
