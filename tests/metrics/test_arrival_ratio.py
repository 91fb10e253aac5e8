"""relative_time_to_goal and relative_path_length: hand cases and failures."""

from typing import Any

import numpy as np
import pytest

from crowdbot.core.trajectory import Trajectories

from .scenes import grid, line, polyline, scene, scores_of, value_of

BOTH = ["relative_time_to_goal", "relative_path_length"]


def straight(length: float, seconds: float, *, arrives: bool = True) -> Trajectories:
    t = grid(seconds)
    body = line(t, (0, 0), (length / seconds, 0))
    return scene(t, body, goal_time=seconds if arrives else None)


A03 = scene(grid(25), polyline(grid(25), [(0, 0, 0), (12.5, 0, 15), (25, 15, 15)]), goal_time=25.0)
I04 = scene(grid(7), polyline(grid(7), [(0, 0, 0), (3, 3, 0), (7, 3, 4)]), goal_time=7.0)


@pytest.mark.parametrize("variant", ["literal", "corrected"])
@pytest.mark.parametrize(
    ("crowded", "alone", "time", "length"),
    [
        pytest.param(straight(20, 20), straight(20, 20), 1, 1, id="a01"),
        pytest.param(A03, straight(20, 20), 0.8, 2 / 3, id="a03"),
        pytest.param(I04, straight(5, 5), 5 / 7, 5 / 7, id="i04"),
        pytest.param(straight(10, 5), straight(10, 10), 2, 1, id="faster in the crowd"),
    ],
)
def test_hand_cases(
    crowded: Trajectories, alone: Trajectories, time: float, length: float, variant: str
) -> None:
    found = scores_of("relative_time_to_goal", crowded, alone)
    assert value_of(found, variant) == pytest.approx(time, rel=1e-12)
    found = scores_of("relative_path_length", crowded, alone)
    assert value_of(found, variant) == pytest.approx(length, rel=1e-12)


def test_arrival_between_samples_is_not_rounded_to_the_grid() -> None:  # e10
    t = grid(12)
    crowded = scene(t, line(t, (0, 0), (1, 0)), goal_time=9.97)
    time = scores_of("relative_time_to_goal", crowded, straight(10, 10))
    length = scores_of("relative_path_length", crowded, straight(10, 10))
    assert value_of(time) == pytest.approx(10 / 9.97, rel=1e-12)
    assert value_of(length) == pytest.approx(10 / 9.9, rel=1e-12)


def test_arrival_after_the_last_sample_counts_in_full() -> None:
    t = grid(9.9)
    crowded = scene(t, line(t, (0, 0), (1, 0)), goal_time=9.97)
    found = scores_of("relative_time_to_goal", crowded, straight(10, 10))
    assert value_of(found) == pytest.approx(10 / 9.97, rel=1e-12)


def test_nothing_after_the_arrival_counts() -> None:  # e09
    t = grid(20)
    crowded = scene(t, line(t, (0, 0), (1, 0)), goal_time=10.0)
    for metric in BOTH:
        assert value_of(scores_of(metric, crowded, straight(10, 10))) == pytest.approx(1)
        assert value_of(scores_of(metric, straight(10, 10), crowded)) == pytest.approx(1)


@pytest.mark.parametrize("metric", BOTH)
def test_without_arrival_only_an_upper_bound_is_known(metric: str) -> None:  # e07
    found = scores_of(metric, straight(20, 20, arrives=False), straight(20, 20))
    assert (found["literal"].status, found["literal"].reason) == ("undefined", "goal_not_reached")
    assert found["literal"].upper is None
    bound = found["corrected"]
    assert (bound.status, bound.reason, bound.value) == ("censored", "goal_not_reached", None)
    assert bound.upper == pytest.approx(1)
    assert bound.lower is None


def test_the_bound_is_alone_over_observed() -> None:
    crowded = straight(10, 40, arrives=False)
    time = scores_of("relative_time_to_goal", crowded, straight(20, 20))["corrected"]
    length = scores_of("relative_path_length", crowded, straight(20, 20))["corrected"]
    assert [time.upper, length.upper] == pytest.approx([0.5, 2])


def test_no_bound_for_a_robot_that_never_moved() -> None:
    found = scores_of("relative_path_length", straight(0, 20, arrives=False), straight(20, 20))
    assert (found["corrected"].status, found["corrected"].upper) == ("censored", None)


@pytest.mark.parametrize("metric", BOTH)
@pytest.mark.parametrize(
    ("crowded", "alone", "reason"),
    [
        (straight(5, 5), None, "no_reference"),
        (straight(5, 5, arrives=False), None, "no_reference"),
        (straight(5, 5), scene(grid(5)), "no_reference"),
        (straight(5, 5), straight(5, 5, arrives=False), "reference_goal_not_reached"),
        (
            straight(5, 5, arrives=False),
            straight(5, 5, arrives=False),
            "reference_goal_not_reached",
        ),
        (scene(grid(5)), straight(5, 5), "invalid_no_robot"),
    ],
)
def test_reasons(
    metric: str, crowded: Trajectories, alone: Trajectories | None, reason: str
) -> None:
    found = scores_of(metric, crowded, alone)
    assert {(s.status, s.reason, s.upper) for s in found.values()} == {("undefined", reason, None)}
    assert set(found) == {"literal", "corrected"}


def test_zero_denominators() -> None:
    still = straight(0, 5)
    found = scores_of("relative_path_length", still, straight(5, 5))
    assert {(s.status, s.reason) for s in found.values()} == {("undefined", "zero_denominator")}
    assert value_of(scores_of("relative_path_length", straight(5, 5), still)) == 0
    at_once = scene(grid(5), line(grid(5), (0, 0), (1, 0)), goal_time=0.0)
    found = scores_of("relative_time_to_goal", at_once, straight(5, 5))
    assert {(s.status, s.reason) for s in found.values()} == {("undefined", "zero_denominator")}


def test_one_sample() -> None:
    one = scene([0.0], line(np.zeros(1), (0, 0), (1, 0)))
    for metric in BOTH:
        bound = scores_of(metric, one, straight(5, 5))["corrected"]
        assert (bound.status, bound.upper) == ("censored", None)


def test_time_does_not_start_at_zero() -> None:
    t = grid(10) + 100
    crowded = scene(t, line(t, (-100, 0), (1, 0)), goal_time=110.0)
    found = scores_of("relative_time_to_goal", crowded, straight(5, 5))
    assert value_of(found) == pytest.approx(0.5)


def test_turning_on_the_spot_and_teleports_add_no_length() -> None:
    t = grid(10)
    body = line(t, (0, 0), (1, 0))
    x = body.x.copy()
    x[60:] += 30.0  # 300 m/s
    spin: dict[str, Any] = {"robot_x": x, "robot_theta": t * 3, "robot_w": np.full(len(t), 3.0)}
    given: dict[str, Any] = {
        "robot_y": body.y,
        "robot_v": body.vx,
        "robot_radius": 0.2,
        "robot_mass": 6.0,
    }
    crowded = Trajectories.from_arrays(t=t, **spin, **given, robot_goal_time=10.0)
    found = scores_of("relative_path_length", crowded, straight(9.9, 10))
    assert value_of(found) == pytest.approx(1)
    fast = scores_of("relative_path_length", crowded, straight(40, 10), jump_speed="400 m/s")
    assert value_of(fast) == pytest.approx(40 / (10 + 30))


def test_reversing_counts_as_path() -> None:
    t = grid(10)
    crowded = scene(t, polyline(t, [(0, 0, 0), (5, 5, 0), (10, 0, 0)]), goal_time=10.0)
    assert value_of(scores_of("relative_path_length", crowded, straight(5, 5))) == pytest.approx(
        0.5
    )


def test_unknown_poses_add_no_length() -> None:
    t = grid(10)
    body = line(t, (0, 0), (1, 0))
    body.x[50] = np.nan
    found = scores_of("relative_path_length", scene(t, body, goal_time=10.0), straight(9.8, 10))
    assert value_of(found) == pytest.approx(1)


def test_collinear_samples_change_nothing() -> None:
    fine = grid(7, 0.05)
    path = [(0.0, 0.0, 0.0), (3.0, 3.0, 0.0), (7.0, 3.0, 4.0)]
    again = scene(fine, polyline(fine, path), goal_time=7.0)
    a = value_of(scores_of("relative_path_length", I04, straight(5, 5)))
    b = value_of(scores_of("relative_path_length", again, straight(5, 5)))
    assert a == pytest.approx(b, rel=1e-12)
