"""Ultrasonic range sensor."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import (
    Component,
    PositiveLength,
    Quantity,
    RangeSensorSpec,
    TiltableMount,
    default,
)

_DEGREE = math.pi / 180.0


class UltrasoundSpec(RangeSensorSpec):
    """Measures the nearest object in a drop-shaped zone, whatever its orientation.

    Only a tilted sensor sees the floor, wherever the zone meets it; `max_incidence` drops echoes
    that a smooth floor would reflect away from the sensor.
    """

    kind: Literal["ultrasound"] = "ultrasound"
    mount: TiltableMount = default(TiltableMount(), "Pose on the robot.")
    radius: PositiveLength = default(
        1.0, "Largest radius of the zone, at three quarters of its length, m."
    )
    resolution: Annotated[float, Ge(0.2 * _DEGREE), Le(10 * _DEGREE), Quantity("angle")] = default(
        2.0 * _DEGREE, "Between the rays that search the zone, rad."
    )

    @property
    def half_angle(self) -> float:
        """Return the zone's opening to one side, rad."""
        return math.atan(8.0 * self.radius / (3.0 * math.sqrt(3.0) * self.range_max))

    def field_of_view(self) -> tuple[float, float, float]:
        """Return first and last angle, rad, and range, m, for drawings."""
        return -self.half_angle, self.half_angle, self.range_max


ULTRASOUND = Component(spec=UltrasoundSpec, summary="sonar with a drop-shaped zone")
