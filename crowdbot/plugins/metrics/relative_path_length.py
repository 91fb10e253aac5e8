"""Relative path length: how much farther the robot drives because of the crowd."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge
from pydantic import Field

from crowdbot.core.component import Component
from crowdbot.dsl.base import MetricSpec
from crowdbot.dsl.quantities import PositiveSpeed


class RelativePathLengthSpec(MetricSpec):
    """Length of the path alone, over length of the path in the crowd."""

    kind: Literal["relative_path_length"] = "relative_path_length"
    zero_tol: Annotated[float, Ge(0)] = Field(
        default=1e-9, description="A denominator up to this counts as zero, m."
    )
    jump_speed: PositiveSpeed = Field(default=10.0, description="A faster step is a teleport, m/s.")


RELATIVE_PATH_LENGTH = Component(
    spec=RelativePathLengthSpec,
    build="crowdbot.plugins.metrics.relative_path_length_build:build",
    summary="L_rp: path length alone over path length in the crowd",
)
