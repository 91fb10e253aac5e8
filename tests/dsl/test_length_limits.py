"""No world is larger than a thousand kilometres; geometry squares lengths."""

from __future__ import annotations

import pytest
from pydantic import TypeAdapter, ValidationError

from crowdbot.dsl.spec.quantities import MOST, Length, PositiveDuration, PositiveLength


@pytest.mark.parametrize("value", [1e308, "1e308 m", "1001 km", 1_000_001, "1e300 km"])
def test_lengths_have_a_limit(value: object) -> None:
    with pytest.raises(ValidationError):
        TypeAdapter(PositiveLength).validate_python(value)
    if isinstance(value, float | int):
        with pytest.raises(ValidationError, match="greater than or equal to -1000000"):
            TypeAdapter(Length).validate_python(-value)


def test_what_is_smaller_stays() -> None:
    assert TypeAdapter(Length).validate_python("-1000 km") == -MOST["length"]
    assert TypeAdapter(PositiveLength).validate_python(0.1) == 0.1
    assert TypeAdapter(PositiveDuration).validate_python(1e300) == 1e300
