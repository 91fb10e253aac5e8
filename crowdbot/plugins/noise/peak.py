"""Peak noise: rare, large errors."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import Component, Length, NoiseSpec, NonNegativeLength, default


class PeakSpec(NoiseSpec):
    """Rare large errors of a beam, as after a double reflection or cross-talk."""

    kind: Literal["peak"] = "peak"
    probability: Annotated[float, Ge(0), Le(1)] = default(
        0.01, "Probability of a peak for each beam."
    )
    mean: Length = default(2.0, "Mean height of a peak, m.")
    std: NonNegativeLength = default(1.0, "Standard deviation of heights, m.")


PEAK = Component(spec=PeakSpec, summary="rare, large errors")
