"""RVO: reciprocal velocity obstacles as a cost.

Source: van den Berg, Lin, Manocha, "Reciprocal velocity obstacles for real-time multi-agent
navigation", ICRA 2008, in the form of van Toll et al., I3D 2020.
"""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge

from crowdbot.plugin import Component, default
from crowdbot.plugins.crowd.cost_functions.weighted_cost import WeightedCostSpec


class RvoSpec(WeightedCostSpec):
    """Reflex against imminent collisions with people and walls."""

    kind: Literal["rvo"] = "rvo"
    w: Annotated[float, Ge(0)] = default(1.0, "Weight of the collision term, m.")


RVO = Component(spec=RvoSpec, summary="reciprocal velocity obstacles (van den Berg et al. 2008)")
