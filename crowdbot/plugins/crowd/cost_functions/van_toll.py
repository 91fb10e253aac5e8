"""VanToll: free distance, deviation and inertia in one sum.

Source: van Toll, Pettré, the synthesis used in van Toll et al., "Generalized Microscopic
Crowd Simulation using Costs in Velocity Space", I3D 2020.
"""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import Component, PositiveLength, default
from crowdbot.plugins.crowd.cost_functions.weighted_cost import WeightedCostSpec


class VanTollSpec(WeightedCostSpec):
    """Weighs the free distance against turning away from the goal and from the present velocity."""

    kind: Literal["van_toll"] = "van_toll"
    max_distance: PositiveLength = default(8.0, "How far the way is looked at, m.")


VAN_TOLL = Component(
    spec=VanTollSpec,
    summary="free way, deviation and inertia (van Toll et al. 2020)",
)
