"""Numbers in the report's CSV are those that Python writes, whichever way they are written."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.report.tables import number_texts


@given(st.lists(st.floats(allow_infinity=False), max_size=20))
def test_numbers_are_written_as_by_python(numbers: list[float]) -> None:
    texts = [b"" if x != x else repr(x).encode() for x in numbers]
    assert number_texts(np.array(numbers, np.float64)) == texts


def test_numbers_at_the_ends_of_those_without_exponent() -> None:
    numbers = [sign * base * 10.0**e for e in range(-7, 19) for base in (1.0, 1.5, 9.999)
               for sign in (1.0, -1.0)] + [0.0, -0.0, 123456.789, 1 / 3]  # fmt: skip
    assert number_texts(np.array(numbers)) == [repr(x).encode() for x in numbers]
