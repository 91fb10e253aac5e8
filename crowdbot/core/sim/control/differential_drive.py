"""Differential drive: motors turn the wheels, friction with the floor moves the robot."""

from __future__ import annotations

from pydrake.multibody.tree import PdControllerGains
from pydrake.systems.framework import DiagramBuilder

from crowdbot.core.robots.wheel_gain import wheel_gain
from crowdbot.core.sim.control.controlled import ControlledRobot, push_on
from crowdbot.core.sim.plant import add_plant, motor_of, place_robot
from crowdbot.core.sim.robot_state import add_robot_state
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.robot import DifferentialDrive, RobotModel


def wheel_gains(mass: float, radius: float) -> PdControllerGains:
    """Return gains of each wheel's motor, from a robot's mass (kg) and wheel radius (m)."""
    return PdControllerGains(p=0.0, d=wheel_gain(mass, radius))


def add_differential_drive(
    builder: DiagramBuilder, parts: EnvironmentParts, model: RobotModel, tick: float
) -> ControlledRobot:
    """Add wheels under velocity control, with limited effort."""
    drive = model.drive
    assert isinstance(drive, DifferentialDrive)  # checked by build_robot
    radius = drive.command_radius
    rig = add_plant(builder, parts, model, wheel_gains(model.mass, radius), tick)
    plant = rig.plant
    left_motor, right_motor = (motor_of(plant, joint) for joint in rig.wheels)
    left_first = left_motor.index() < right_motor.index()

    def desire(v: float, w: float, vy: float) -> tuple[float, ...]:
        del vy
        across = 0.5 * drive.track * w
        left, right = (v - across) / radius, (v + across) / radius
        return (0.0, 0.0, left, right) if left_first else (0.0, 0.0, right, left)

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
