"""Planners of several robots: ``a=dwa,b=mine.py:Mine``, or one for all."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence

from crowdbot.core.planning.choice import PlannerChoice
from crowdbot.core.planning.planner import Planner
from crowdbot.errors import InputError, UnknownNameError

_NAMED = re.compile(r"[A-Za-z_]\w*=")
_NEXT = re.compile(r",(?=[A-Za-z_]\w*=)")


def planners_by_robot(text: str) -> dict[str, str]:
    """Return robot -> planner from a text that names robots; empty if it names only a planner.

    Raises:
        InputError: a robot is named twice, or has no planner.
    """
    if not _NAMED.match(text):
        return {}
    planners: dict[str, str] = {}
    for part in _NEXT.split(text):
        robot, _, planner = part.partition("=")
        if not planner:
            raise InputError(f"'{part}': which planner? Write {robot}=dwa")
        if robot in planners:
            raise InputError(
                f"robot '{robot}' is given two planners: {planners[robot]} and {planner}"
            )
        planners[robot] = planner
    return planners


def fleet_choice(
    text: str,
    settings: Sequence[str],
    choose: Callable[[str, Sequence[str]], PlannerChoice],
) -> PlannerChoice | None:
    """Return the planners of several robots as one choice; None if the text names no robot.

    Args:
        text: ``a=PLANNER,b=PLANNER``.
        settings: ``a.key=value``.
        choose: function that finds one planner.

    Raises:
        InputError: a setting does not name a robot, or as `planners_by_robot`.
        UnknownNameError: a setting names a robot without a planner.
    """
    by_robot = planners_by_robot(text)
    if not by_robot:
        return None
    given: dict[str, list[str]] = {robot: [] for robot in by_robot}
    for setting in settings:
        robot, dot, rest = setting.partition(".")
        if not dot or "=" in robot:
            first = next(iter(by_robot))
            raise InputError(f"'{setting}': of which robot? Write {first}.{setting}")
        if robot not in given:
            raise UnknownNameError("robot with a planner", robot, given)
        given[robot].append(rest)
    return together({robot: choose(name, given[robot]) for robot, name in by_robot.items()})


def together(fleet: Mapping[str, PlannerChoice]) -> PlannerChoice:
    """Combine several planners into one choice; `PlannerChoice.of` returns them."""
    choices = list(fleet.values())
    roles = {choice.role for choice in choices}

    def build() -> Planner:
        raise InputError("each robot of a fleet has a planner of its own")

    return PlannerChoice(
        name=", ".join(f"{robot}: {choice.name}" for robot, choice in fleet.items()),
        spec_dump={
            "kind": "fleet",
            "robots": {
                robot: {**choice.spec_dump, "name": choice.name, "label": choice.label}
                for robot, choice in fleet.items()
            },
        },
        build=build,
        pinned=all(choice.pinned for choice in choices),
        needs=None,
        label=",".join(f"{robot}={choice.label}" for robot, choice in fleet.items()),
        privileged=any(choice.privileged for choice in choices),
        role=roles.pop() if len(roles) == 1 else "candidate",
        in_process=all(choice.in_process for choice in choices),
        memory=next((c.memory for c in choices if c.memory is not None), None),
        repeatable=all(choice.repeatable for choice in choices),
        fleet=dict(fleet),
    )


def check_robots(choice: PlannerChoice, robots: Sequence[str]) -> None:
    """Raise an error if the planners' robots are not those of the scenario.

    Raises:
        UnknownNameError: a planner is for an unknown robot.
        InputError: a robot has no planner.
    """
    for robot in choice.fleet:
        if robot not in robots:
            raise UnknownNameError("robot", robot, robots)
    missing = [robot for robot in robots if choice.fleet and robot not in choice.fleet]
    if missing:
        raise InputError(
            f"robot '{missing[0]}' has no planner; add {missing[0]}=PLANNER, or give one "
            "planner without a name for all"
        )
