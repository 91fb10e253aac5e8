"""Arrays that nobody can make writable again, whatever their layout."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from crowdbot.core.support.immutable import immutable, immutable_fields

ARRAYS: tuple[NDArray[Any], ...] = (
    np.arange(6.0), np.arange(6.0).reshape(2, 3), np.asfortranarray(np.arange(6.0).reshape(2, 3)),
    np.zeros((0, 5)), np.array([True, False]), np.arange(12.0).reshape(3, 4)[:, 1:3],
    np.array(3.0), np.arange(6)[::-2],
)  # fmt: skip


@pytest.mark.parametrize("array", ARRAYS)
def test_the_same_and_not_writable(array: NDArray[Any]) -> None:
    found = immutable(array)
    assert np.array_equal(found, array)
    assert (found.dtype, found.shape) == (array.dtype, array.shape)
    if array.flags.forc:
        assert found.strides == array.strides or array.size == 0
    with pytest.raises(ValueError, match="WRITEABLE"):
        found.setflags(write=True)
    for base in (found.base, getattr(found.base, "base", None)):
        assert not isinstance(base, np.ndarray)
    if array.flags.writeable:
        array.fill(1)
    assert not np.shares_memory(found, array)


def test_a_dataclass_of_arrays() -> None:
    @dataclass(frozen=True)
    class Some:
        a: NDArray[np.float64]
        b: float

    found = immutable_fields(Some(np.zeros(3), 2.0))
    assert found.b == 2.0
    with pytest.raises(ValueError, match="WRITEABLE"):
        found.a.setflags(write=True)
