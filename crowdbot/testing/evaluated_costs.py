"""Costs from a cost function, for its own tests."""

from __future__ import annotations

from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.velocity_search.cost import CompiledCost, NumpyCost
from crowdbot.core.crowd.velocity_search.evaluate import Evaluator
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts
from crowdbot.core.types.arrays import Array


def costs_at(cost: CompiledCost | NumpyCost, view: CrowdView, velocities: Array) -> Array:
    """Return weighted costs (N, S) of velocities (N, S, 2), m/s, for each agent of a view.

    Zero for agents that are absent or have arrived, ``inf`` for forbidden velocities.

    Raises:
        ValueError: a vectorised function returned NaN or a wrong number of costs.
    """
    return Evaluator(WeightedCosts([cost], view.agents)).total(view, velocities)
