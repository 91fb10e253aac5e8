"""Numbers that are packed keep five digits, and whole numbers all of them."""

from __future__ import annotations

import base64
import math
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.report.packing import _AT_ONCE, pack


def unpacked(text: str) -> list[float]:
    planes = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8).reshape(4, -1)
    words = np.zeros((planes.shape[1], 8), np.uint8)
    words[:, :4] = planes.T
    found: list[float] = words.reshape(-1).view(">f8").tolist()
    return found


@given(st.lists(st.floats(allow_subnormal=False), min_size=1, max_size=20))
def test_five_digits_are_kept(numbers: list[float]) -> None:
    for before, after in zip(numbers, unpacked(pack(np.array(numbers))), strict=True):
        if math.isnan(before):
            assert math.isnan(after)
        else:
            assert after == pytest.approx(before, rel=2**-16, abs=0)


@given(st.integers(-(2**17) + 1, 2**17 - 1))
def test_whole_numbers_stay(number: int) -> None:
    assert unpacked(pack(np.array([float(number)]))) == [float(number)]


def test_more_numbers_than_are_packed_at_once_keep_their_places() -> None:
    numbers = np.arange(_AT_ONCE + 7.0) % 1000.0
    assert unpacked(pack(numbers.reshape(1, -1))) == numbers.tolist()


def test_order_stays() -> None:
    numbers = np.sort(np.random.default_rng(3).normal(size=500))
    assert np.all(np.diff(unpacked(pack(numbers))) >= 0)
