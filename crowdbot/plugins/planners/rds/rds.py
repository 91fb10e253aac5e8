"""RDS: the motion of a point ahead of the axle that keeps the whole outline clear."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from crowdbot.plugin import Component, NonNegativeLength, PositiveDuration, PositiveLength
from crowdbot.plugins.planners.shared.rungs import RungSpec


class RdsSpec(RungSpec):
    """The robot avoids everything by itself; standing still is always allowed."""

    kind: Literal["rds"] = "rds"
    wish: Literal["goal", "user"] = Field(
        default="goal",
        description="Whose velocity it stays near to: its own towards the goal, or that of the "
        "user at the joystick, as reactive assistance.",
    )
    time_horizon: PositiveDuration = Field(
        default=1.5, description="Time for which nothing is touched, s."
    )
    margin: NonNegativeLength = Field(
        default=0.05, description="Clearance that is kept to everything, m."
    )
    reference_point: PositiveLength = Field(
        default=0.18,
        description="Distance ahead of the axle of the point whose velocity is chosen, m.",
    )

    @property
    def wants(self) -> tuple[str, ...]:
        """Return the near sensors, if it takes them, and the joystick, if it assists a user."""
        return (*super().wants, *(("joystick",) if self.wish == "user" else ()))


RDS = Component(
    spec=RdsSpec,
    build="crowdbot.plugins.planners.rds.rds_build:build",
    summary="reactive driving support, for long robots (Gonon, Paez-Granados, Billard 2021)",
)
