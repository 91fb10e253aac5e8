"""TtcaDca: time to and distance of closest approach.

Source: Dutra, Marques, Cavalcante-Neto, Vidal, Pettré, "Gradient-based steering for
vision-based crowd simulation algorithms", CGF 2017, in the form of van Toll et al., I3D 2020.
"""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge
from pydantic import Field

from crowdbot.plugin import (
    Component,
    CostFunctionSpec,
    PositiveAngle,
    PositiveDuration,
    PositiveLength,
    PositiveSpeed,
    Range,
)


class TtcaDcaSpec(CostFunctionSpec):
    """Mid-term collision avoidance and goal seeking."""

    kind: Literal["ttca_dca"] = "ttca_dca"
    weight: Annotated[float, Ge(0)] = Field(default=1.0, description="Factor of the cost.")
    range: Range = Field(default=Range(), description="Which neighbours count.")
    sigma_ttca: PositiveDuration = Field(default=1.0, description="Spread in time, s.")
    sigma_dca: PositiveLength = Field(default=0.3, description="Spread in distance, m.")
    sigma_angle_goal: PositiveAngle = Field(default=2.0, description="Spread in heading, rad.")
    sigma_speed_goal: PositiveSpeed = Field(default=2.0, description="Spread in speed, m/s.")
    walls: bool = Field(
        default=False,
        description="Whether the nearest point of each wall counts as a neighbour that stands.",
    )


TTCA_DCA = Component(
    spec=TtcaDcaSpec,
    summary="time to and distance of closest approach (Dutra et al. 2017)",
    exceptions={
        "check_gradient": "Dutra et al. turn and speed up, which is not a derivative of this cost"
    },
)
