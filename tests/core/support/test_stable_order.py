from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.support.stable_order import stable_order

FEW = st.sampled_from([-np.inf, -1.5, -0.0, 0.0, 1e-300, 2.0, np.inf, np.nan])
NUMBERS = st.lists(FEW | st.floats(), max_size=70)


@given(NUMBERS)
def test_the_order_is_that_of_numpys_stable_sort(numbers: list[float]) -> None:
    values = np.array(numbers, dtype=np.float64)
    # A column, as its callers have them: not contiguous.
    column = np.column_stack([values, values])[:, 0]
    np.testing.assert_array_equal(stable_order(column), np.argsort(values, kind="stable"))


@pytest.mark.parametrize("count", [16, 17, 32, 33, 1000])
def test_equal_numbers_keep_their_order(count: int) -> None:
    values = np.column_stack([np.arange(float(count)) % 3.0, np.zeros(count)])[:, 0]
    np.testing.assert_array_equal(stable_order(values), np.argsort(values, kind="stable"))
