"""Glider: SDFormat from its sizes."""

from __future__ import annotations

import numpy as np
from crowdbot.plugin import HolonomicDrive, RobotLimits, RobotModel

from crowdbot_acme.glider import GliderSpec

GROUND = 0.05  # clearance under the body; radius of the four balls that it slides on, m


def build(spec: GliderSpec) -> RobotModel:
    """The glider; base_link is on the floor below its middle."""
    half = 0.5 * spec.length
    return RobotModel(
        description=_sdf(spec),
        base="base_link",
        base_height=0.0,
        drive=HolonomicDrive(
            max_force=2.0 * spec.mass * spec.max_acceleration,
            max_torque=2.0 * _yaw_inertia(spec) * _YAW_ACCELERATION,
        ),
        limits=RobotLimits(
            v_min=-spec.max_speed,
            v_max=spec.max_speed,
            w_max=spec.max_yaw_rate,
            a_max=spec.max_acceleration,
            alpha_max=_YAW_ACCELERATION,
            command_timeout=0.5,
            vy_max=spec.max_speed,
        ),
        footprint=np.array([[-half, 0.0], [half, 0.0]]),
        footprint_radius=spec.radius,
        height=spec.height,
        force_height=0.5 * spec.height,
        mass=spec.mass,
    )


_YAW_ACCELERATION = 3.0  # rad/s^2


def _yaw_inertia(spec: GliderSpec) -> float:
    """That of a box of the same outline, kg m^2."""
    length, width = spec.length + 2.0 * spec.radius, 2.0 * spec.radius
    return spec.mass / 12.0 * (length**2 + width**2)


def _sdf(spec: GliderSpec) -> str:
    tall = spec.height - GROUND
    length, width = spec.length + 2.0 * spec.radius, 2.0 * spec.radius
    xx = spec.mass / 12.0 * (tall**2 + width**2)
    yy = spec.mass / 12.0 * (tall**2 + length**2)
    middle = GROUND + 0.5 * tall
    end = f"<cylinder><radius>{spec.radius}</radius><length>{tall}</length></cylinder>"
    box = f"<box><size>{spec.length} {width} {tall}</size></box>"
    body = "".join(
        _shape(name, (x, 0.0, middle), shape, 0.3)
        for name, x, shape in (
            ("front", 0.5 * spec.length, end),
            ("rear", -0.5 * spec.length, end),
            ("middle", 0.0, box),
        )
    )
    ball = f"<sphere><radius>{GROUND}</radius></sphere>"
    feet = "".join(
        _shape(f"foot{i}", (x * spec.length, y * spec.radius, GROUND), ball, 0.0)
        for i, (x, y) in enumerate(((0.5, 0.6), (0.5, -0.6), (-0.5, 0.6), (-0.5, -0.6)))
    )
    return f"""<?xml version="1.0"?>
<sdf version="1.9" xmlns:drake="http://drake.mit.edu"><model name="glider">
  <link name="base_link">
    <inertial><pose>0 0 {middle} 0 0 0</pose><mass>{spec.mass}</mass>
      <inertia><ixx>{xx}</ixx><iyy>{yy}</iyy><izz>{_yaw_inertia(spec)}</izz>
        <ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial>
    {body}{feet}
  </link>
</model></sdf>"""


def _shape(name: str, at: tuple[float, float, float], shape: str, friction: float) -> str:
    """Something that is seen and that collides."""
    inner = f"<pose>{at[0]} {at[1]} {at[2]} 0 0 0</pose><geometry>{shape}</geometry>"
    return (
        f'<visual name="{name}">{inner}</visual><collision name="{name}">{inner}'
        f"<drake:proximity_properties><drake:mu_dynamic>{friction}</drake:mu_dynamic>"
        f"<drake:mu_static>{friction}</drake:mu_static></drake:proximity_properties></collision>"
    )
