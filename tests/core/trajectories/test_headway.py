"""Headway: how soon the robot would touch who stays where he is."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.trajectories.headway import headway, share_below
from tests.plugins.metrics.scenes import REACH, grid, line, scene

T = grid(2, 1 / 16)
JUMP = 10.0


@given(gap=st.floats(0.05, 5.0), speed=st.floats(0.1, 2.0), own=st.floats(-2.0, 2.0))
@settings(max_examples=30)
def test_it_is_gap_over_speed_whatever_the_person_does(
    gap: float, speed: float, own: float
) -> None:
    run = scene(T, line(T, (0, 0), (speed, 0)), [line(T, (REACH + gap, 0), (own, 0))])
    assert headway(run, JUMP)[0, 0] == pytest.approx(gap / speed, rel=1e-6)


def test_who_is_beside_the_path_is_never_reached() -> None:
    beside, behind = line(T, (1, REACH + 0.01), (0, 0)), line(T, (-1, 0), (0, 0))
    run = scene(T, line(T, (0, 0), (0.1, 0)), [beside, behind])
    assert np.all(np.isinf(headway(run, JUMP)))


def test_a_robot_that_stands_reaches_nobody_and_one_in_contact_has_none() -> None:
    stands = scene(T, line(T, (0, 0), (0, 0)), [line(T, (REACH + 0.1, 0), (-0.01, 0))])
    assert np.all(np.isinf(headway(stands, JUMP)))
    touches = scene(T, line(T, (0, 0), (0.5, 0)), [line(T, (REACH - 0.01, 0), (0.5, 0))])
    assert np.all(headway(touches, JUMP) == 0.0)


def test_shares_of_steps() -> None:
    """At 1 m/s towards somebody 1 m off, who stands: below 0.5 s after half a second."""
    run = scene(T, line(T, (0, 0), (1, 0)), [line(T, (REACH + 1.0, 0), (0, 0))])
    share = share_below(run, 0.5 + 1e-9, JUMP)[:, 0]
    assert share[:7].tolist() == [0.0] * 7
    assert share[7] == 0.5
    assert share[8:16].tolist() == [1.0] * 8
    assert math.isclose(float(np.diff(run.t)[:16] @ share[:16]), 0.5 + 1 / 32)
