"""Errors that can be added to readings of any sensor: Gaussian, offset, peak.

Source: annex of the report CrowdBot D7.3.

Their numbers are in the units of the reading, which are SI units.
"""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le
from pydantic import Field

from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.spec import Spec


class _ReadingError(Spec):
    """Fields that every error of a reading has."""

    entries: tuple[Annotated[int, Ge(0)], ...] | None = default(
        None,
        "Which numbers of a reading, counted from 0 along its last axis: 2 is the yaw "
        "of odometry; unset: all.",
        strict=False,
        min_length=1,
    )


class GaussianError(_ReadingError):
    """A normally distributed error, drawn for every number of every reading."""

    kind: Literal["gaussian"] = "gaussian"
    std: Annotated[float, Ge(0)] = Field(description="Standard deviation, unit of the reading.")
    mean: float = default(0.0, "Mean, unit of the reading.")


class OffsetError(_ReadingError):
    """A constant error."""

    kind: Literal["offset"] = "offset"
    value: float = Field(description="Added to every number, unit of the reading.")


class PeakError(_ReadingError):
    """Rare, large errors."""

    kind: Literal["peak"] = "peak"
    probability: Annotated[float, Ge(0), Le(1)] = default(
        0.01, "Probability of a peak in each number of each reading."
    )
    mean: float = default(2.0, "Mean height of a peak, unit of the reading.")
    std: Annotated[float, Ge(0)] = default(
        1.0, "Standard deviation of heights, unit of the reading."
    )


ReadingError = Annotated[GaussianError | OffsetError | PeakError, Field(discriminator="kind")]
