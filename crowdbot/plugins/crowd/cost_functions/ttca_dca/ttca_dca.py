"""TtcaDca: time to and distance of closest approach.

Source: Dutra, Marques, Cavalcante-Neto, Vidal, Pettré, "Gradient-based steering for
vision-based crowd simulation algorithms", CGF 2017, in the form of van Toll et al., I3D 2020.
"""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import (
    Component,
    PositiveAngle,
    PositiveDuration,
    PositiveLength,
    PositiveSpeed,
    Range,
    default,
)
from crowdbot.plugins.crowd.cost_functions.weighted_cost import WeightedCostSpec


class TtcaDcaSpec(WeightedCostSpec):
    """Mid-term collision avoidance and goal seeking."""

    kind: Literal["ttca_dca"] = "ttca_dca"
    range: Range = default(Range(), "Which neighbours count.")
    sigma_ttca: PositiveDuration = default(1.0, "Spread in time, s.")
    sigma_dca: PositiveLength = default(0.3, "Spread in distance, m.")
    sigma_angle_goal: PositiveAngle = default(2.0, "Spread in heading, rad.")
    sigma_speed_goal: PositiveSpeed = default(2.0, "Spread in speed, m/s.")
    walls: bool = default(
        False, "Whether the nearest point of each wall counts as a neighbour that stands."
    )


TTCA_DCA = Component(
    spec=TtcaDcaSpec,
    summary="time to and distance of closest approach (Dutra et al. 2017)",
    exceptions={
        "check_gradient": "Dutra et al. turn and speed up, which is not a derivative of this cost"
    },
)
