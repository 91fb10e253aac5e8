"""Numbers of messages as JSON: the same numbers, in few digits."""

from __future__ import annotations

import json

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from crowdbot.core.live.plain import json_array


@given(arrays(np.float32, st.integers(0, 40), elements=st.floats(width=32)))
def test_single_precision_comes_back_bit_by_bit(array: np.ndarray) -> None:
    text = json.dumps(json_array(array), allow_nan=False)
    back = np.array([np.nan if x is None else x for x in json.loads(text)], np.float32)
    finite = np.isfinite(array)
    assert back[finite].tobytes() == array[finite].tobytes()
    assert np.isnan(back[~finite]).all()


def test_ranges_have_nine_digits() -> None:
    array = np.random.default_rng(0).uniform(0.05, 25.0, 720).astype(np.float32)
    assert max(len(json.dumps(x)) for x in json_array(array)) <= 12


@given(
    arrays(
        np.float64, st.integers(0, 10), elements=st.floats(allow_nan=False, allow_infinity=False)
    )
)
def test_double_precision_stays_as_it_is(array: np.ndarray) -> None:
    assert np.array(json_array(array), np.float64).tobytes() == array.tobytes()
