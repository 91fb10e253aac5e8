"""relative_time_to_goal and relative_path_length: hand cases and failures."""

import dataclasses
from typing import Any

import numpy as np
import pytest

from crowdbot.core.trajectories.preprocess import forward_speed, yaw_rate
from crowdbot.core.trajectories.trajectories import Trajectories
from tests.plugins.metrics.scenes import (
    driven,
    grid,
    line,
    polyline,
    scene,
    scores_of,
    value_of,
    why,
)

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
def test_without_arrival_only_bounds_are_known(metric: str) -> None:  # e07
    found = scores_of(metric, straight(20, 20, arrives=False), straight(20, 20))
    assert (found["literal"].status, found["literal"].reason) == ("undefined", "goal_not_reached")
    assert found["literal"].upper is None
    bound = found["corrected"]
    assert (bound.status, bound.reason, bound.value) == ("censored", "goal_not_reached", None)
    assert bound.upper == pytest.approx(1)
    assert bound.lower == 0.0  # a time, a length: whoever never arrives takes any


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
    own = [found["literal"], found["corrected"]]
    assert {(s.status, s.reason, s.upper) for s in own} == {("undefined", reason, None)}
    assert set(found) - {"common"} == {"literal", "corrected"}


def test_zero_denominators() -> None:
    still = straight(0, 5)
    found = scores_of("relative_path_length", still, straight(5, 5))
    assert {(s.status, s.reason) for s in found.values()} == {("undefined", "zero_denominator")}
    assert value_of(scores_of("relative_path_length", straight(5, 5), still)) == 0
    at_once = scene(grid(5), line(grid(5), (0, 0), (1, 0)), goal_time=0.0)
    found = scores_of("relative_time_to_goal", at_once, straight(5, 5))
    own = [found["literal"], found["corrected"]]
    assert {(s.status, s.reason) for s in own} == {("undefined", "zero_denominator")}


def test_a_common_reference() -> None:
    """A robot that is slow alone, too, loses nothing against itself, and half against all."""
    goal: dict[str, Any] = {"robot_goal": (10.0, 0.0), "robot_speed_limit": 2.0}
    slow = driven(grid(10), v=1.0, goal_time=10.0, **goal)
    found = scores_of("relative_time_to_goal", slow, slow)
    assert value_of(found) == 1
    assert value_of(found, "common") == pytest.approx(0.5)
    assert value_of(scores_of("relative_time_to_goal", slow), "common") == pytest.approx(0.5)
    lost = driven(grid(10), v=0.5, **goal)
    late = scores_of("relative_time_to_goal", lost)["common"]
    assert late.status == "censored"
    assert (late.lower, late.upper) == (0.0, 0.5)
    unknown = driven(grid(10), v=0.5, robot_goal=(10.0, 0.0))
    found = scores_of("relative_time_to_goal", unknown)
    assert found["common"].reason == "invalid_no_speed_limit"
    assert scores_of("relative_time_to_goal", driven(grid(10)))["common"].reason == (
        "invalid_no_goal"
    )


def test_a_reference_that_does_not_turn_says_nothing_of_turning() -> None:
    """Rounding of a straight drive, 1e-15, over a crowded drive was a score."""
    t = grid(10)
    straight_on = driven(t, v=1.0, w=1e-16 * np.sin(t), goal_time=10.0)
    turning = driven(t, v=1.0, w=0.2 * np.sin(t), goal_time=10.0)
    found = scores_of("relative_jerk", turning, straight_on)["angular"]
    assert (found.status, found.reason) == ("undefined", "reference_does_not_turn")
    assert value_of(scores_of("relative_jerk", turning, turning), "angular") == pytest.approx(1)


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


# ------------------------------------------------------------------------- jerk
ALL = {"literal", "corrected", "linear", "angular", "norm", "legacy"}


def test_jerk_of_a_quadratic_speed() -> None:  # i01
    t = grid(10)
    found = scores_of(
        "relative_jerk",
        driven(t, v=0.5 * 0.02 * t**2, goal_time=10.0),
        driven(t, v=0.5 * 0.01 * t**2, goal_time=10.0),
    )
    assert set(found) == ALL
    for variant in ("literal", "corrected", "linear", "norm"):
        assert value_of(found, variant) == pytest.approx(0.5)
    assert value_of(found, "legacy") == pytest.approx(0.5)
    assert found["angular"].status == "undefined"
    assert found["angular"].reason == "reference_does_not_turn"
    assert found["corrected"].extras["crowded"] == pytest.approx(0.02 * (10 - 0.1))


def stairs(*levels: float) -> Trajectories:
    t = grid(9)
    w = np.array(levels)[np.minimum((t / 9 * len(levels)).astype(int), len(levels) - 1)]
    return driven(t, v=1.0, w=w, goal_time=9.0)


def test_jerk_of_turning() -> None:  # i02, i03
    found = scores_of("relative_jerk", stairs(0, 0.2, 0.1), stairs(0, 0.2))
    assert value_of(found, "literal") == pytest.approx(2)
    assert value_of(found) == pytest.approx(2 / 3)
    assert value_of(found, "angular") == pytest.approx(2 / 3)
    assert found["linear"].reason == "zero_denominator"
    back = scores_of("relative_jerk", stairs(0, 0.2, 0), stairs(0, 0.2))
    assert back["literal"].reason == "zero_denominator"
    assert value_of(back) == pytest.approx(0.5)
    other_sign = scores_of("relative_jerk", stairs(0, -0.2), stairs(0, 0.2))
    assert value_of(other_sign, "literal") == pytest.approx(-1)
    assert value_of(other_sign) == pytest.approx(1)


def test_jerk_of_waves() -> None:  # d01, d02
    t = grid(20, 1 / 16)

    def speeding(period: float) -> Trajectories:
        return driven(t, v=0.5 * (1 - np.cos(2 * np.pi * t / period)), goal_time=20.0)

    def weaving(period: float) -> Trajectories:
        w = 0.3 * 2 * np.pi / period * np.cos(2 * np.pi * t / period)
        return driven(t, v=1.0, w=w, goal_time=20.0)

    found = scores_of("relative_jerk", speeding(5), speeding(20))
    assert value_of(found) == pytest.approx(1 / 16, rel=2e-2)
    assert found["linear"].extras["alone"] == pytest.approx(4 * np.pi * 0.5 * 2 / 20, rel=2e-2)
    found = scores_of("relative_jerk", weaving(5), weaving(20))
    assert value_of(found) == pytest.approx(1 / 16, rel=1e-3)
    assert found["angular"].extras["alone"] == pytest.approx(4 * 0.3 * 2 * np.pi / 20, rel=1e-3)


def test_jerk_by_hand_at_uneven_steps() -> None:
    t = np.array([0.0, 1.0, 3.0, 4.0])
    v, w = np.array([0.0, 1.0, 1.0, 3.0]), np.array([0.0, 0.5, -0.5, 0.5])
    run = driven(t, v=v, w=w, goal_time=4.0)
    found = scores_of("relative_jerk", run, run, jerk_weight=2.0)
    # a = 1, 0, 2; alpha = 0.5, -0.5, 1
    numbers = {name: s.extras["crowded"] for name, s in found.items()}
    assert numbers["linear"] == pytest.approx(3)
    assert numbers["angular"] == pytest.approx(2.5)
    assert numbers["corrected"] == pytest.approx(3 + 2 * 2.5)
    assert numbers["norm"] == pytest.approx(np.hypot(1, 1) + np.hypot(2, 1.5))
    assert numbers["literal"] == pytest.approx((2 - 1) + (0.5 - 0))


def test_legacy_jerk_counts_turning_the_short_way() -> None:
    t = grid(2, 0.5)
    theta = np.array([3.0, 3.1, -3.0, -2.9, -2.9])  # one step of 0.18 across the seam
    run = driven(t, v=0.0, goal_time=2.0, robot_theta=theta)
    turn = np.array([0.1, 2 * np.pi - 6.1, 0.1, 0.0])
    found = scores_of("relative_jerk", run, run)["legacy"]
    assert found.extras["crowded"] == pytest.approx(np.abs(np.diff(turn)).sum())


def test_jerk_that_cannot_be_compared() -> None:
    slow = driven(grid(5), v=grid(5) ** 2)
    arrives = [driven(t, v=t**2, goal_time=5.0) for t in (grid(5), grid(5, 0.05))]
    found = scores_of("relative_jerk", *arrives)
    assert found["literal"].status == "ok"
    assert {s.reason for v, s in found.items() if v != "literal"} == {"sampling_mismatch"}
    near = grid(5, 0.1) * 1.0099
    close = driven(near, v=near**2, goal_time=float(near[-1]))
    assert scores_of("relative_jerk", close, arrives[0])["corrected"].status == "ok"
    found = scores_of("relative_jerk", slow, arrives[0])
    assert found["literal"].reason == "goal_not_reached"
    assert {(s.status, s.upper) for v, s in found.items() if v in ("linear", "corrected")} == {
        ("censored", 1.0)
    }
    two = driven([0.0, 1.0], v=[0.0, 1.0], goal_time=1.0)
    assert why(scores_of("relative_jerk", two, two)) == {("undefined", "too_few_samples")}
    smooth = driven(grid(5), v=1.0, goal_time=5.0)
    found = scores_of("relative_jerk", smooth, arrives[0])
    assert why({"corrected": found["corrected"]}) == {("undefined", "zero_denominator")}
    assert value_of(scores_of("relative_jerk", arrives[0], smooth)) == 0
    assert found["literal"].reason == "zero_denominator"


def test_missing_speeds_of_the_robot_are_derived() -> None:
    t = grid(4)
    run = driven(t, v=t**2 / 4, w=0.2, goal_time=4.0)
    assert run.robot is not None
    unknown = np.full(len(t), np.nan)
    blind = dataclasses.replace(run, robot=dataclasses.replace(run.robot, v=unknown, w=unknown))
    assert blind.robot is not None
    speed, rate = forward_speed(t, blind.robot, 10.0), yaw_rate(t, blind.robot, 10.0)
    assert speed[1:-1] == pytest.approx((t**2 / 4)[1:-1], abs=2e-3)
    assert rate == pytest.approx(0.2)
    found = scores_of("relative_jerk", blind, blind)
    assert found["linear"].extras["crowded"] > 1
