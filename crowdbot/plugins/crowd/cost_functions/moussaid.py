"""Moussaid: the free distance in each direction.

Source: Moussaïd, Helbing, Theraulaz, "How simple rules determine pedestrian behavior and
crowd disasters", PNAS 108 (2011), in the form of van Toll et al., I3D 2020.
"""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import Component, PositiveLength, default
from crowdbot.plugins.crowd.cost_functions.weighted_cost import WeightedCostSpec


class MoussaidSpec(WeightedCostSpec):
    """Heads for the visible free point nearest to the goal, at a safe speed."""

    kind: Literal["moussaid"] = "moussaid"
    d_max: PositiveLength = default(8.0, "How far the way is looked at, m.")


MOUSSAID = Component(
    spec=MoussaidSpec,
    summary="heading by free way, speed by time to collision (Moussaïd et al. 2011)",
)
