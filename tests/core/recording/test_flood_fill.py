"""Connected cells, held against scipy's labels."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.ndimage import label

from crowdbot.core.recording.flood_fill import connected

Shapes = st.tuples(st.integers(1, 9), st.integers(1, 9))


@given(arrays(np.bool_, Shapes), st.data())
def test_the_cells_of_one_label_are_connected(free: np.ndarray, data: st.DataObject) -> None:
    row = data.draw(st.integers(0, free.shape[0] - 1))
    column = data.draw(st.integers(0, free.shape[1] - 1))
    regions, _ = label(free)
    same = (regions == regions[row, column]) & free[row, column]
    assert np.array_equal(connected(free, row, column), same)


def test_a_spiral_is_followed_to_its_end() -> None:
    free = np.zeros((201, 201), np.bool_)
    for k in range(0, 100, 2):
        free[k, k : 201 - k] = free[200 - k, k : 201 - k] = True
        free[k : 201 - k, k] = free[k : 201 - k, 200 - k] = True
        free[k + 1, k] = False
        free[k + 1 : k + 3, k + 1] = (False, True)
        free[k + 2, k : k + 3] = True
    regions, _ = label(free)
    assert np.array_equal(connected(free, 0, 0), regions == regions[0, 0])
