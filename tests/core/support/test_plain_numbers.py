"""Answers of plugins as arrays, however they look."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.core.support.plain_numbers import plain_numbers


class _Endless(list[float]):
    def __iter__(self) -> Any:
        while True:
            yield 0.0


class _Sly(int):
    def __float__(self) -> float:
        raise SystemExit


class _Lazy:
    """As arrays of other libraries."""

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        del dtype, copy
        return np.arange(3, dtype=np.float32)


@pytest.mark.parametrize(
    "value",
    [
        _Endless([1.0]), [_Endless([1.0])], _Sly(3), [_Sly(3)], "1", b"1", {1.0: 2.0}, 1j, None,
        np.array([1j]), np.array(["1"]), np.array([None]), iter([1.0]), [[[[1.0]]]],
        np.array([np.timedelta64(1)]),
    ],
)  # fmt: skip
def test_what_is_no_array_of_real_numbers(value: object) -> None:
    with pytest.raises((TypeError, ValueError)):
        plain_numbers(value)


@pytest.mark.parametrize(
    "value", [3, 2.5, True, [1, 2.0], ((1.0, 2.0), [3, 4]), np.arange(4), np.float32(1), [],
              np.zeros((2, 0)), _Lazy(), [np.float64(1.0), np.arange(1)[0]]],
)  # fmt: skip
def test_what_is_one(value: object) -> None:
    found = plain_numbers(value)
    assert type(found) is np.ndarray
    assert found.dtype == np.float64
    assert np.array_equal(found, np.asarray(value, np.float64))


def test_an_array_stays_the_one_it_is() -> None:
    array = np.arange(3.0)
    assert plain_numbers(array) is array
