"""CuyBot: a base with a column, built to be touched and pushed."""

from __future__ import annotations

from typing import ClassVar, Literal

import crowdbot.plugins.robots.limits as limits
from crowdbot.plugin import Component, PositiveForce, PositiveStiffness, default


class CuybotSpec(limits.LimitedRobotSpec):
    """CuyBot with size and mass of the original's prefab; nothing else about it is published.

    It yields: a push above `yield_force` moves it, and afterwards it brakes with that force. Its
    skin is a spring in series with the person's body.
    """

    controls: ClassVar[tuple[str, ...]] = ("force", "kinematic")
    kind: Literal["cuybot"] = "cuybot"
    max_speed: limits.MaxSpeed = 1.5
    max_yaw_rate: limits.MaxYawRate = 2.0
    max_acceleration: limits.MaxAcceleration = 1.0
    max_yaw_acceleration: limits.MaxYawAcceleration = 2.0
    mass: limits.Mass = 100.0
    yield_force: PositiveForce = default(120.0, "Largest force of its drive, in any direction, N.")
    skin_stiffness: PositiveStiffness = default(
        10000.0, "Of the skin, in series with the person's body, N/m."
    )

    @property
    def half_width(self) -> float:
        """Return the radius of the disc within its outline, m."""
        return 0.266


CUYBOT = Component(
    spec=CuybotSpec,
    summary="base with a column and a soft skin, goes sideways too, gives way when pushed",
)
