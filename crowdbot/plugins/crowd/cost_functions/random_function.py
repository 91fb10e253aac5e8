"""RandomFunction: noise, for tests and to break ties.

Source: van Toll et al., "Generalized Microscopic Crowd Simulation using Costs in Velocity
Space", I3D 2020.
"""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import Component, Range, default
from crowdbot.plugins.crowd.cost_functions.weighted_cost import WeightedCostSpec


class RandomFunctionSpec(WeightedCostSpec):
    """A random cost between 0 and 2, from each agent's own generator."""

    kind: Literal["random_function"] = "random_function"
    range: Range = default(Range(), "Has no effect: no neighbour counts.")


RANDOM_FUNCTION = Component(
    spec=RandomFunctionSpec,
    summary="random cost between 0 and 2",
    exceptions={"check_gradient": "random costs per candidate have no slope"},
)
