"""Fields shared by all cost functions."""

from __future__ import annotations

from typing import Annotated

from annotated_types import Ge

from crowdbot.plugin import CostFunctionSpec, Range, default


class WeightedCostSpec(CostFunctionSpec):
    """Abstract cost function with a weight and a range."""

    weight: Annotated[float, Ge(0)] = default(1.0, "Factor of the cost.")
    range: Range = default(Range(), "Which neighbours and walls count.")
