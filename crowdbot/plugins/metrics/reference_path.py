"""How far the crowd pushes the robot off the path it takes alone."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec


class AdeToReferenceSpec(MetricSpec):
    """Mean distance between the positions in the crowd and alone."""

    kind: Literal["ade_to_reference"] = "ade_to_reference"


class FdeToReferenceSpec(MetricSpec):
    """Last distance between the positions in the crowd and alone."""

    kind: Literal["fde_to_reference"] = "fde_to_reference"


ADE_TO_REFERENCE = MetricComponent(
    spec=AdeToReferenceSpec,
    build="crowdbot.plugins.metrics.reference_path_build:AdeToReference",
    summary="ADE: mean distance between the positions in the crowd and alone",
    label=ScoreLabel(
        metric="ade_to_reference",
        symbol="ADE",
        category="path efficiency",
        unit="m",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0, itself=0.0),
    },
)
FDE_TO_REFERENCE = MetricComponent(
    spec=FdeToReferenceSpec,
    build="crowdbot.plugins.metrics.reference_path_build:FdeToReference",
    summary="FDE: last distance between the positions in the crowd and alone",
    label=ScoreLabel(
        metric="fde_to_reference",
        symbol="FDE",
        category="path efficiency",
        unit="m",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0, itself=0.0),
    },
)

COMPONENTS = (
    ADE_TO_REFERENCE,
    FDE_TO_REFERENCE,
)
