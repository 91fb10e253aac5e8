"""VanToll: free distance, deviation and inertia in one sum.

Source: van Toll, Pettré, the synthesis used in van Toll et al., "Generalized Microscopic
Crowd Simulation using Costs in Velocity Space", I3D 2020.
"""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge

from crowdbot.plugin import Component, CostFunctionSpec, PositiveLength, Range, default


class VanTollSpec(CostFunctionSpec):
    """Weighs the free distance against turning away from the goal and from the present velocity."""

    kind: Literal["van_toll"] = "van_toll"
    weight: Annotated[float, Ge(0)] = default(1.0, "Factor of the cost.")
    range: Range = default(Range(), "Which neighbours and walls count.")
    max_distance: PositiveLength = default(8.0, "How far the way is looked at, m.")


VAN_TOLL = Component(
    spec=VanTollSpec,
    summary="free way, deviation and inertia (van Toll et al. 2020)",
)
