"""Find the cost function that returned NaN; the search itself only detects it."""

from __future__ import annotations

from typing import NoReturn

import numpy as np

from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.velocity_search.cost import CompiledCost
from crowdbot.core.crowd.velocity_search.evaluate import Evaluator
from crowdbot.core.crowd.velocity_search.surroundings import Surroundings
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts
from crowdbot.errors import PluginError

#: Candidates around each agent's velocity with which a function is tested again, m/s.
_SPEEDS, _ANGLES = np.linspace(0.0, 2.0, 9), np.linspace(-np.pi, np.pi, 25)


def check_numbers(costs: WeightedCosts, view: CrowdView, around: Surroundings) -> None:
    """Refuse a decision in which a compiled function returned NaN.

    Raises:
        PluginError: one did; the message names it, if known.
    """
    if around.deciding["broken"][0] != 0.0:
        report_broken(costs, view, "a cost")


def report_broken(costs: WeightedCosts, view: CrowdView | None, quantity: str) -> NoReturn:
    """Report the function that returned NaN: the one that does so again, or else all that may have.

    Raises:
        PluginError: always.
    """
    guilty = [c for c in costs.compiled if view is not None and _is_broken(costs, c, view)]
    for cost in guilty or costs.compiled:
        if cost.call is not None and (guilty or len(costs.compiled) == 1):
            cost.call.fail(f"returned NaN as {quantity}")
    names = " or ".join(c.call.title for c in guilty or costs.compiled if c.call is not None)
    raise PluginError(f"{names or 'a cost function'} returned NaN as {quantity}")


def _is_broken(costs: WeightedCosts, cost: CompiledCost, view: CrowdView) -> bool:
    """Return True if one function alone returns NaN for an agent."""
    alone = WeightedCosts(
        [cost], costs.agents, relaxation_time=costs.relaxation_time, parity=costs.parity
    )
    turned = np.stack([np.outer(_SPEEDS, f(_ANGLES)).ravel() for f in (np.cos, np.sin)], axis=-1)
    tried = view.velocity[:, np.newaxis] + turned
    found = Evaluator(alone).total(view, tried)
    return bool(np.any(np.isnan(found)))
