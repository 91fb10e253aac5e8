"""Forecasts of people by the crowd engine, and the crowd that planners imagine."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.errors import UnknownNameError
from crowdbot.plugin import Array, ImaginedCrowd
from crowdbot.plugins.planners.crowd_prediction.forecast_build import CrowdForecast

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
