"""Which robots that topple are excused; the others wanted their draw to be replaced."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest

from crowdbot.core.trajectories.fault.struck_over import USUAL_RULE, struck_over
from crowdbot.core.types.arrays import Array
from crowdbot.plugins.metrics.fault_build import fault_rule
from crowdbot.plugins.metrics.safe_efficiency import SafeEfficiencySpec
from scripts.fault_cases.cases import REACH, Case, T, Track

ZERO = np.zeros_like(T)
#: The person, at 1.4 m/s, would touch a robot at 0.5 m/s at this time, s.
TOUCH = 4.0


def integral(rate: Array) -> Array:
    return np.concatenate([[0.0], np.cumsum(rate[1:] * np.diff(T))])


def excused(
    speed: Array, y: Array = ZERO, walks: float = 1.4, side: float = -1.0, early: bool = False
) -> bool:
    """Return True if a robot is excused which a person meets; it lies 0.3 s after the touch.

    Args:
        speed: of the robot along x, m/s.
        y: of the robot, m.
        walks: speed of the person along x, m/s.
        side: -1: the person comes from behind, 1: from ahead.
        early: True if the robot drives into another person before.
    """
    x = integral(speed)
    at = int(np.argmin(np.abs(T - TOUCH)))
    person = x[at] + side * (REACH - 0.01) + walks * (T - T[at])
    person = np.where(at < np.arange(len(T)), x + side * (REACH - 0.01), person)  # stays in touch
    others = (Track(x=ZERO + x[10] + REACH - 0.03, y=ZERO),) if early else ()
    case = Case(name="", told="", fault=False, rule="", shown=(), robot=Track(x=x, y=y),
                people=(Track(x=person, y=ZERO), *others))  # fmt: skip
    return struck_over(case.run(), TOUCH + 0.3) is not None


STEADY = ZERO + 0.5


def test_a_robot_that_drove_on_is_excused() -> None:
    assert excused(STEADY)
    assert excused(np.where(TOUCH - 1.5 < T, 0.4, 0.5))  # it slowed down a little


@pytest.mark.parametrize(
    ("name", "facts"),
    [
        ("brakes before the person", {"speed": np.where(TOUCH - 0.5 < T, 0.15, 0.6)}),
        ("brakes and goes on", {"speed": np.where(np.abs(T - TOUCH + 1.0) < 0.3, 0.1, 0.6)}),
        ("waits to be struck", {"speed": ZERO + 0.02}),
        ("turns in", {"speed": STEADY, "y": np.interp(T, [TOUCH - 1.2, TOUCH - 0.2], [-0.8, 0.0])}),
        ("meets the person ahead", {"speed": STEADY, "walks": -1.4, "side": 1.0}),
        ("reverses into the person", {"speed": -STEADY, "walks": 0.0}),
        ("has touched another person at fault", {"speed": STEADY, "early": True}),
    ],
)  # fmt: skip
def test_a_planner_cannot_have_a_bad_draw_replaced(name: str, facts: dict[str, object]) -> None:
    assert not excused(**facts), name  # type: ignore[arg-type]


def test_nobody_touched_it() -> None:
    case = Case(name="", told="", fault=False, rule="", shown=(),
                robot=Track(x=0.5 * T, y=ZERO), people=(Track(x=ZERO - 9.0, y=ZERO),))  # fmt: skip
    assert struck_over(case.run(), 4.0) is None


def test_the_touch_was_long_before() -> None:
    x = integral(STEADY)
    brief = np.where(np.abs(T - 1.0) < 0.1, x - REACH + 0.01, x - 2.0)
    case = Case(name="", told="", fault=False, rule="", shown=(),
                robot=Track(x=x, y=ZERO), people=(Track(x=brief, y=ZERO),))  # fmt: skip
    assert struck_over(case.run(), 4.0) is None


def test_the_rule_is_that_of_the_metrics() -> None:
    metrics = fault_rule(SafeEfficiencySpec.model_validate({}))
    for field in fields(metrics):
        assert getattr(USUAL_RULE, field.name) == pytest.approx(getattr(metrics, field.name))
