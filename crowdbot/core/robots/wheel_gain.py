"""Velocity gain of wheel motors, and the speed reached against the damping of joints."""

from __future__ import annotations

from crowdbot.core.robots.description import Description
from crowdbot.core.types.robot import DifferentialDrive, RobotModel
from crowdbot.errors import PluginError

# Implicit velocity gain of a TurtleBot2's wheels, N m s; stable there from 0.1 to 50
# (docs/decisions/0004). Heavier robots on larger wheels need more to be as fast: d ~ m r^2.
_GAIN, _MASS, _RADIUS = 1.0, 6.3, 0.0352


def wheel_gain(mass: float, radius: float) -> float:
    """Return the velocity gain of each wheel's motor, N m s, from mass (kg) and radius (m)."""
    return _GAIN * (mass * radius**2) / (_MASS * _RADIUS**2)


def reached_speed(model: RobotModel, drive: DifferentialDrive, described: Description) -> float:
    """Return the steady speed of wheels under velocity control when ``v_max`` is commanded, m/s.

    Their motors work against the damping of all joints that turn. Other losses are not counted.
    """
    radius, most = drive.command_radius, model.limits.v_max
    motors = [described.joint(name) for name in (drive.left_joint, drive.right_joint)]
    damping = sum(joint.damping * _geared(described, name, radius)
                  for name, joint in described.joints.items() if joint.free)  # fmt: skip
    if damping <= 0.0 or most <= 0.0:
        return most
    gain = 2.0 * wheel_gain(model.mass, radius)
    torque = sum(joint.effort or 0.0 for joint in motors)
    return min(most * gain / (gain + damping), torque / damping * radius)


def _geared(described: Description, joint: str, radius: float) -> float:
    """Return the squared ratio of a wheel's speed to that of a driven wheel; 1 without radius."""
    try:
        return (radius / described.wheel_radius(joint)) ** 2
    except PluginError:
        return 1.0
