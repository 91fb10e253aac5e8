"""Physical quantities: SI floats that also accept ``"0.8 m/s"``.

A bare number is in the SI unit of its dimension. Text is a decimal number and a unit of that
dimension, with or without blanks between them (``30deg``; a unit that begins with a digit, like
``1/m^2``, needs one). ``m/s²`` is ``m/s^2``, ``µs`` is ``us``, ``30°`` is ``30 deg``. Text without
a unit is an error: text implies a unit.

The value is the float nearest to the exact product of number and factor, so that ``5 cm`` is
0.05. In angles pi is the float ``math.pi``, so that ``30 deg`` is ``math.pi / 6`` to the last bit.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache
from typing import Annotated, Any

from annotated_types import Ge, Gt
from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError, PydanticKnownError, core_schema

from crowdbot.errors import did_you_mean, nearest

_PI = Fraction(math.pi)

#: dimension -> unit -> exact factor to SI. The first unit of each dimension is the SI unit.
#: Foot, inch and mile: the international ones of 1959.
_FACTORS: dict[str, dict[str, int | str | Fraction]] = {
    "length": {
        "m": 1, "cm": "0.01", "mm": "0.001", "km": 1000, "ft": "0.3048", "in": "0.0254",
    },
    "speed": {
        "m/s": 1, "cm/s": "0.01", "mm/s": "0.001", "km/h": "1000/3600", "mph": "0.44704",
    },
    "acceleration": {"m/s^2": 1, "cm/s^2": "0.01", "mm/s^2": "0.001"},
    "angle": {"rad": 1, "mrad": "0.001", "deg": _PI / 180, "turn": 2 * _PI},
    "angular speed": {"rad/s": 1, "mrad/s": "0.001", "deg/s": _PI / 180, "rpm": _PI / 30},
    "angular acceleration": {"rad/s^2": 1, "deg/s^2": _PI / 180},
    "duration": {"s": 1, "ms": "1e-3", "us": "1e-6", "min": 60, "h": 3600},
    "frequency": {"Hz": 1, "1/s": 1, "kHz": 1000},
    "density": {"1/m^2": 1, "p/m^2": 1},
    "mass": {"kg": 1, "g": "0.001", "t": 1000},
    "force": {"N": 1, "kN": 1000},
    "stiffness": {"N/m": 1, "N/cm": 100, "N/mm": 1000, "kN/m": 1000},
    "steering stiffness": {"1/s^2": 1},
    "damping": {"s/m": 1},
}  # fmt: skip
UNITS: dict[str, dict[str, Fraction]] = {
    dimension: {unit: Fraction(factor) for unit, factor in units.items()}
    for dimension, units in _FACTORS.items()
}

_NUMBER = r"[+-]?(?:(?:0|[1-9][0-9]*)(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_TEXT = re.compile(rf"({_NUMBER})( *)(.*)", re.DOTALL)
#: Other spellings of parts of a unit.
_SPELLINGS = {"²": "^2", "µ": "u", "μ": "u", "°": "deg"}
#: Largest number of digits; longer ones are not measurements, and huge powers of ten cost memory.
_MAX_DIGITS, _MAX_EXPONENT = 100, 400
#: Dimension -> largest amount, in SI units. Beyond it, squares of lengths, frequent in geometry,
#: lose too many digits.
MOST = {"length": 1e6}


@dataclass(frozen=True, slots=True)
class Quantity:
    """Annotation that lets a float field accept text with a unit of one dimension."""

    dimension: str
    #: Largest amount, in SI units; None: as in `MOST`.
    most: float | None = None

    @property
    def si_unit(self) -> str:
        """Return the unit of a bare number."""
        return next(iter(UNITS[self.dimension]))

    def parse(self, value: object) -> object:
        """Convert text to an SI float; other values are left to the float schema.

        Raises:
            PydanticCustomError: ``quantity``, the text is not a number with a unit of this
                dimension; its context has ``text``, ``dimension``, ``units`` and ``hint``.
        """
        if not isinstance(value, str):
            return value
        result = _in_si(self.dimension, value)
        if isinstance(result, float):
            return result
        raise self._error(value, result or self._advice(value))

    def within_reach(self, value: float) -> float:
        """Return the value; raise an error if it is unrealistically large.

        Raises:
            PydanticKnownError: it exceeds `MOST` of this dimension.
        """
        most = self.most or MOST.get(self.dimension, math.inf)
        if math.isfinite(value) and abs(value) > most:
            kind: Any = "less_than_equal" if value > 0.0 else "greater_than_equal"
            raise PydanticKnownError(kind, {kind[0] + "e": math.copysign(most, value)})
        return value

    def _error(self, text: str, hint: str) -> PydanticCustomError:
        return PydanticCustomError(
            "quantity",
            "'{text}' is not a quantity of {dimension} (known units: {units})",
            {
                "text": text,
                "dimension": self.dimension,
                "units": ", ".join(UNITS[self.dimension]),
                "hint": hint,
            },
        )

    def _advice(self, text: str) -> str:
        """Return a hint on what to write instead of a text that is not a quantity."""
        match = _TEXT.fullmatch(text)
        if match is None:
            return f"write a number and a unit, such as '1 {self.si_unit}'"
        number, _, unit = match.groups()
        if not unit:
            return f"write '{text.strip()} {self.si_unit}', or the number without quotes"
        name = plain_unit(unit.strip())
        if name in UNITS[self.dimension]:
            return f"write '{number} {name}'"
        if number in ("0", "+0", "-0") and name[0].isdigit():
            return "a number does not begin with a zero"
        if near := _near(name, UNITS[self.dimension]):
            return did_you_mean([near]).removeprefix("; ")
        owner = next((d for d, units in UNITS.items() if name in units), None)
        return f"'{name}' is a unit of {owner}" if owner else ""

    def __get_pydantic_core_schema__(
        self, source: type[Any], handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        number = handler(source)
        text = core_schema.str_schema(pattern=self.pattern(number.get("gt"), number.get("ge")))
        return core_schema.no_info_before_validator_function(
            self.parse,
            core_schema.no_info_after_validator_function(self.within_reach, number),
            json_schema_input_schema=core_schema.union_schema([number, text]),
        )

    def pattern(self, above: float | None = None, least: float | None = None) -> str:
        """Return a regular expression of the texts that `parse` accepts, for JSON Schema.

        Args:
            above: if 0, neither minus signs nor zeros fit.
            least: if 0, minus signs fit before zeros only.
        """
        units = _spellings(self.dimension)
        bare = "|".join(re.escape(u) for u in units if not u[0].isdigit())
        blank = "|".join(re.escape(u) for u in units if u[0].isdigit())
        tails = [f" *(?:{bare})" if bare else "", f" +(?:{blank})" if blank else ""]
        sign = {(True, False): r"(?!-)(?=\+?[0-9.]*[1-9])", (False, True): r"(?!-[0-9.]*[1-9])"}
        front = sign.get((above == 0, least == 0), "")
        return f"^{front}{_NUMBER}(?:{'|'.join(t for t in tails if t)})$"


@cache
def _spellings(dimension: str) -> tuple[str, ...]:
    """Return all spellings of all units of a dimension."""
    return tuple(text for unit in UNITS[dimension] for text in _written(unit))


def plain_unit(unit: str) -> str:
    """Return a unit as `UNITS` spells it."""
    for written, plain in _SPELLINGS.items():
        unit = unit.replace(written, plain)
    return unit


def _written(unit: str) -> list[str]:
    """Return all spellings of a unit."""
    found = [unit]
    for written, plain in _SPELLINGS.items():
        if plain != "u" or unit == "us":
            found += [other for u in found if (other := u.replace(plain, written)) != u]
    return list(dict.fromkeys(found))


def _near(name: str, units: dict[str, Fraction]) -> str | None:
    """Return the likely intended unit of a typing error, or None."""
    loose = {re.sub(r"[\^*·. ]", "", u).lower(): u for u in units}
    short = re.sub(r"[\^*·. ]", "", name).lower()
    short = short.replace("secs", "s").replace("sec", "s").replace("hr", "h")
    if short in loose:
        return loose[short]
    if short.startswith("/") and f"1{short}" in loose:
        return loose[f"1{short}"]
    words = {"metre": "m", "meter": "m", "second": "s", "degree": "deg", "hertz": "Hz",
             "radian": "rad", "minute": "min", "hour": "h", "kph": "km/h", "kmh": "km/h",
             "mps": "m/s"}  # fmt: skip
    word = words.get(short.removesuffix("s")) or words.get(short)
    if word in units:
        return word
    return next(iter(nearest(name, units, 1)), None) if len(name) > 2 else None


@lru_cache(maxsize=4096)  # a suite contains the same few amounts thousands of times
def _in_si(dimension: str, text: str) -> float | str:
    """Return the nearest float in SI units, or an error text; "" if it is not a quantity."""
    match = _TEXT.fullmatch(text)
    number, blank, unit = match.groups() if match else ("", "", "")
    factor = UNITS[dimension].get(plain_unit(unit))
    if match is None or factor is None or (unit[0].isdigit() and not blank):
        return ""
    exact = _exact(number)
    result = None if exact is None else _float(exact * factor)
    return "the number is too large, too small or too long" if result is None else result


def _exact(number: str) -> Fraction | None:
    """Return the exact number; None if it is outside the range of floats."""
    exponent = re.split("[eE]", number)[1:] or ["0"]
    if len(number) > _MAX_DIGITS or abs(int(exponent[0])) > _MAX_EXPONENT:
        return None
    return Fraction(number)


def _float(value: Fraction) -> float | None:
    """Return the nearest float; None if it overflows or underflows."""
    try:
        result = float(value)  # a quotient of integers, which Python rounds correctly
    except OverflowError:
        return None
    return None if result == 0.0 and value != 0 else result


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
PositiveForce = Annotated[float, Gt(0), Quantity("force")]
PositiveStiffness = Annotated[float, Gt(0), Quantity("stiffness")]
NonNegativeSteeringStiffness = Annotated[float, Ge(0), Quantity("steering stiffness")]
NonNegativeDamping = Annotated[float, Ge(0), Quantity("damping")]
