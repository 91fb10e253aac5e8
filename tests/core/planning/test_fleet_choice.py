"""Planners of several robots, as texts name them."""

from __future__ import annotations

import pytest

from crowdbot.core.planning.choice import PlannerChoice
from crowdbot.core.planning.fleet_choice import check_robots, planners_by_robot
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.registry.registry import discover
from crowdbot.errors import InputError, UnknownNameError

REGISTRY = discover()


def resolved(text: str, *settings: str) -> PlannerChoice:
    """The planners that a text names."""
    return resolve_planner(text, REGISTRY, settings)


def test_a_text_names_robots_or_a_planner_only() -> None:
    assert planners_by_robot("dwa") == {}
    assert planners_by_robot("my/dwa=2.yaml") == {}
    assert planners_by_robot("a=dwa,b=mine.py:Mine") == {"a": "dwa", "b": "mine.py:Mine"}
    assert planners_by_robot("a=x,y.yaml,b=dwa") == {"a": "x,y.yaml", "b": "dwa"}


def test_each_robot_has_the_planner_that_it_was_given() -> None:
    fleet = resolved("a=dwa,b=stand_still", "a.speed=0.4")
    assert fleet.label.startswith("a=dwa+")
    assert fleet.label.endswith(",b=stand_still")
    assert fleet.of("a").spec_dump["speed"] == 0.4
    assert fleet.of("b").name == "stand_still"
    assert fleet.spec_dump["robots"]["b"]["kind"] == "stand_still"
    assert fleet.role == "candidate"
    assert not fleet.privileged
    assert resolved("a=oracle,b=dwa").privileged


def test_one_planner_is_that_of_all() -> None:
    one = resolved("dwa")
    assert one.of("a") is one
    assert one.of("b") is one
    check_robots(one, ["a", "b"])


@pytest.mark.parametrize(
    ("text", "settings", "message"),
    [
        ("a=dwa,a=stand_still", (), "two planners"),
        ("a=,b=dwa", (), "Write a=dwa"),
        ("a=dwa,b=dwa", ("speed=1",), r"Write a\.speed=1"),
    ],
)
def test_what_is_not_clear_is_refused(text: str, settings: tuple[str, ...], message: str) -> None:
    with pytest.raises(InputError, match=message):
        resolved(text, *settings)


def test_robots_that_are_not_there_are_told() -> None:
    with pytest.raises(UnknownNameError, match="unknown robot with a planner 'c'"):
        resolved("a=dwa,b=dwa", "c.speed=1")
    with pytest.raises(UnknownNameError, match="unknown robot 'bb'"):
        check_robots(resolved("a=dwa,bb=dwa"), ["a", "b"])
