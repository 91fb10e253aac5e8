"""Hesitation: how long the planner braked."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Gt, Le
from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec
from pydantic import Field

#: What `acme.swerve` logs: 0 for no brake, 1 for standing.
SIGNAL = "acme/brake"


class HesitationSpec(MetricSpec):
    """Reads a signal that the planner logs; undefined for planners that do not."""

    kind: Literal["acme.hesitation"] = "acme.hesitation"
    threshold: Annotated[float, Gt(0), Le(1)] = Field(
        default=0.5, description="Brake that counts as hesitating, as a fraction of the full one."
    )


HESITATION = MetricComponent(
    spec=HesitationSpec,
    build="crowdbot_acme.hesitation_build:Hesitation",
    summary="t_h: time during which the planner brakes",
    label=ScoreLabel(
        metric="acme.hesitation",
        symbol="t_h",
        category="planner",
        unit="s",
        better="lower",
        variants=("corrected", "share"),
        units={"share": "1"},
    ),
    laws={
        "corrected": Laws(least=0.0, finer="near"),
        "share": Laws(least=0.0, most=1.0, finer="near"),
    },
    signals=(SIGNAL,),
)
