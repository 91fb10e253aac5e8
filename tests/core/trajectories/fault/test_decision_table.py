"""The decision table of fault: each drawn case, and its mirror image, on other clocks."""

from __future__ import annotations

import numpy as np
import pytest

import crowdbot
from scripts.fault_cases.cases import CASES, LONG, PERSON, REACH, ROBOT, Case, T, Track
from scripts.fault_cases.draw import RULES, files

ZERO = np.zeros_like(T)


def first_is_at_fault(run: crowdbot.Trajectories) -> bool:
    found = crowdbot.score(run, metrics="contacts_at_fault")
    robot, person = (found.find("contacts_at_fault", v).value for v in ("corrected", "person"))
    assert robot is not None
    assert person is not None
    assert robot + person >= 1, "there is no contact"
    return robot > 0


@pytest.mark.parametrize("case", CASES, ids=lambda c: c.name)
def test_the_case_is_decided_as_drawn(case: Case) -> None:
    assert first_is_at_fault(case.run()) is case.fault
    assert RULES[case.rule][1] is case.fault


@pytest.mark.parametrize("case", CASES, ids=lambda c: c.name)
def test_so_is_its_mirror_image(case: Case) -> None:
    def turned(track: Track) -> Track:
        return Track(x=track.x, y=-track.y, theta=-track.theta)

    mirrored = Case(
        name=case.name, told=case.told, fault=case.fault, rule=case.rule, shown=case.shown,
        outline=case.outline, robot=turned(case.robot), people=tuple(map(turned, case.people)),
    )  # fmt: skip
    assert first_is_at_fault(mirrored.run()) is case.fault


def test_each_rule_has_a_case_and_each_case_a_picture() -> None:
    assert {case.rule for case in CASES} == set(RULES)
    assert len({case.name for case in CASES}) == len(CASES)
    for file, text in files().items():
        assert file.read_text(encoding="utf-8") == text


# ------------------------------------------------------------------ where the lines are
def shove(speed: float, seconds: float) -> crowdbot.Trajectories:
    """The robot touches at 0.04 m/s, and after 3 s pushes on for some seconds."""
    fast = (T > 3.0) & (3.0 + seconds >= T)
    x = np.concatenate([[0.0], np.cumsum(np.where(fast, speed, 0.0)[1:] * np.diff(T))]) + 0.1
    x = np.minimum(0.04 * T, 0.1) + x - 0.1
    person = Track(x=np.maximum(x + REACH - 0.004, REACH + 0.05), y=ZERO)
    return Case(name="", told="", fault=True, rule="", shown=(), robot=Track(x=x, y=ZERO),
                people=(person,)).run()  # fmt: skip


@pytest.mark.parametrize(
    ("speed", "seconds", "fault"), [(0.5, 4.0, True), (0.1, 1.0, True), (0.0, 1.0, False)]
)
def test_a_shove_is_a_fault_however_gently_it_began(
    speed: float, seconds: float, fault: bool
) -> None:
    assert first_is_at_fault(shove(speed, seconds)) is fault


@pytest.mark.parametrize(("begins", "fault"), [(3.0, True), (0.2, False)])
def test_moving_onto_somebodys_way_early_enough_is_no_cutting_in(
    begins: float, fault: bool
) -> None:
    sideways = np.where((begins < T) & (begins + 1.6 > T), 0.5, 0.0)
    y = np.concatenate([[0.0], np.cumsum(sideways[1:] * np.diff(T))]) - 0.8
    robot = Track(x=0.5 * T, y=y)
    follower = Track(x=1.0 * T - 2.3, y=ZERO)
    case = Case(name="", told="", fault=fault, rule="", shown=(), robot=robot, people=(follower,))
    assert first_is_at_fault(case.run()) is fault


@pytest.mark.parametrize(("rate", "fault"), [(1.0, True), (0.03, False), (-1.0, False)])
def test_turning_towards_somebody_is_judged_at_the_touching_point(rate: float, fault: bool) -> None:
    theta = np.clip((T - 2.0) * abs(rate), 0.0, 1.2)
    if rate < 0:  # it turns away; the person walks into its side
        person = Track(x=ZERO + 0.35, y=np.maximum(3.0 - 0.5 * T, 0.3 + PERSON - 0.01))
        theta = ZERO
    else:
        person = Track(x=ZERO + 0.35, y=ZERO + 0.62 if rate > 0.1 else ZERO + 0.48)
    case = Case(name="", told="", fault=fault, rule="", shown=(), outline=True,
                robot=Track(x=ZERO, y=ZERO, theta=theta), people=(person,))  # fmt: skip
    assert first_is_at_fault(case.run()) is fault
    assert LONG.shape == (4, 2)
    assert ROBOT > PERSON
