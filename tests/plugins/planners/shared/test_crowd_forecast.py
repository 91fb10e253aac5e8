"""Forecasts of people by the crowd engine, and the crowd that planners imagine."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.errors import UnknownNameError
from crowdbot.plugin import Array, ImaginedCrowd
from crowdbot.plugins.planners.crowd_prediction.forecast_build import CrowdForecast
from crowdbot.plugins.planners.crowd_prediction.seats_build import (
    leave_seats,
    mean_errors,
    seated,
    settle,
)

STEP, STEPS = 0.16, 25
FAR = np.full((STEPS + 1, 2), 1e4)


@pytest.fixture(scope="module")
def forecast() -> CrowdForecast:
    return CrowdForecast("calibrated", 1.0, 5.0)


def predict(forecast: CrowdForecast, t: float, people: Array, path: Array = FAR) -> Array:
    return forecast.predict(t, np.arange(len(people)), people, path, 0.3, STEP)


def test_people_who_would_meet_are_predicted_to_part(forecast: CrowdForecast) -> None:
    forecast.reset()
    people = np.array([[0.0, 0.0, 1.3, 0.0, 0.2], [5.0, 0.1, -1.3, 0.0, 0.2]])
    found = predict(forecast, 0.0, people)
    gap = np.hypot(*(found[:, 0] - found[:, 1]).T)
    assert gap.min() > 0.2  # half of a deviation counts before there are errors
    assert found[-1, 0, 0] > 3.5
    assert found[-1, 1, 0] < 1.5


def test_people_who_stand_are_predicted_to_stand(forecast: CrowdForecast) -> None:
    forecast.reset()
    people = np.array([[2.0, 0.0, 0.05, 0.0, 0.2]])
    found = predict(forecast, 0.0, people)
    assert found[-1, 0] == pytest.approx([2.2, 0.0])


def test_people_step_aside_for_the_robot(forecast: CrowdForecast) -> None:
    forecast.reset()
    path = np.column_stack([0.1 * np.arange(STEPS + 1), np.zeros(STEPS + 1)])
    people = np.array([[5.0, 0.05, -1.2, 0.0, 0.2]])
    alone = predict(forecast, 0.0, people)
    forecast.reset()
    met = predict(forecast, 0.0, people, path)
    assert abs(met[:, 0, 1]).max() > abs(alone[:, 0, 1]).max() + 0.1


def test_people_who_go_straight_through_each_other_are_no_longer_trusted_to_part(
    forecast: CrowdForecast,
) -> None:
    forecast.reset()
    assert forecast.trust == pytest.approx(0.5)
    for k in range(60):
        t = k * 0.125
        people = np.array([[1.2 * t, 0.0, 1.2, 0.0, 0.2], [5.0 - 1.2 * t, 0.05, -1.2, 0.0, 0.2]])
        predict(forecast, t, people)
    assert forecast.trust < 0.1


def test_the_same_people_give_the_same_forecast_after_a_reset(forecast: CrowdForecast) -> None:
    people = np.array([[0.0, 0.0, 1.3, 0.2, 0.2], [4.0, 0.5, -1.0, 0.0, 0.2]])
    forecast.reset()
    first = predict(forecast, 0.0, people)
    forecast.reset()
    assert (predict(forecast, 0.0, people) == first).all()


def test_no_people_are_predicted_where_none_are(forecast: CrowdForecast) -> None:
    forecast.reset()
    assert predict(forecast, 0.0, np.zeros((0, 5))).shape == (STEPS, 0, 2)


def test_people_left_out_of_an_imagined_crowd_matter_to_no_one() -> None:
    crowd = ImaginedCrowd("calibrated", np.full(2, 1.3))
    place, going = np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([[1.3, 0.0], [-1.3, 0.0]])
    goal = place + 10.0 * going
    both = crowd.accelerations(place, going, goal, np.array([True, True]))
    alone = crowd.accelerations(place, going, goal, np.array([True, False]))
    assert np.hypot(*both[0]) > np.hypot(*alone[0]) + 0.1
    assert (alone[1] == 0.0).all()


def test_a_crowd_that_does_not_exist_is_refused() -> None:
    with pytest.raises(UnknownNameError, match="calibratd"):
        ImaginedCrowd("calibratd", np.ones(1))


def test_the_nearest_people_take_the_free_seats_of_the_nearest_speeds() -> None:
    speeds = np.array([0.5, 1.0, 1.0, 1.5])
    people = np.array([[x, 1.0, 0.0, 0.0, 0.2] for x in (9.0, 2.0, 1.0, 3.0, 4.0)])
    wanted = np.array([[1.4, 0.0], [0.0, 1.1], [1.0, 0.0], [0.1, 0.0], [-0.9, 0.0]])
    taken, seats, slips = seated(people, wanted, np.zeros(2), 0.2, 3, speeds)
    assert seats.tolist() == [-1, 2, 1, -1, 0]  # far away; third; first; stands; the last seat left
    place, velocity, goal, present = taken
    assert present.tolist() == [True, True, True, False]
    assert place[2].tolist() == [2.0, 1.0]
    assert velocity[2].tolist() == [0.0, 0.0]
    assert goal[2] == pytest.approx([2.0, 21.0])
    assert slips[1] == pytest.approx([0.0, 0.1])
    assert slips[4] == pytest.approx([-0.4, 0.0])


def test_people_leave_their_seats_as_they_walk_and_then_keep_their_velocity() -> None:
    places, speeds, pulls = np.zeros((1, 1, 2)), np.ones((1, 1, 2)), np.full((1, 1, 2), 0.5)
    out = np.zeros((4, 2, 2))
    leave_seats(places, speeds, pulls, np.array([0, -1]), np.zeros((2, 2)), (0.1, 2), out)
    after = 0.2 + 0.5 * 0.5 * 0.2**2  # v t + a t^2 / 2
    assert out[:, 0, 0] == pytest.approx([0.1 + 0.25 * 0.1**2, after, after + 0.11, after + 0.22])
    assert (out[:, 1] == 0.0).all()


def test_far_people_and_far_times_are_predicted_at_their_velocity(forecast: CrowdForecast) -> None:
    forecast.reset()
    rows = [[2.0 + 0.6 * (k // 5), 0.6 * (k % 5) - 1.2, -1.0, 0.1, 0.2] for k in range(30)]
    people = np.array(rows)
    found = predict(forecast, 0.0, people)
    kept = people[:, :2] + (STEP * np.arange(1, STEPS + 1))[:, None, None] * people[:, 2:4]
    alone = np.abs(found - kept).max(axis=(0, 2)) < 1e-12
    away = np.hypot(people[:, 0] - FAR[0, 0], people[:, 1] - FAR[0, 1])
    assert set(np.flatnonzero(alone)) == set(np.argsort(away, kind="stable")[20:])
    assert np.diff(found[15:], 2, axis=0) == pytest.approx(0.0, abs=1e-9)


def test_what_people_want_moves_towards_what_they_do_whatever_their_order() -> None:
    people = np.array([[0.0, 0.0, 1.0, 2.0, 0.2], [0.0, 0.0, 3.0, 4.0, 0.2]])
    out = np.empty((2, 2))
    settle(np.array([7, 4]), people, np.array([5, 7]), np.array([[9.0, 9], [0.0, 1.0]]), 0.25, out)
    assert out.tolist() == [[0.25, 1.25], [3.0, 4.0]]


def test_errors_are_of_those_who_are_still_there() -> None:
    people = np.array([[1.0, 0.0, 0, 0, 0.2], [5.0, 5.0, 0, 0, 0.2]])
    kept, crowd = np.array([[9.0, 9.0], [1.0, 2.0]]), np.array([[9.0, 9.0], [4.0, 4.0]])
    count, off, other = mean_errors(np.array([3, 8]), people, np.array([1, 3]), kept, crowd)
    assert (count, off, other) == (1, 4.0, 25.0)
    assert mean_errors(np.array([8]), people[1:], np.array([1, 3]), kept, crowd) == (0, 0.0, 0.0)
