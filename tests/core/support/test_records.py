"""Records on plain memory."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.core.support.records import record_type, rows_in


class Point:
    x: float
    y: float


POINT = record_type(Point)


def test_rows_share_the_memory_of_the_numbers() -> None:
    numbers = np.arange(6.0)
    rows = rows_in(numbers, POINT)
    rows["y"][1] = 7.0
    assert rows.shape == (3,)
    assert numbers.tolist() == [0.0, 1.0, 2.0, 7.0, 4.0, 5.0]
    assert rows_in(numbers.reshape(3, 2), POINT).shape == (3,)
    assert rows_in(numbers[:0], POINT).shape == (0,)


@pytest.mark.parametrize("numbers", [np.zeros(5), np.zeros(8)[::2], np.zeros((3, 4))[:, :2]])
def test_half_records_and_gaps_are_refused(numbers: np.ndarray) -> None:
    with pytest.raises(ValueError, match=r"multiple|contiguous"):
        rows_in(numbers, POINT)
