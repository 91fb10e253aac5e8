"""Infrared range sensor."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le

from crowdbot.plugin import Component, Incidence, Quantity, RangeSensorSpec, TiltableMount, default


class InfraredSpec(RangeSensorSpec):
    """Measures the nearest surface that faces a narrow beam; the floor only if tilted."""

    kind: Literal["infrared"] = "infrared"
    mount: TiltableMount = default(TiltableMount(), "Pose on the robot.")
    dispersion: Annotated[float, Gt(0), Le(0.5), Quantity("angle")] = default(
        math.pi / 360, "Angle from the axis to the edge of the beam, rad."
    )
    rays: Annotated[int, Ge(1), Le(10_000)] = default(
        100, "Random rays of one reading, denser near the axis."
    )
    max_incidence: Incidence = default(
        math.pi / 4, "Surfaces struck at a larger angle to their normal return nothing, rad."
    )

    def field_of_view(self) -> tuple[float, float, float]:
        """Return first and last angle, rad, and range, m, for drawings."""
        return -self.dispersion, self.dispersion, self.range_max


INFRARED = Component(
    spec=InfraredSpec,
    summary="narrow beam that sees what faces it",
    exceptions={"check_exact_without_noise": "its rays are random for each reading"},
)
