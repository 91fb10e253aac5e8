"""PowerLaw: a force that follows the measured law of interaction.

Source: Karamouzas, Skinner, Guy, "Universal power law governing pedestrian interactions",
PRL 113 (2014), in the form of van Toll et al., I3D 2020.
"""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge

from crowdbot.plugin import Component, PositiveDuration, default
from crowdbot.plugins.crowd.cost_functions.weighted_cost import WeightedCostSpec


class PowerLawSpec(WeightedCostSpec):
    """Pushes away from collisions with a power law of the time left."""

    kind: Literal["power_law"] = "power_law"
    k: Annotated[float, Ge(0)] = default(1.5, "Strength, m^2.")
    tau0: PositiveDuration = default(3.0, "Collisions later than this do not count, s.")


POWER_LAW = Component(
    spec=PowerLawSpec,
    summary="power law of the time to collision (Karamouzas et al. 2014)",
)
