"""Names in narrow columns break between their words and lose nothing."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.support.text import wrap_name


@pytest.mark.parametrize(
    ("name", "lines"),
    [
        ("final_distance_to_goal", ["final_", "distance_to_", "goal"]),
        ("safe_efficiency", ["safe_", "efficiency"]),
        ("oracle+privileged", ["oracle+", "privileged"]),
        ("contacts_per_km at_fault, 1/km", ["contacts_per_", "km at_fault,", "1/km"]),
        ("spl", ["spl"]),
        ("unreasonablylongword_x", ["unreasonablylongword_", "x"]),
    ],
)
def test_broken_after_marks(name: str, lines: list[str]) -> None:
    assert wrap_name(name, 13).splitlines() == lines


@given(st.text(alphabet="ab_+-/ ", max_size=40), st.integers(1, 20))
def test_nothing_is_lost(name: str, width: int) -> None:
    assert "".join(wrap_name(name, width).split()) == "".join(name.split())
