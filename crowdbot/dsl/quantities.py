"""Physical quantities: SI floats that also read ``"0.8 m/s"``.

A bare number is in the SI unit of its dimension. A string is ``<number> <unit>``; a unit of
another dimension is an error that lists the known ones.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Annotated, Any

from annotated_types import Ge, Gt
from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

_DEG = math.pi / 180.0

#: dimension -> unit -> factor to SI. The first unit of each dimension is the SI unit.
UNITS: dict[str, dict[str, float]] = {
    "length": {"m": 1.0, "cm": 0.01, "mm": 0.001, "km": 1000.0, "ft": 0.3048, "in": 0.0254},
    "speed": {"m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001, "km/h": 1.0 / 3.6, "mph": 0.44704},
    "acceleration": {"m/s^2": 1.0, "cm/s^2": 0.01},
    "angle": {"rad": 1.0, "deg": _DEG, "°": _DEG, "turn": 2.0 * math.pi},
    "angular speed": {"rad/s": 1.0, "deg/s": _DEG, "rpm": 2.0 * math.pi / 60.0},
    "angular acceleration": {"rad/s^2": 1.0, "deg/s^2": _DEG},
    "duration": {"s": 1.0, "ms": 0.001, "us": 1e-6, "min": 60.0, "h": 3600.0},
    "frequency": {"Hz": 1.0, "1/s": 1.0, "kHz": 1000.0},
    "density": {"1/m^2": 1.0, "p/m^2": 1.0},
    "mass": {"kg": 1.0, "g": 0.001, "t": 1000.0},
    "stiffness": {"N/m": 1.0, "N/mm": 1000.0, "kN/m": 1000.0},
    "steering stiffness": {"1/s^2": 1.0},
    "damping": {"s/m": 1.0},
}

_TEXT = re.compile(r"^([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(\S.*)$")


@dataclass(frozen=True, slots=True)
class Quantity:
    """Annotation that makes a float field accept text with a unit of one dimension."""

    dimension: str

    @property
    def si_unit(self) -> str:
        """The unit of a bare number."""
        return next(iter(UNITS[self.dimension]))

    def parse(self, value: object) -> object:
        """Turn text into an SI float; leave everything else to the float schema.

        Raises:
            PydanticCustomError: the text is no number with a unit of this dimension.
        """
        if not isinstance(value, str):
            return value
        units = UNITS[self.dimension]
        match = _TEXT.match(value.strip())
        factor = units.get(match[2].strip()) if match else None
        if match is None or factor is None:
            raise PydanticCustomError(
                "quantity",
                "'{text}' is not a quantity of {dimension} (known units: {units})",
                {"text": value, "dimension": self.dimension, "units": ", ".join(units)},
            )
        return float(match[1]) * factor

    def __get_pydantic_core_schema__(
        self, source: type[Any], handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        number = handler(source)
        units = "|".join(re.escape(u) for u in UNITS[self.dimension])
        text = core_schema.str_schema(pattern=rf"^[+-]?[0-9.]+([eE][+-]?[0-9]+)? ?({units})$")
        return core_schema.no_info_before_validator_function(
            self.parse,
            number,
            json_schema_input_schema=core_schema.union_schema([number, text]),
        )


Length = Annotated[float, Quantity("length")]
PositiveLength = Annotated[float, Gt(0), Quantity("length")]
NonNegativeLength = Annotated[float, Ge(0), Quantity("length")]
Speed = Annotated[float, Quantity("speed")]
PositiveSpeed = Annotated[float, Gt(0), Quantity("speed")]
NonNegativeSpeed = Annotated[float, Ge(0), Quantity("speed")]
PositiveAcceleration = Annotated[float, Gt(0), Quantity("acceleration")]
Angle = Annotated[float, Quantity("angle")]
PositiveAngle = Annotated[float, Gt(0), Quantity("angle")]
PositiveAngularSpeed = Annotated[float, Gt(0), Quantity("angular speed")]
PositiveAngularAcceleration = Annotated[float, Gt(0), Quantity("angular acceleration")]
PositiveDuration = Annotated[float, Gt(0), Quantity("duration")]
NonNegativeDuration = Annotated[float, Ge(0), Quantity("duration")]
PositiveFrequency = Annotated[float, Gt(0), Quantity("frequency")]
PositiveDensity = Annotated[float, Gt(0), Quantity("density")]
PositiveMass = Annotated[float, Gt(0), Quantity("mass")]
PositiveStiffness = Annotated[float, Gt(0), Quantity("stiffness")]
NonNegativeSteeringStiffness = Annotated[float, Ge(0), Quantity("steering stiffness")]
NonNegativeDamping = Annotated[float, Ge(0), Quantity("damping")]
