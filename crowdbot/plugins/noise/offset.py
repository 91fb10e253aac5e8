"""Constant offset."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from crowdbot.plugin import Component, Length, NoiseSpec


class OffsetSpec(NoiseSpec):
    """A sensor that always reads too far or too near by the same distance."""

    kind: Literal["offset"] = "offset"
    value: Length = Field(description="Added to every hit, m.")


OFFSET = Component(spec=OffsetSpec, summary="the same error always", examples=({"value": "2 cm"},))
