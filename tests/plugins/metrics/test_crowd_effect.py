"""effect_on_time, neighbours_time_to_goal, neighbours_velocity: hand cases and failures."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.trajectories.trips import Durations
from crowdbot.errors import InputError
from tests.plugins.metrics.scenes import (
    Body,
    grid,
    line,
    present_during,
    scene,
    scores_of,
    trips,
    value_of,
    values,
    why,
)

Row = tuple[int, float, float, bool]


def journeys(
    end: float, *rows: Row, robot: bool = True, goal_time: float | None = None
) -> Trajectories:
    """People far from the robot; only their trips matter."""
    t = grid(end)
    crowd = [line(t, (100.0 + i, 50.0), (0, 0)) for i in range(1 + max(r[0] for r in rows))]
    body = line(t, (0, 0), (1, 0)) if robot else None
    return scene(t, body, crowd, goal_time=goal_time, **trips(*rows))


def lasting(end: float, *seconds: float, **more: Any) -> Trajectories:
    """Completed trips; a negative duration is an unfinished one."""
    return journeys(end, *((i, 0.0, abs(s), s > 0) for i, s in enumerate(seconds)), **more)


def effect(run: Trajectories, alone: Trajectories | None) -> dict[str, Any]:
    return scores_of("effect_on_time", run, None, alone)


def test_all_complete() -> None:  # e04
    alone = lasting(60, *range(5, 50, 5))
    run = lasting(60, *(1.25 * s for s in range(5, 50, 5)))
    found = effect(run, alone)
    assert values(found) == {
        "literal": pytest.approx(0.8),
        "corrected": pytest.approx(0.8),
        "restricted": pytest.approx(225 / 265),
        "pace": None,
    }
    assert found["pace"].reason == "no_movement"
    assert found["restricted"].extras["tau"] == 45


def test_one_unfinished() -> None:  # e06
    found = effect(lasting(20, 6, -8, 10, 14), lasting(20, 6, 8, 10, 14))
    assert value_of(found, "literal") == pytest.approx(9.5 / 10)
    assert value_of(found) == pytest.approx(9.5 / 10.5)
    assert value_of(found, "restricted") == pytest.approx(9.5 / 10.5)


def test_completions_come_before_censorings_at_ties() -> None:
    both = Durations(np.array([6.0, 8.0, 8.0, 10.0]), np.array([True, True, False, True]))
    assert both.restricted_mean(10) == pytest.approx(6 + 0.75 * 2 + 0.5 * 2)
    assert Durations(np.array([4.0]), np.array([True])).restricted_mean(3) == 3


def test_itself() -> None:  # a02
    run = lasting(30, 12, 15, 18)
    found = values(effect(run, dataclasses.replace(run, robot=None)))
    assert set(found.values()) == {1.0, None}


def walking(*speeds: float, robot: bool = True) -> Trajectories:
    """People who walk along x for 20 s, each at a steady speed, and complete no trip."""
    t = grid(20)
    crowd = [line(t, (0.0, float(i)), (v, 0)) for i, v in enumerate(speeds)]
    rows = [(i, 0.0, 20.0, False) for i in range(len(speeds))]
    return scene(t, line(t, (0, 0), (1, 0)) if robot else None, crowd, **trips(*rows))


def test_pace_needs_no_completed_trip() -> None:
    found = effect(walking(1.0, 0.5, 1.2), walking(1.0, 1.0, 1.2, robot=False))
    assert found["literal"].reason == "no_completed_trips"
    assert (found["corrected"].status, found["corrected"].value) == ("censored", None)
    assert value_of(found, "pace") == pytest.approx(2.7 / 3.2)
    assert found["pace"].extras["denominator"] == pytest.approx(3.0 / 2.7)
    run = walking(1.0, 0.5, 1.2)
    assert value_of(effect(run, dataclasses.replace(run, robot=None)), "pace") == 1.0


def test_pace_counts_a_detour_as_a_delay() -> None:
    t = grid(20)
    rows = trips((0, 0.0, 20.0, False))
    there_and_back = line(t, (0.0, 5.0), (1, 0))
    back = np.where(t > 15, 30.0 - t, t)
    detour = dataclasses.replace(there_and_back, x=back)
    run = scene(t, line(t, (0, 0), (1, 0)), [detour], **rows)
    alone = scene(t, None, [there_and_back], **rows)
    assert value_of(effect(run, alone), "pace") == pytest.approx(10 / 20)


def test_pace_of_neighbours() -> None:
    t = grid(20)
    crowd = [line(t, (0.0, 1.0), (0.5, 0)), line(t, (0.0, 50.0), (1.0, 0))]
    rows = trips((0, 0.0, 20.0, False), (1, 0.0, 20.0, False))
    run = scene(t, line(t, (0, 0), (0.5, 0)), crowd, **rows)
    found = scores_of("neighbours_time_to_goal", run, None, None)
    assert found["literal"].reason == "no_completed_trips"
    assert value_of(found, "pace") == pytest.approx(2.0 / (40 / 30))


def test_a_longer_calibration() -> None:  # j02
    alone = journeys(30, (0, 0, 10, True), (1, 0, 15, True), (2, 25, 30, True), robot=False)
    run = lasting(15, 10, 15)
    found = effect(run, alone)
    assert value_of(found, "literal") == pytest.approx(10 / 12.5)
    assert value_of(found) == pytest.approx(1)


def test_slow_walkers_do_not_drop_out() -> None:  # the bias of e05
    """Everybody is slowed by 20 %; the slowest do not finish within the record."""
    alone = lasting(20, 4, 8, 12, 16, 18, robot=False)
    run = lasting(20, 5, 10, 15, 20, -20)
    found = effect(run, alone)
    assert value_of(found, "literal") > 0.9
    assert found["corrected"].status == "censored"
    assert found["corrected"].upper is not None
    assert found["corrected"].upper < value_of(found, "literal")
    assert value_of(found, "restricted") < 0.9


def test_bounds() -> None:
    open_ended, closed = lasting(20, 10, -20), lasting(20, 10, 20)
    found = effect(open_ended, closed)["corrected"]
    assert (found.status, found.reason) == ("censored", "unfinished_trips")
    assert (found.lower, found.upper, found.value) == (None, 1.0, None)
    found = effect(closed, open_ended)["corrected"]
    assert (found.lower, found.upper) == (1.0, None)
    found = effect(open_ended, open_ended)["corrected"]
    assert (found.status, found.lower, found.upper) == ("censored", None, None)
    assert value_of(effect(open_ended, open_ended), "restricted") == 1


def test_a_tie_of_the_longest_is_open_ended() -> None:
    assert effect(lasting(20, 10, 15, -15), lasting(20, 10))["corrected"].status == "censored"
    assert effect(lasting(20, 10, 15, -14), lasting(20, 10))["corrected"].status == "ok"


def test_trips_are_cut_at_the_arrival() -> None:
    run = journeys(30, (0, 0, 8, True), (1, 2, 14, True), (2, 11, 12, True), goal_time=10.0)
    alone = lasting(30, 8, robot=False)
    found = effect(run, alone)
    assert value_of(found, "literal") == 1.0
    assert found["literal"].extras["trips_denominator"] == 2
    # 8 is completed, 8 is censored at the same time: the longest is open
    assert found["corrected"].upper == pytest.approx(1.0)


def test_reasons_of_time() -> None:
    run, nobody = lasting(10, 5), scene(grid(10), line(grid(10), (0, 0), (1, 0)))
    assert why(effect(run, None)) == {("undefined", "no_reference")}
    assert why(effect(nobody, run)) == {("undefined", "no_trips")}
    assert why(effect(run, nobody)) == {("undefined", "no_trips")}
    found = effect(lasting(10, -10), run)
    assert found["literal"].reason == "no_completed_trips"
    assert found["corrected"].status == "censored"
    assert found["restricted"].status == "ok"
    at_once = journeys(10, (0, 3, 3, True))
    found = effect(at_once, run)
    assert found.pop("pace").reason == "no_trips"
    assert why(found) == {("undefined", "zero_denominator")}


# -------------------------------------------------------------------- neighbours
def f01() -> Trajectories:
    """Two neighbours at 0.5 m/s for 10 s, two others at 1 m/s for 5 s."""
    t = grid(10)
    early = t <= 5 + 1e-9
    near = [line(t, (0, y), (0.5, 0)) for y in (1.0, -1.0)]
    far = [present_during(line(t, (0, y), (1, 0)), early) for y in (20.0, 22.0)]
    rows: list[Row] = [(0, 0, 10, True), (1, 0, 10, True), (2, 0, 5, True), (3, 0, 5, True)]
    return scene(t, line(t, (0, 0), (0.5, 0)), [*near, *far], **trips(*rows))


def test_neighbours() -> None:  # f01
    found = scores_of("neighbours_time_to_goal", f01())
    assert values(found) == {v: pytest.approx(10 / 7.5) for v in ("literal", "corrected", "pace")}
    found = scores_of("neighbours_velocity", f01())
    assert value_of(found, "literal") == pytest.approx(0.5 / ((0.5 * 202 + 102) / 304))
    assert value_of(found) == pytest.approx(0.5 / ((0.5 * 20 + 10.1) / 30.1))


def at(distance: float) -> Trajectories:
    t = grid(10)
    agents = [line(t, (0, distance), (1, 0)), line(t, (0, 30), (0.5, 0))]
    return scene(t, line(t, (0, 0), (1, 0)), agents, **trips((0, 0, 6, True), (1, 0, 10, True)))


@pytest.mark.parametrize(("distance", "near"), [(3.0, True), (3.25, False), (2.9, True)])
def test_three_metres_count(distance: float, near: bool) -> None:  # f02
    time = scores_of("neighbours_time_to_goal", at(distance))
    speed = scores_of("neighbours_velocity", at(distance))
    if near:
        assert values(time) == {
            "literal": pytest.approx(6 / 8),
            "corrected": pytest.approx(6 / 8),
            "pace": pytest.approx(1 / (16 / 11)),
        }
        assert values(speed) == {v: pytest.approx(1 / 0.75) for v in speed}
    else:
        assert why(time) == why(speed) == {("undefined", "no_neighbours")}


def test_centres_count_not_surfaces() -> None:
    assert why(scores_of("neighbours_velocity", at(3.1))) == {("undefined", "no_neighbours")}
    found = scores_of("neighbours_velocity", at(3.1), neighbour_radius=3.2)
    assert value_of(found) == pytest.approx(4 / 3)


def test_a_single_neighbour_is_the_crowd() -> None:  # b06, b02
    t = grid(10)
    for agent in (line(t, (2, 0), (1, 0)), line(t, (10, 1), (-1, 0))):
        run = scene(t, line(t, (0, 0), (1, 0)), [agent], **trips((0, 0, 10, True)))
        for metric in ("neighbours_time_to_goal", "neighbours_velocity"):
            found = [*values(scores_of(metric, run)).values()]
            assert found == pytest.approx([1.0] * len(found))


def test_only_meetings_inside_the_trip_count() -> None:
    t = grid(10)
    agent = Body(np.where(t < 5, 20.0, 1.0), 0 * t, 0 * t, 0 * t)
    rows: list[Row] = [(0, 0, 4.9, True), (0, 5.0, 10, False)]
    run = scene(t, line(t, (0, 0), (0, 0)), [agent], **trips(*rows))
    found = scores_of("neighbours_time_to_goal", run)
    assert found["literal"].reason == "no_completed_trips"
    # the one that met the robot is the longest, and unfinished, above and below
    assert (found["corrected"].status, found["corrected"].lower) == ("censored", None)
    assert found["corrected"].upper is None
    with pytest.raises(InputError, match="no agent_id has: 7"):
        scene(t, line(t, (0, 0), (0, 0)), [agent], **trips((7, 0, 10, True)))


def test_bounds_of_neighbours() -> None:
    t = grid(10)
    agents = [line(t, (1, 0), (0, 0)), line(t, (50, 0), (0, 0))]
    robot = line(t, (0, 0), (0, 0))
    run = scene(t, robot, agents, **trips((0, 0, 5, True), (1, 0, 10, False)))
    found = scores_of("neighbours_time_to_goal", run)["corrected"]
    # 5 over 5 + 0.5 * 5
    assert found.upper == pytest.approx(5 / 7.5)
    assert found.lower is None
    run = scene(t, robot, agents, **trips((0, 0, 5, False), (1, 0, 10, True)))
    found = scores_of("neighbours_time_to_goal", run)["corrected"]
    assert found.lower == pytest.approx(0.5)
    assert found.upper is None


def test_reasons_of_neighbours() -> None:
    t = grid(5)
    lone = scene(t, line(t, (0, 0), (1, 0)))
    crowd = scene(t, None, [line(t, (0, 0), (1, 0))])
    assert why(scores_of("neighbours_time_to_goal", lone)) == {("undefined", "no_trips")}
    assert why(scores_of("neighbours_velocity", lone)) == {("undefined", "no_agents")}
    for metric in ("neighbours_time_to_goal", "neighbours_velocity"):
        assert why(scores_of(metric, crowd)) == {("undefined", "invalid_no_robot")}
    still = scene(t, line(t, (0, 0), (1, 0)), [line(t, (1, 0), (0, 0))])
    assert why(scores_of("neighbours_velocity", still)) == {("undefined", "zero_denominator")}


def test_crowd_deviation() -> None:
    t = grid(5)
    alone = scene(t, None, [line(t, (0, 0), (1, 0)), line(t, (0, 5), (1, 0))])
    run = scene(t, None, [line(t, (0, 1), (1, 0)), line(t, (0, 5), (1, 0))])
    assert value_of(scores_of("crowd_deviation", run, None, alone)) == pytest.approx(0.5)
    assert why(scores_of("crowd_deviation", run)) == {("undefined", "no_reference")}
