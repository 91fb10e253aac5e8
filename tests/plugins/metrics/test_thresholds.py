"""On which side of its threshold each comparison falls."""

from __future__ import annotations

import numpy as np
import pytest

from tests.plugins.metrics.scenes import (
    Body,
    driven,
    grid,
    line,
    present_during,
    scene,
    scores_of,
    value_of,
)

T = grid(10)
STAND = line(T, (0, 0), (0, 0))


@pytest.mark.parametrize(("speed", "count"), [(0.09, 0), (0.11, 1)])
def test_who_hardly_walks_is_passed_not_overtaken(speed: float, count: int) -> None:
    run = scene(T, line(T, (0, 0), (1.5, 0)), [line(T, (5, 1), (speed, 0))])
    found = scores_of("overtaking_count", run)
    assert [value_of(found, v) for v in ("literal", "corrected")] == [count, count]


@pytest.mark.parametrize(("speed", "count"), [(0.09, 0), (0.11, 1)])
def test_a_robot_that_hardly_drives_overtakes_nobody(speed: float, count: int) -> None:
    slow = line(T, (0.2, 1), (0.0, 0.0))
    slow = Body(slow.x, slow.y, np.full(len(T), 0.2), slow.vy)  # walks on a belt
    run = scene(T, line(T, (0, 0), (speed, 0)), [slow])
    assert value_of(scores_of("overtaking_count", run)) == count


@pytest.mark.parametrize(("angle", "count"), [(0.25, 1), (0.35, 0)])
def test_the_angle_of_an_overtaking_is_a_parameter(angle: float, count: int) -> None:
    velocity = (0.5 * np.cos(angle), 0.5 * np.sin(angle))
    run = scene(T, line(T, (0, 0), (1.5, 0)), [line(T, (3, 0.5), velocity)])
    assert value_of(scores_of("overtaking_count", run, overtake_angle=0.3)) == count


@pytest.mark.parametrize(("speed", "time"), [(0.04, 10.0), (0.06, 0.0)])
def test_stalled_is_slower_than_the_threshold(speed: float, time: float) -> None:
    found = scores_of("stalled_time", driven(T, v=speed))
    assert value_of(found) == pytest.approx(time)


@pytest.mark.parametrize("first_gap", [0.0, 1e-10, 1e-6])
def test_a_touch_at_first_appearance_is_a_contact(first_gap: float) -> None:
    leaving = line(T, (0.43 + first_gap, 0), (1, 0))
    found = scores_of("collision_count", scene(T, STAND, [leaving]))
    expected = float(first_gap < 1e-9)
    assert [value_of(found, v) for v in ("literal", "corrected")] == [expected, expected]


@pytest.mark.parametrize(
    ("gap", "shares"),
    [
        (0.44, (1, 0, 0, 0)),
        (0.45, (0, 1, 0, 0)),
        (0.5, (0, 1, 0, 0)),
        (0.51, (0, 1, 0, 1)),
        (1.2, (0, 0, 1, 1)),
        (3.6, (0, 0, 0, 1)),
    ],
)
def test_the_zones_begin_at_their_inner_edge(gap: float, shares: tuple[float, ...]) -> None:
    run = scene(T, STAND, [line(T, (0.43 + gap, 0), (0, 0))])
    names = (
        "intimate_time_fraction",
        "personal_time_fraction",
        "social_time_fraction",
        "space_compliance",
    )
    assert tuple(value_of(scores_of(n, run)) for n in names) == pytest.approx(shares)


@pytest.mark.parametrize(("gap", "count"), [(0.0, 1), (1e-10, 1), (1e-6, 0)])
def test_a_touch_that_is_seen_once_is_a_contact(gap: float, count: int) -> None:
    """Only one sample knows of it: there is no step to look at."""
    once = present_during(line(T, (0.43 + gap, 0), (0, 0)), np.arange(len(T)) == 7)
    found = scores_of("collision_count", scene(T, STAND, [once]))
    assert [value_of(found, v) for v in ("literal", "corrected")] == [count, count]
