"""Cart: the URDF file and what it does not say."""

from __future__ import annotations

from importlib.resources import files

from crowdbot.plugin import DifferentialDrive, RobotLimits, RobotModel

from crowdbot_acme.cart import CartSpec

WHEEL_RADIUS = 0.06  # m
TRACK = 0.30  # m


def build(spec: CartSpec) -> RobotModel:
    """The cart; base_link is on the axle, a wheel's radius above the floor."""
    return RobotModel(
        description=(files("crowdbot_acme") / "robots" / "cart.urdf").read_text(encoding="utf-8"),
        base="base_link",
        base_height=WHEEL_RADIUS,
        drive=DifferentialDrive(
            left_joint="left_wheel_joint",
            right_joint="right_wheel_joint",
            command_radius=WHEEL_RADIUS,
            track=TRACK,
        ),
        limits=RobotLimits(
            v_min=-spec.max_speed,
            v_max=spec.max_speed,
            w_max=spec.max_yaw_rate,
            a_max=spec.max_acceleration,
            alpha_max=3.0,
            command_timeout=0.5,
        ),
        footprint_radius=0.22,
        height=0.36,
        force_height=0.16,
        mass=15.0,
    )
