"""Cart: a round robot on two wheels, described by a URDF file."""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import (
    Component,
    PositiveAcceleration,
    PositiveAngularSpeed,
    PositiveSpeed,
    RobotSpec,
)
from pydantic import Field


class CartSpec(RobotSpec):
    """The body is that of ``robots/cart.urdf``; only the limits can be told."""

    kind: Literal["acme.cart"] = "acme.cart"
    max_speed: PositiveSpeed = Field(default=0.9, description="Largest |v|, m/s.")
    max_yaw_rate: PositiveAngularSpeed = Field(default=2.0, description="Largest |w|, rad/s.")
    max_acceleration: PositiveAcceleration = Field(default=1.2, description="Slew of v, m/s^2.")


CART = Component(
    spec=CartSpec,
    build="crowdbot_acme.cart_build:build",
    summary="round cart from a URDF file, differential drive, 0.9 m/s",
)
