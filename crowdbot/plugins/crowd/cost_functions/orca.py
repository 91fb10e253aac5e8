"""ORCA: optimal reciprocal collision avoidance.

Source: van den Berg, Guy, Lin, Manocha, "Reciprocal n-body collision avoidance", ISRR 2009.
"""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge
from pydantic import Field

from crowdbot.plugin import Component, CostFunctionSpec, PositiveDuration, Range


class OrcaSpec(CostFunctionSpec):
    """The velocity nearest to the preferred one that stays safe for a time horizon."""

    kind: Literal["orca"] = "orca"
    weight: Annotated[float, Ge(0)] = Field(default=1.0, description="Factor of the cost.")
    range: Range = Field(default=Range(), description="Which neighbours and walls count.")
    time_horizon: PositiveDuration = Field(
        default=5.0, description="How long the velocity has to be safe, s."
    )
    limit: Literal["max_speed", "preferred_speed"] = Field(
        default="max_speed",
        exclude_if=lambda value: value == "max_speed",
        description="Largest speed of the optimum: the agent's, as in the original, or the "
        "preferred one, so that people do not hurry out of others' way.",
    )


ORCA = Component(
    spec=OrcaSpec,
    summary="optimal reciprocal collision avoidance (van den Berg et al. 2009)",
)
