"""Fields shared by all range sensors."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar

from annotated_types import Ge, Gt, Le, Lt
from pydantic import BeforeValidator, SerializeAsAny, model_validator

from crowdbot.dsl.spec.component_specs import NoiseSpec, SensorSpec
from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.quantities import (
    NonNegativeLength,
    PositiveFrequency,
    PositiveLength,
    Quantity,
)
from crowdbot.dsl.spec.spec import Mount

#: Largest number of rays per reading; more is a typing error.
MOST_RAYS = 200_000

Incidence = Annotated[float, Gt(0), Le(math.pi / 2), Quantity("angle")]


def _short_form(value: Any) -> Any:
    """Convert a bare length to the standard deviation of a Gaussian named ``range``."""
    is_length = isinstance(value, int | float | str) and not isinstance(value, bool)
    if value in (0, "0") and is_length:
        return {}
    return {"range": {"kind": "gaussian", "std": value}} if is_length else value


NoiseMap = dict[str, SerializeAsAny[NoiseSpec]]


class RangeSensorSpec(SensorSpec):
    """Abstract sensor that measures distances."""

    parts_field: ClassVar[str] = "noise"
    mount: Mount = default(Mount(), "Pose on the robot.")
    rate: PositiveFrequency = default(8.0, "Readings per second, Hz.", le=128)
    range_min: NonNegativeLength = default(0.2, "Nearest reading; what is nearer reads this, m.")
    range_max: PositiveLength = default(4.5, "Farthest hit, m.")
    max_incidence: Incidence = default(
        math.pi / 2, "Surfaces struck at a larger angle to their normal return nothing, rad."
    )
    bits: Annotated[int, Ge(0), Le(32)] = default(
        0, "Readings are rounded down to 2^bits steps of the range; 0: no rounding."
    )
    dropout: Annotated[float, Ge(0), Lt(1)] = default(0.0, "Probability that a reading is lost.")
    noise: Annotated[
        NoiseMap, BeforeValidator(_short_form, json_schema_input_type=NonNegativeLength | NoiseMap)
    ] = default({}, "Named errors, added in the order of names; a length is one Gaussian's std.")

    @model_validator(mode="after")
    def _range_ordered(self) -> RangeSensorSpec:
        if not self.range_min < self.range_max:
            raise ValueError("range_min must be below range_max")
        return self
