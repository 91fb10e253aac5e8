"""GoalReachingForce: the driving term of the social forces.

Source: Helbing, Molnár, "Social force model for pedestrian dynamics", PRE 51 (1995), in the
form of van Toll et al., I3D 2020.
"""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import Component, Range, default
from crowdbot.plugins.crowd.cost_functions.weighted_cost import WeightedCostSpec


class GoalReachingForceSpec(WeightedCostSpec):
    """Pulls towards the preferred velocity within the policy's relaxation time."""

    kind: Literal["goal_reaching_force"] = "goal_reaching_force"
    range: Range = default(Range(), "Has no effect: no neighbour counts.")


GOAL_REACHING_FORCE = Component(
    spec=GoalReachingForceSpec,
    summary="driving force to the preferred velocity (Helbing and Molnár 1995)",
)
