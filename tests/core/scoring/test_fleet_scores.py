"""Scores of a fleet: the mean of what is known of its robots."""

from __future__ import annotations

from typing import Any

from crowdbot.core.scoring.fleet_scores import fleet_scores
from crowdbot.core.types.score import Score


def score(**more: Any) -> Score:
    """One score."""
    return Score(
        metric="m", symbol="M", category="c", variant="rate", unit="1", better="lower", **more
    )


def undefined(reason: str) -> Score:
    """One that is not known."""
    return score(status="undefined", reason=reason)


def test_the_fleet_has_the_mean_and_each_robot_its_own() -> None:
    found = fleet_scores({"a": [score(value=1.0)], "b": [score(value=3.0)]})
    assert [(s.variant, s.value) for s in found] == [
        ("rate", 2.0),
        ("rate@a", 1.0),
        ("rate@b", 3.0),
    ]


def test_robots_of_whom_nothing_is_known_are_left_out_and_told() -> None:
    fleet = fleet_scores({"a": [score(value=1.0)], "b": [undefined("no_agents")]})[0]
    assert (fleet.status, fleet.value, fleet.reason) == ("ok", 1.0, "of a only")
    fleet = fleet_scores({"a": [undefined("no_agents")], "b": [undefined("no_goal")]})[0]
    assert (fleet.status, fleet.reason) == ("undefined", "no_agents; no_goal")


def test_one_that_is_censored_makes_the_fleet_censored() -> None:
    late = score(status="censored", reason="not_reached", lower=10.0)
    fleet = fleet_scores({"a": [score(value=4.0)], "b": [late]})[0]
    assert (fleet.status, fleet.value, fleet.lower, fleet.upper) == ("censored", None, 7.0, None)
    assert fleet.reason == "b: not_reached"


def test_bounds_of_a_censored_fleet_are_the_means_of_bounds_and_values() -> None:
    late = score(status="censored", reason="not_reached", lower=10.0, upper=20.0)
    fleet = fleet_scores({"a": [score(value=4.0)], "b": [late]})[0]
    assert (fleet.lower, fleet.upper) == (7.0, 12.0)
    early = score(status="censored", reason="left", upper=2.0)
    fleet = fleet_scores({"a": [late], "b": [early]})[0]
    assert (fleet.lower, fleet.upper) == (None, 11.0)
