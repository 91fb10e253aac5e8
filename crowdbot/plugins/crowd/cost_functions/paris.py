"""Paris: cost of passing before or behind each neighbour.

Source: Paris, Pettré, Donikian, "Pedestrian reactive navigation for crowd simulation: a predictive
approach", CGF 26 (2007), in the interpretation of van Toll et al., I3D 2020.
"""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import (
    Component,
    NonNegativeDuration,
    PositiveDuration,
    default,
)
from crowdbot.plugins.crowd.cost_functions.weighted_cost import WeightedCostSpec


class ParisSpec(WeightedCostSpec):
    """Rates each direction by the speeds at which an agent passes in front of or behind others."""

    kind: Literal["paris"] = "paris"
    w_a: Annotated[float, Ge(0), Le(1)] = default(
        0.5, "Share of others in the cost; the rest is the heading."
    )
    w_b: NonNegativeDuration = default(0.0, "Time added to the horizon in the urgency, s.")
    t_max: PositiveDuration = default(8.0, "Crossings later than this do not count, s.")


PARIS = Component(spec=ParisSpec, summary="passing before or behind others (Paris et al. 2007)")
