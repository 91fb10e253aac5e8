"""Build the box of limits that a robot's spec describes."""

from __future__ import annotations

from crowdbot.plugin import RobotLimits
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
