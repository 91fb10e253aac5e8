from __future__ import annotations

from fractions import Fraction
from math import ceil

import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.support.ticks import TICK, TICKS_PER_SECOND, is_due, ticks


def test_a_tick_is_exact() -> None:
    assert TICK * TICKS_PER_SECOND == 1.0
    assert Fraction(TICK) == Fraction(1, 128)


@pytest.mark.parametrize("rate", [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0])
def test_dyadic_rates_have_no_jitter(rate: float) -> None:
    per_sample = ticks(rate)
    assert per_sample * rate == TICKS_PER_SECOND
    due = [k for k in range(1025) if is_due(k, rate)]
    assert due == list(range(0, 1025, per_sample))


@given(st.integers(1, 1280).map(lambda n: n / 10.0))
def test_samples_fall_on_the_first_tick_at_or_after_their_time(rate: float) -> None:
    """In exact arithmetic with the rate that the float stands for."""
    exact = Fraction(rate).limit_denominator(10)
    expected = {ceil(n * TICKS_PER_SECOND / exact) for n in range(int(20 * rate) + 2)}
    assert {k for k in range(20 * 128) if is_due(k, rate)} == {k for k in expected if k < 20 * 128}


def test_ten_hertz() -> None:
    assert [k for k in range(140) if is_due(k, 10.0)] == [
        0, 13, 26, 39, 52, 64, 77, 90, 103, 116, 128
    ]  # fmt: skip


def test_a_slow_rate_begins_at_once_and_keeps_its_count_for_an_hour() -> None:
    assert is_due(0, 0.3)
    hour = 3600 * TICKS_PER_SECOND
    assert sum(is_due(k, 0.3) for k in range(hour)) == 1080
    assert not is_due(-1, 16.0)
