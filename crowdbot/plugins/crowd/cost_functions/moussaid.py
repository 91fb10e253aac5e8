"""Moussaid: the free distance in each direction.

Source: Moussaïd, Helbing, Theraulaz, "How simple rules determine pedestrian behavior and
crowd disasters", PNAS 108 (2011), in the form of van Toll et al., I3D 2020.
"""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge
from pydantic import Field

from crowdbot.plugin import Component, CostFunctionSpec, PositiveLength, Range


class MoussaidSpec(CostFunctionSpec):
    """Heads for the visible free point nearest to the goal, at a safe speed."""

    kind: Literal["moussaid"] = "moussaid"
    weight: Annotated[float, Ge(0)] = Field(default=1.0, description="Factor of the cost.")
    range: Range = Field(default=Range(), description="Which neighbours and walls count.")
    d_max: PositiveLength = Field(default=8.0, description="How far the way is looked at, m.")


MOUSSAID = Component(
    spec=MoussaidSpec,
    summary="heading by free way, speed by time to collision (Moussaïd et al. 2011)",
)
