"""A radar: how near the nearest person is, and how fast they come."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Gt, Le
from crowdbot.plugin import (
    Component,
    Mount,
    PositiveFrequency,
    PositiveLength,
    Quantity,
    SensorSpec,
)
from pydantic import Field


class RadarSpec(SensorSpec):
    """Reading: distance (m, inf for no one), closing speed (m/s) and bearing (rad) of one person.

    It looks through people and walls; a real radar does not.
    """

    kind: Literal["acme.radar"] = "acme.radar"
    mount: Mount = Field(default=Mount(), description="Pose on the robot.")
    rate: PositiveFrequency = Field(default=16.0, le=128, description="Readings per second, Hz.")
    range_max: PositiveLength = Field(default=5.0, description="Farthest person, m.")
    opening: Annotated[float, Gt(0), Le(7), Quantity("angle")] = Field(
        default=3.0, description="Opening of the cone, rad."
    )


RADAR = Component(
    spec=RadarSpec,
    build="crowdbot_acme.radar_build:build",
    summary="distance, closing speed and bearing of the nearest person ahead",
)
