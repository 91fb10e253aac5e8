from __future__ import annotations

import math
import re
from decimal import Decimal
from fractions import Fraction
from typing import Annotated, Any

import pytest
from annotated_types import Ge, Gt
from hypothesis import assume, given
from hypothesis import strategies as st
from pydantic import BaseModel, ConfigDict, TypeAdapter, ValidationError

from crowdbot.dsl.spec.quantities import MOST, UNITS, Quantity, plain_unit

#: SI Brochure and the international yard and pound agreement; written out, not taken from UNITS.
KNOWN = [
    ("length", "5 cm", 0.05),
    ("length", "2 ft", 0.6096),
    ("length", "1 in", 0.0254),
    ("length", "3km", 3000.0),
    ("speed", "0.8 m/s", 0.8),
    ("speed", "3.6 km/h", 1.0),
    ("speed", "1 mph", 0.44704),
    ("speed", "80cm/s", 0.8),
    ("acceleration", "5 m/s²", 5.0),
    ("angle", "30 deg", math.pi / 6),
    ("angle", "-120°", -math.pi * 2 / 3),
    ("angle", "100 mrad", 0.1),
    ("angle", "1 turn", math.tau),
    ("angular speed", "90 °/s", math.pi / 2),
    ("angular speed", "60 rpm", math.tau),
    ("duration", "500 ms", 0.5),
    ("duration", "7 us", 7e-6),
    ("duration", "7 µs", 7e-6),
    ("duration", "7 μs", 7e-6),
    ("duration", "3 min", 180.0),
    ("duration", "0.5h", 1800.0),
    ("density", "0.5 1/m^2", 0.5),
    ("density", "0.5 p/m²", 0.5),
    ("mass", "75 kg", 75.0),
    ("mass", "500 g", 0.5),
    ("mass", "0.2 t", 200.0),
    ("frequency", "2 kHz", 2000.0),
    ("force", "1.5 kN", 1500.0),
    ("stiffness", "30 kN/m", 30000.0),
    ("stiffness", "30 N/mm", 30000.0),
    ("steering stiffness", "62.5 1/s²", 62.5),
    ("length", "1e-3 m", 0.001),
    ("length", "+.5 m", 0.5),
    ("length", "5. m", 5.0),
    ("length", "-2.5E+1m", -25.0),
]
WRONG = [
    ("length", "2 kg", "'kg' is a unit of mass"),
    ("length", "5", "write '5 m', or the number without quotes"),
    ("length", "m", "such as '1 m'"),
    ("length", "", "such as '1 m'"),
    ("length", "nan m", "such as '1 m'"),
    ("length", "inf m", "such as '1 m'"),
    ("length", "٣ m", "such as '1 m'"),
    ("length", "1_000 m", ""),
    ("length", "1,5 m", ""),
    ("length", "08 m", "does not begin with a zero"),
    ("length", "5 m\n", "write '5 m'"),
    ("length", " 5 m", ""),
    ("length", "5 metres", "did you mean 'm'?"),
    ("length", "1e999 m", "too large"),
    ("length", "1e-399 m", "too small"),
    ("length", "1e999999999999 m", "too large"),
    ("length", "1" * 5000 + " m", "too long"),
    ("speed", "3 kmh", "did you mean 'km/h'?"),
    ("speed", "3 kph", "did you mean 'km/h'?"),
    ("acceleration", "1 m/s2", "did you mean 'm/s^2'?"),
    ("density", "0.5 1/m2", "did you mean '1/m^2'?"),
    ("density", "0.51/m^2", "did you mean '1/m^2'?"),  # 0.5 1/m^2, or 0.51 of something?
    ("density", "21/m^2", "did you mean '1/m^2'?"),
    ("duration", "5 secs", "did you mean 's'?"),
    ("duration", "5 minutes", "did you mean 'min'?"),
    ("frequency", "3 hz", "did you mean 'Hz'?"),
    ("angle", "3 degrees", "did you mean 'deg'?"),
]
UNIT_OF = [(dimension, unit) for dimension, units in UNITS.items() for unit in units]


def adapter(dimension: str, *bounds: Any) -> TypeAdapter[float]:
    annotated: Any = float
    for bound in (*bounds, Quantity(dimension)):
        annotated = Annotated[annotated, bound]
    return TypeAdapter(annotated, config=ConfigDict(strict=True, allow_inf_nan=False))


@pytest.mark.parametrize(("dimension", "text", "value"), KNOWN)
def test_known_values_are_exact(dimension: str, text: str, value: float) -> None:
    assert adapter(dimension).validate_python(text) == value


@pytest.mark.parametrize(("dimension", "text", "hint"), WRONG)
def test_wrong_texts_are_refused_with_advice(dimension: str, text: str, hint: str) -> None:
    with pytest.raises(ValidationError) as caught:
        adapter(dimension).validate_python(text)
    (error,) = caught.value.errors()
    assert error["type"] == "quantity"
    assert error["ctx"]["units"].split(", ") == list(UNITS[dimension])
    assert hint in error["ctx"]["hint"]


@pytest.mark.parametrize("value", [True, False, math.nan, math.inf, None, [1.0], b"5 m", 10**400])
def test_what_is_no_number_is_refused(value: object) -> None:
    with pytest.raises(ValidationError):
        adapter("length").validate_python(value)


def test_bare_numbers_are_si() -> None:
    assert adapter("speed").validate_python(3) == 3.0
    assert adapter("angle").validate_python(-0.25) == -0.25


@given(st.decimals(-(10**6), 10**6, allow_nan=False, places=6), st.sampled_from(UNIT_OF))
def test_every_value_is_the_nearest_float(number: Decimal, of: tuple[str, str]) -> None:
    dimension, unit = of
    value = adapter(dimension).validate_python(f"{number:f} {unit}")
    exact = Fraction(number) * UNITS[dimension][unit]
    error = abs(Fraction(value) - exact)
    for side in (-math.inf, math.inf):
        assert error <= abs(Fraction(math.nextafter(value, side)) - exact)


@given(st.floats(allow_nan=False, allow_infinity=False), st.sampled_from(list(UNITS)))
def test_si_text_reads_as_the_number_itself(value: float, dimension: str) -> None:
    assume(abs(value) <= MOST.get(dimension, math.inf))
    unit = Quantity(dimension).si_unit
    assert adapter(dimension).validate_python(f"{value!r} {unit}") == value


@given(st.integers(-(10**6), 10**6), st.sampled_from([1, 2, 3, 4, 6, 9, 10, 12, 18, 36, 180]))
def test_degrees_are_fractions_of_pi(times: int, parts: int) -> None:
    value = adapter("angle").validate_python(f"{times * 180 // parts} deg")
    exact = Fraction(math.pi) * (times * 180 // parts) / 180
    assert value == float(exact)


@pytest.mark.slow
@given(st.from_regex(r"[-+]?[0-9.eE+-]{1,6} {0,2}[a-zµ°²^/0-9]{0,5}", fullmatch=True))
def test_the_pattern_takes_what_the_parser_takes(text: str) -> None:
    for dimension in UNITS:
        for bound, limits in ((None, ()), (Gt(0), (0, None)), (Ge(0), (None, 0))):
            bounds = [] if bound is None else [bound]
            try:
                adapter(dimension, *bounds).validate_python(text)
                taken = True
            except ValidationError as error:
                taken = "too large" in str(error.errors()[0].get("ctx", {}).get("hint"))
            assert bool(re.search(Quantity(dimension).pattern(*limits), text)) is taken


@pytest.mark.parametrize(("dimension", "text", "value"), KNOWN)
def test_the_pattern_takes_the_known_texts(dimension: str, text: str, value: float) -> None:
    del value
    assert re.search(Quantity(dimension).pattern(), text)


@pytest.mark.parametrize(("dimension", "text", "hint"), WRONG)
def test_the_pattern_refuses_the_wrong_texts(dimension: str, text: str, hint: str) -> None:
    if not hint.startswith("too"):
        assert not re.fullmatch(Quantity(dimension).pattern().rstrip("$"), text)


def test_the_schema_keeps_bounds() -> None:
    class Model(BaseModel):
        width: Annotated[float, Gt(0), Quantity("length")]

    number, text = Model.model_json_schema()["properties"]["width"]["anyOf"]
    assert number == {"type": "number", "exclusiveMinimum": 0}
    assert not re.search(text["pattern"], "-1 m")
    assert not re.search(text["pattern"], "0.0 m")
    assert re.search(text["pattern"], "0.01 m")


def test_no_unit_has_two_meanings_within_a_dimension() -> None:
    for units in UNITS.values():
        assert len({plain_unit(u) for u in units}) == len(units)
        assert all(plain_unit(u) == u for u in units)
