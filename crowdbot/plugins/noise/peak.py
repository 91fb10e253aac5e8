"""Peak noise: rare, large errors."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le
from pydantic import Field

from crowdbot.plugin import Component, Length, NoiseSpec, NonNegativeLength


class PeakSpec(NoiseSpec):
    """Rare large errors of a beam, as after a double reflection or cross-talk."""

    kind: Literal["peak"] = "peak"
    probability: Annotated[float, Ge(0), Le(1)] = Field(
        default=0.01, description="Probability of a peak for each beam."
    )
    mean: Length = Field(default=2.0, description="Mean height of a peak, m.")
    std: NonNegativeLength = Field(default=1.0, description="Standard deviation of heights, m.")


PEAK = Component(spec=PeakSpec, summary="rare, large errors")
