"""Planners that are wrong, each found by the check that is for it."""
# ruff: noqa: ARG001, ARG005 - the signatures are fixed

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, ClassVar
from unittest import SkipTest

import numpy as np
import pytest

from crowdbot.plugin import Command, NoValidCommand, Observation
from crowdbot.testing import planner
from crowdbot.testing.checks import checks_in
from tests.testing.wrong import BUILT_IN, WrongPlanner, assert_fails, made

Step = Callable[[Any, Observation], Any]


def driver(step: Step) -> Any:
    class Planner:
        def __init__(self) -> None:
            self.count = 0

        def reset(self, *given: Any) -> None:
            self.limits, self.rng = given[1], np.random.default_rng(given[3])

        def step(self, obs: Observation) -> Any:
            self.count += 1
            return step(self, obs)

    return made(WrongPlanner, lambda _: Planner())


def _ahead(self: Any, obs: Observation) -> Command:
    return Command(0.1 * min(1.0, math.dist(obs.goal, obs.pose[:2])), 0.0)


def _normalises(_: Any, obs: Observation) -> Command:
    away = math.dist(obs.goal, obs.pose[:2])
    return Command(0.1 * away / away, 0.0)


def _gives_up(_: Any, obs: Observation) -> Command:
    if obs.goal[0] - obs.pose.x < 3.5:
        raise ValueError("no path")
    return Command(0.1, 0.0)


def _stops(_: Any, obs: Observation) -> Command:
    raise NoValidCommand(f"lost at {obs.t}")


@pytest.mark.parametrize(
    ("check", "step", "because"),
    [
        (planner.check_commands_are_numbers, lambda s, o: Command(math.nan, 0.0), "must be finite"),
        (planner.check_commands_are_numbers, lambda s, o: [0.1, 0.0], "a Command"),
        (
            planner.check_commands_are_numbers,
            lambda s, o: o.log(3, 1.0),
            "name of a signal is text",
        ),
        (planner.check_commands_are_within_limits, lambda s, o: Command(9.0, 0.0), "beyond"),
        (planner.check_commands_are_within_limits, lambda s, o: Command(0.1, 0.0, 0.2), "beyond"),
        (
            planner.check_reset_is_deterministic,
            lambda s, o: Command(float(np.random.default_rng().uniform(0.0, 0.1)), 0.0),
            "two planners",
        ),
        (
            planner.check_runs_are_independent,
            lambda s, o: Command(0.001 * s.count, 0.0),
            "the second run",
        ),
        (planner.check_unreachable_goal, _gives_up, "a goal behind walls: .*no path"),
        (planner.check_goal_reached_at_start, _normalises, "ZeroDivisionError"),
    ],
)
def test_planners(check: Any, step: Step, because: str) -> None:
    assert_fails(check, driver(step), because)


@pytest.mark.parametrize("step", [_ahead, _stops, lambda s, o: Command(0.1 * s.rng.random(), 0.0)])
def test_sound_planners_pass(step: Step) -> None:
    for check in checks_in(planner):
        check(driver(step), BUILT_IN)


@pytest.mark.parametrize("privileged_planner", [True, False])
def test_only_privileged_planners_are_told_the_truth(privileged_planner: bool) -> None:
    class Told(WrongPlanner):
        """Is told where people are, or is not."""

        privileged: ClassVar[bool] = privileged_planner

    seen: list[bool] = []

    class Planner:
        def reset(self, *given: Any) -> None:
            del given

        def step(self, obs: Observation) -> Any:
            seen.append(obs.truth is not None and obs.truth.pose == obs.pose)
            return Command(0.0, 0.0)

    planner.check_commands_are_numbers(made(Told, lambda _: Planner()), BUILT_IN)
    assert set(seen) == {privileged_planner}


def test_a_sensor_that_nobody_has() -> None:
    class Nosy(WrongPlanner):
        """Wants to smell."""

        needs: ClassVar[tuple[str, ...]] = ("nose",)

    component = made(Nosy, lambda _: None)
    with pytest.raises(SkipTest, match="'nose'"):
        planner.check_unreachable_goal(component, BUILT_IN)
