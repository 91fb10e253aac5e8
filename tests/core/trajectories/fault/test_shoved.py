"""Who is shoved into a person: excused only if it stood until then, and only while it is shoved."""

from __future__ import annotations

import numpy as np
import pytest

from scripts.fault_cases.cases import REACH, Case, T, Track
from tests.core.trajectories.fault.test_decision_table import first_is_at_fault

ZERO = np.zeros_like(T)


def along(speed: np.ndarray) -> np.ndarray:
    """Way (N,) at speeds (N,), m."""
    return np.concatenate([[0.0], np.cumsum(speed[1:] * np.diff(T))])


@pytest.mark.parametrize(
    ("before", "follows", "fault"),
    [
        (0.0, 1.0, False),  # it stood, and the person behind pushes it on
        (0.3, 1.0, True),  # it drove before
        (0.0, 0.0, True),  # the person behind stays, so it drives by itself
    ],
)
def test_only_a_robot_that_stood_and_is_pushed(before: float, follows: float, fault: bool) -> None:
    x = along(np.where(T < 3.0, before, 0.25))
    behind = np.where(T < 3.0, x - REACH + 0.005 - np.maximum(0.0, 2.9 - T), 0.0)
    held = float(x[np.searchsorted(T, 3.0)]) - REACH + 0.005
    behind = np.where(T < 3.0, behind, held + follows * (x - held - REACH + 0.005))
    ahead = float(np.interp(3.2, T, x)) + REACH
    people = Track(x=np.maximum(ahead, x + REACH - 0.005), y=ZERO), Track(x=behind, y=ZERO)
    case = Case(name="", told="", fault=fault, rule="", shown=(), robot=Track(x=x, y=ZERO),
                people=people)  # fmt: skip
    assert first_is_at_fault(case.run()) is fault


def test_a_person_before_it_who_was_touched_first_excuses_nothing() -> None:
    x = along(np.where(T < 3.0, 0.0, 0.25))
    front = Track(x=np.maximum(x + REACH - 0.005, REACH + 1.0 - 0.4 * T), y=ZERO)
    aside = Track(x=x + 0.6, y=ZERO + 0.9)
    other = Track(x=np.maximum(x + REACH - 0.005, REACH + 0.15), y=ZERO + 1e-3)
    case = Case(name="", told="", fault=True, rule="", shown=(), robot=Track(x=x, y=ZERO),
                people=(other, front, aside))  # fmt: skip
    assert first_is_at_fault(case.run())
