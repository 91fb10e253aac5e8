"""FOEAvoidance: the focus of expansion of the optical flow.

Source: López, Chaumette, Marchand, Pettré, "Character navigation in dynamic environments
based on optical flow", CGF 2019, in the form of van Toll et al., I3D 2020.
"""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import Component
from crowdbot.plugins.crowd.cost_functions.weighted_cost import WeightedCostSpec


class FoeAvoidanceSpec(WeightedCostSpec):
    """Turns and brakes so that no one stays in the focus of expansion."""

    kind: Literal["foe_avoidance"] = "foe_avoidance"


FOE_AVOIDANCE = Component(
    spec=FoeAvoidanceSpec,
    summary="focus of expansion of the optical flow (López et al. 2019)",
    exceptions={"check_gradient": "the model has a rule of its own for turning and braking"},
)
