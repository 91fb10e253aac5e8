"""Noise generators that return something else than errors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from crowdbot.core.sensing.range_model import RangeModel
from crowdbot.plugins.sensors.lidar2d import Lidar2dSpec


@dataclass
class _Noise:
    answer: Any
    random: bool = False

    def errors(self, distance: Any, rng: np.random.Generator) -> Any:
        del distance, rng
        return self.answer


def measured(answer: object) -> Any:
    model = RangeModel(Lidar2dSpec(), [_Noise(answer)])
    return model.measure(np.array([1.0, 2.0, np.inf]), np.random.default_rng(0))


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        (np.zeros(1), r"test_wrong_noise\._Noise: errors returned shape \(1,\) for \(3,\)"),
        (0.5, r"shape \(\)"),
        (None, r"test_wrong_noise\._Noise: errors returned a NoneType where an array"),
        (np.zeros(3) * 1j, r"_Noise: errors returned an array of complex128"),
        ([0.0, np.inf, 0.0], "not finite for what was hit"),
        ([np.nan, 0.0, 0.0], "not finite for what was hit"),
        ([1e300, 0.0, 0.0], r"1e\+300 m for what was hit; write at most 1\.\d+e\+08"),
        ([0.0, -1e9, 0.0], r"_Noise: errors returned -1e\+09 m"),
    ],
)
def test_errors_that_are_none_are_named(answer: object, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        measured(answer)


def test_of_what_was_not_hit_they_may_be_anything() -> None:
    assert measured([0.5, -0.5, np.inf]).tolist() == [1.5, 1.5, np.inf]
    assert measured([0.5, -0.5, -1e300]).tolist() == [1.5, 1.5, np.inf]


def test_an_error_that_leaves_something_of_the_distance_is_one() -> None:
    spec = Lidar2dSpec()
    assert measured([1e6, -1e6, 0.0]).tolist() == [spec.range_max, spec.range_min, np.inf]
