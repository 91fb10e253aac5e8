"""Build what robots share: the box of limits of a spec, and a drive on two wheels."""

from __future__ import annotations

from crowdbot.plugin import DifferentialDrive, RobotLimits
from crowdbot.plugins.robots.limits import LimitedRobotSpec
from crowdbot.plugins.robots.urdf import UrdfFields


def limits_of(spec: LimitedRobotSpec | UrdfFields, *, sideways: bool = False) -> RobotLimits:
    """Return limits with equal speed back and ahead, and also sideways if ``sideways``."""
    return RobotLimits(
        v_min=-spec.max_speed,
        v_max=spec.max_speed,
        vy_max=spec.max_speed if sideways else 0.0,
        w_max=spec.max_yaw_rate,
        a_max=spec.max_acceleration,
        alpha_max=spec.max_yaw_acceleration,
        command_timeout=spec.command_timeout,
    )


def two_wheels(track: float, radius: float) -> DifferentialDrive:
    """Return the drive of a robot on the wheels of `sdf.wheels`; both in m."""
    return DifferentialDrive(
        left_joint="left_wheel_joint",
        right_joint="right_wheel_joint",
        command_radius=radius,
        track=track,
    )
