"""Hesitation: how long the planner braked."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Gt, Le
from crowdbot.plugin import MetricSpec, declare_metric
from pydantic import Field

#: What `acme.swerve` logs: 0 for no brake, 1 for standing.
SIGNAL = "acme/brake"


class HesitationSpec(MetricSpec):
    """Time during which the planner brakes.

    Reads a signal that the planner logs; undefined for planners that do not.
    """

    kind: Literal["acme.hesitation"] = "acme.hesitation"
    threshold: Annotated[float, Gt(0), Le(1)] = Field(
        default=0.5, description="Brake that counts as hesitating, as a fraction of the full one."
    )


HESITATION = declare_metric(
    HesitationSpec,
    symbol="t_h",
    unit="s",
    better="lower",
    category="planner",
    minimum=0.0,
    variants={"corrected": {}, "share": {"unit": "1", "maximum": 1.0}},
    signals=(SIGNAL,),
)
