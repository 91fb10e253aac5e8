"""FOEAvoidance: the focus of expansion of the optical flow.

Source: López, Chaumette, Marchand, Pettré, "Character navigation in dynamic environments
based on optical flow", CGF 2019, in the form of van Toll et al., I3D 2020.
"""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge

from crowdbot.plugin import Component, CostFunctionSpec, Range, default


class FoeAvoidanceSpec(CostFunctionSpec):
    """Turns and brakes so that no one stays in the focus of expansion."""

    kind: Literal["foe_avoidance"] = "foe_avoidance"
    weight: Annotated[float, Ge(0)] = default(1.0, "Factor of the cost.")
    range: Range = default(Range(), "Which neighbours and walls count.")


FOE_AVOIDANCE = Component(
    spec=FoeAvoidanceSpec,
    summary="focus of expansion of the optical flow (López et al. 2019)",
    exceptions={"check_gradient": "the model has a rule of its own for turning and braking"},
)
