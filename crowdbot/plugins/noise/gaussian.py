"""Gaussian noise."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from crowdbot.plugin import Component, Length, NoiseSpec, NonNegativeLength, default


class GaussianSpec(NoiseSpec):
    """Normally distributed noise, drawn independently for every beam of every reading."""

    kind: Literal["gaussian"] = "gaussian"
    std: NonNegativeLength = Field(description="Standard deviation, m.")
    mean: Length = default(0.0, "Mean, m.")


GAUSSIAN = Component(
    spec=GaussianSpec,
    summary="normally distributed errors",
    examples=({"std": "1 mm"},),
)
