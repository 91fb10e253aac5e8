"""Checks for every planner, on courses without a simulator (`crowdbot.testing.drive`)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, cast

from crowdbot.core.planning.registered import half_of
from crowdbot.core.registry.registry import Registry
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.component_specs import PlannerSpec
from crowdbot.dsl.spec.spec import ComponentSpec
from crowdbot.errors import PlannerError
from crowdbot.testing.around import around, built, specs_of
from crowdbot.testing.drive import AT_GOAL, COURSES, UNREACHABLE, Course, Driven, sensors_for

_STEPS = 24


def check_commands_are_numbers(component: Component[Any], registry: Registry | None = None) -> None:
    """On every course ``step`` returns finite commands, or raises ``NoValidCommand``.

    If this fails, the message names the course and the result or error. Readings are inf if nothing
    is in range.
    """
    for driver in _drivers(component, registry):
        for name, course in COURSES.items():
            _drive(name, driver(course))


def check_commands_are_within_limits(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """No command exceeds the ``RobotLimits`` given to ``reset``.

    If this fails, clamp to ``limits`` yourself: the host also clamps, and counts these commands.
    """
    for driver in _drivers(component, registry):
        for name, course in COURSES.items():
            driven = driver(course)
            _drive(name, driven)
            count = driven.host.clamped
            assert count == 0, f"{name}: {count} of {_STEPS} commands were beyond the limits"


def check_reset_is_deterministic(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """Two planners with the same spec and seed give the same commands.

    If this fails, draw from ``np.random.default_rng(seed)``, created in ``reset``; do not use a
    clock.
    """
    for driver in _drivers(component, registry):
        course = COURSES["people in a room"]
        one, two = (_drive("people in a room", driver(course)) for _ in range(2))
        _assert_same(one, two, "two planners of the same spec")


def check_runs_are_independent(component: Component[Any], registry: Registry | None = None) -> None:
    """``reset`` clears everything: a second run with the same object is like the first.

    If this fails, reset in ``reset`` everything that ``step`` changes.
    """
    for driver in _drivers(component, registry):
        driven = driver(COURSES["people in a room"])
        one = list(_drive("first run", driven))
        two = list(_drive("second run", driven))
        _assert_same(one, two, "the second run of one planner")


def check_unreachable_goal(component: Component[Any], registry: Registry | None = None) -> None:
    """A goal behind walls gives a command or ``NoValidCommand``, never NaN or another exception.

    If this fails, a search finds no path and its result is used anyway.
    """
    for driver in _drivers(component, registry):
        _drive("a goal behind walls", driver(UNREACHABLE))


def check_goal_reached_at_start(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """A robot that starts at its goal gets valid commands.

    If this fails, something is divided by the distance to the goal.
    """
    for driver in _drivers(component, registry):
        _drive("the goal reached at the start", driver(AT_GOAL))


def _drivers(
    component: Component[Any], registry: Registry | None
) -> Iterator[Callable[[Course], Driven]]:
    """Yield, for each example, a function that builds a new planner and starts it on a course."""
    known = around(component, registry)
    sensors = sensors_for(getattr(component.spec, "needs", None), known)
    for spec in specs_of(component, known):
        yield _driver(component.kind, spec, known, sensors)


def _driver(
    kind: str, spec: ComponentSpec, known: Registry, sensors: Mapping[str, Any]
) -> Callable[[Course], Driven]:
    privileged = getattr(spec, "privileged", False) is True
    return lambda course: Driven(
        built(known, spec, *half_of(cast(PlannerSpec, spec), known)),
        kind,
        course,
        sensors,
        privileged=privileged,
    )


def _drive(name: str, driven: Driven) -> list[Any]:
    try:
        return driven.run(_STEPS)
    except PlannerError as error:
        raise AssertionError(f"{name}: {error}") from error


def _assert_same(one: list[Any], two: list[Any], subject: str) -> None:
    for k, (a, b) in enumerate(zip(one, two, strict=True)):
        assert a == b, f"{subject}: step {k} gave {tuple(b)} instead of {tuple(a)}"
