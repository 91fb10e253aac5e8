"""Speckle: errors that grow with the distance."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge
from crowdbot.plugin import Component, NoiseSpec
from pydantic import Field


class SpeckleSpec(NoiseSpec):
    """A normally distributed error, drawn for every beam of every reading."""

    kind: Literal["acme.speckle"] = "acme.speckle"
    relative: Annotated[float, Ge(0)] = Field(
        default=0.01, description="Standard deviation as a fraction of the distance."
    )


SPECKLE = Component(
    spec=SpeckleSpec,
    build="crowdbot_acme.speckle_build:build",
    summary="errors that grow with the distance",
)
