"""ORCA: optimal reciprocal collision avoidance.

Source: van den Berg, Guy, Lin, Manocha, "Reciprocal n-body collision avoidance", ISRR 2009.
"""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import Component, PositiveDuration, default
from crowdbot.plugins.crowd.cost_functions.weighted_cost import WeightedCostSpec


class OrcaSpec(WeightedCostSpec):
    """The velocity nearest to the preferred one that stays safe for a time horizon."""

    kind: Literal["orca"] = "orca"
    time_horizon: PositiveDuration = default(5.0, "How long the velocity has to be safe, s.")
    limit: Literal["max_speed", "preferred_speed"] = default(
        "max_speed",
        "Largest speed of the optimum: the agent's, as in the original, or the "
        "preferred one, so that people do not hurry out of others' way.",
        omitted=True,
    )


ORCA = Component(
    spec=OrcaSpec,
    summary="optimal reciprocal collision avoidance (van den Berg et al. 2009)",
)
