"""Bumper: senses which sides of the robot touch something."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from annotated_types import Ge, Le
from pydantic import model_validator

from crowdbot.plugin import (
    Angle,
    Component,
    Mount,
    NonNegativeLength,
    PositiveFrequency,
    PositiveLength,
    SensorSpec,
    default,
)


class BumperSpec(SensorSpec):
    """Reading: 1 for each sector in contact, else 0; from ``angle_min`` on, counter-clockwise.

    The defaults are those of the Kobuki: right, centre and left of the front half.
    """

    kind: Literal["bumper"] = "bumper"
    mount: Mount = default(Mount(), "Centre of the ring; only x, y, yaw count.")
    rate: PositiveFrequency = default(64.0, "Readings per second, Hz.", le=128)
    sectors: Annotated[int, Ge(1), Le(360)] = default(3, "Number of sectors.")
    angle_min: Angle = default(-math.pi / 2, "Begin of the first sector, rad.")
    angle_max: Angle = default(math.pi / 2, "End of the last sector, rad.")
    radius: PositiveLength = default(0.178, "Radius of the ring, m.")
    reach: NonNegativeLength = default(0.002, "How far out of the ring it feels, m.")
    height: PositiveLength = default(0.42, "Walls whose lower edge is above this are not felt, m.")

    @model_validator(mode="after")
    def _within_a_turn(self) -> BumperSpec:
        if not 0.0 < self.angle_max - self.angle_min <= 2.0 * math.pi + 1e-9:
            raise ValueError("angle_max must be above angle_min by one turn at most")
        return self


BUMPER = Component(
    spec=BumperSpec,
    summary="sectors around the robot that touch people, walls or pillars",
)
