"""Moussaid: the free distance in each direction.

Source: Moussaïd, Helbing, Theraulaz, "How simple rules determine pedestrian behavior and
crowd disasters", PNAS 108 (2011), in the form of van Toll et al., I3D 2020.
"""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge

from crowdbot.plugin import Component, CostFunctionSpec, PositiveLength, Range, default


class MoussaidSpec(CostFunctionSpec):
    """Heads for the visible free point nearest to the goal, at a safe speed."""

    kind: Literal["moussaid"] = "moussaid"
    weight: Annotated[float, Ge(0)] = default(1.0, "Factor of the cost.")
    range: Range = default(Range(), "Which neighbours and walls count.")
    d_max: PositiveLength = default(8.0, "How far the way is looked at, m.")


MOUSSAID = Component(
    spec=MoussaidSpec,
    summary="heading by free way, speed by time to collision (Moussaïd et al. 2011)",
)
