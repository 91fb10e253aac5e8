"""Metrics of the deviation from the path that the robot takes alone."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import DtwSpacing, DtwThreshold, JumpSpeed

declare = partial(declare_metric, category="path efficiency", minimum=0.0)


class AdeToReferenceSpec(MetricSpec):
    """Mean distance between the positions in the crowd and alone."""

    kind: Literal["ade_to_reference"] = "ade_to_reference"


ADE_TO_REFERENCE = declare(
    AdeToReferenceSpec, symbol="ADE", unit="m", better="lower", self_value=0.0
)


class FdeToReferenceSpec(MetricSpec):
    """Final distance between the positions in the crowd and alone."""

    kind: Literal["fde_to_reference"] = "fde_to_reference"


FDE_TO_REFERENCE = declare(
    FdeToReferenceSpec, symbol="FDE", unit="m", better="lower", self_value=0.0
)


class NdtwSpec(MetricSpec):
    """Likeness of the path in the crowd to the path alone, by dynamic time warping."""

    kind: Literal["ndtw"] = "ndtw"
    dtw_threshold: DtwThreshold
    dtw_spacing: DtwSpacing
    jump_speed: JumpSpeed


NDTW = declare(NdtwSpec, symbol="nDTW", unit="1", better="higher", maximum=1.0, self_value=1.0)


class SdtwSpec(MetricSpec):
    """Success, weighted by the likeness of the path to the path alone."""

    kind: Literal["sdtw"] = "sdtw"
    dtw_threshold: DtwThreshold
    dtw_spacing: DtwSpacing
    jump_speed: JumpSpeed


SDTW = declare(SdtwSpec, symbol="SDTW", unit="1", better="higher", maximum=1.0)
