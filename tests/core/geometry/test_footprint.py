"""The outline of a robot that is a disc, which has no corners."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.core.geometry.footprint import Footprint

DISC = Footprint(np.zeros((0, 2)), 0.3)


def test_gap_of_a_disc() -> None:
    found = DISC.gap(np.array([0.0, 3.0, 0.0, np.nan]), np.array([0.0, 4.0, -0.3, 0.0]))
    assert found == pytest.approx([-0.3, 4.7, 0.0, np.nan], nan_ok=True)


def test_first_touch_of_a_disc() -> None:
    x, y = np.array([2.0, 2.0, 2.0]), np.array([0.0, 0.0, 1.0])
    dx, dy = np.array([-1.0, 1.0, -1.0]), np.zeros(3)
    found = DISC.first_touch(x, y, dx, dy, np.full(3, 0.2))
    assert found == pytest.approx([1.5, np.inf, np.inf])
