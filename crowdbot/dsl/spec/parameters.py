"""Parameters that each agent samples for itself."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from annotated_types import Ge
from pydantic import ConfigDict, Discriminator, Field, Tag, model_validator

from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.quantities import (
    NonNegativeDuration,
    NonNegativeLength,
    NonNegativeSpeed,
    PositiveAcceleration,
    PositiveLength,
    PositiveMass,
    PositiveSpeed,
    Quantity,
)
from crowdbot.dsl.spec.spec import Spec
from crowdbot.dsl.spec.unions import AnyOf


class Sample(Spec):
    """A number that each agent samples uniformly between value - spread and value + spread.

    A bare number is the short form without spread.
    """

    model_config = ConfigDict(json_schema_extra={"short": "value"})
    may_be_zero: ClassVar[bool] = False
    value: float
    spread: float

    @model_validator(mode="before")
    @classmethod
    def _short_form(cls, value: Any) -> Any:
        return {"value": value} if isinstance(value, int | float | str) else value

    @model_validator(mode="after")
    def _stays_positive(self) -> Sample:
        if self.spread > self.value or (self.spread == self.value and not self.may_be_zero):
            raise ValueError(
                f"the spread {self.spread:g} must be smaller than the value {self.value:g}"
            )
        return self


class LengthSample(Sample):
    """A length, m; each agent samples uniformly between value - spread and value + spread."""

    value: PositiveLength = Field(description="Middle, m.")
    spread: NonNegativeLength = default(0.0, "Largest difference from it, m.")


class SpeedSample(Sample):
    """A speed, m/s; each agent samples uniformly between value - spread and value + spread."""

    value: PositiveSpeed = Field(description="Middle, m/s.")
    spread: NonNegativeSpeed = default(0.0, "Largest difference from it, m/s.")


class AccelerationSample(Sample):
    """An acceleration, m/s^2; sampled uniformly between value - spread and value + spread."""

    value: PositiveAcceleration = Field(description="Middle, m/s^2.")
    spread: Annotated[float, Ge(0), Quantity("acceleration")] = default(
        0.0, "Largest difference from it, m/s^2."
    )


class MassSample(Sample):
    """A mass, kg; each agent samples uniformly between value - spread and value + spread."""

    value: PositiveMass = Field(description="Middle, kg.")
    spread: Annotated[float, Ge(0), Quantity("mass")] = default(
        0.0, "Largest difference from it, kg."
    )


class DurationSample(Sample):
    """A duration, s; each agent samples uniformly between value - spread and value + spread."""

    may_be_zero: ClassVar[bool] = True
    value: NonNegativeDuration = Field(description="Middle, s.")
    spread: NonNegativeDuration = default(0.0, "Largest difference from it, s.")


class SpeedDistribution(Spec):
    """Preferred speeds: a normal distribution, truncated at three standard deviations."""

    mean: PositiveSpeed = Field(description="Mean preferred speed, m/s.")
    std: NonNegativeSpeed = Field(description="Standard deviation, m/s.")


def _speed_tag(value: Any) -> str:
    normal = isinstance(value, SpeedDistribution) or (
        isinstance(value, dict) and bool({"mean", "std"} & value.keys())
    )
    return "<normal>" if normal else "<uniform>"


#: Preferred speeds: normal, or uniform around a value.
SpeedChoice = Annotated[
    Annotated[SpeedSample, Tag("<uniform>")] | Annotated[SpeedDistribution, Tag("<normal>")],
    Discriminator(_speed_tag),
    AnyOf(),
]
