"""The decision table of fault: each drawn case, and its mirror image, on other clocks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import crowdbot
from crowdbot.core.trajectories.fault.struck_over import USUAL_RULE
from crowdbot.core.trajectories.fault.swerving import swerved
from crowdbot.core.trajectories.person_contacts import person_contacts
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


def changed(case: Case, change: Callable[[Track], Track]) -> Case:
    return replace(case, robot=change(case.robot), people=tuple(map(change, case.people)))


@pytest.mark.parametrize("case", CASES, ids=lambda c: c.name)
def test_so_is_its_mirror_image_and_the_case_elsewhere(case: Case) -> None:
    def mirrored(track: Track) -> Track:
        return Track(x=track.x, y=-track.y, theta=-track.theta)

    def turned(track: Track) -> Track:
        c, s = np.cos(2.1), np.sin(2.1)
        x, y = c * track.x - s * track.y, s * track.x + c * track.y
        return Track(x=x + 40.0, y=y - 7.0, theta=track.theta + 2.1)

    for change in (mirrored, turned):
        assert first_is_at_fault(changed(case, change).run()) is case.fault


@pytest.mark.parametrize("case", CASES, ids=lambda c: c.name)
def test_so_it_is_on_other_clocks_backwards_and_with_bystanders(case: Case) -> None:
    for step in (0.1, 0.02):
        assert first_is_at_fault(case.run(np.arange(0.0, 8.001, step))) is case.fault
    back = replace(case.robot, theta=case.robot.theta + np.pi)  # LONG is symmetric
    assert first_is_at_fault(replace(case, robot=back).run()) is case.fault
    far = Track(x=0.3 * T - 30.0, y=ZERO + 9.0)
    assert first_is_at_fault(replace(case, people=(*case.people, far)).run()) is case.fault


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


@pytest.mark.parametrize(
    ("gap", "sideways", "walks", "fault"),
    [
        (0.05, 0.5, 0.5, True),
        (0.12, 0.5, 0.5, True),
        (0.16, 0.5, 0.0, True),
        (0.16, 0.3, 0.5, True),
        (0.12, 0.0, 0.5, False),
    ],
)
def test_coming_over_is_a_fault_however_suddenly(
    gap: float, sideways: float, walks: float, fault: bool
) -> None:
    y = np.concatenate([[0.0], np.cumsum(np.where(T > 4.0, sideways, 0.0)[1:] * np.diff(T))])
    robot = Track(x=walks * T, y=np.minimum(y, gap + 0.1) - REACH - gap)
    comes = np.maximum(-gap - 0.02, -0.5 * np.maximum(0.0, T - 4.0)) if not fault else ZERO
    case = Case(name="", told="", fault=fault, rule="", shown=(), robot=robot,
                people=(Track(x=walks * T, y=comes),))  # fmt: skip
    assert first_is_at_fault(case.run()) is fault


@pytest.mark.parametrize("rate", [0.0, 0.4, 1.0])
def test_who_brakes_does_not_come_over(rate: float) -> None:
    """Without its braking the robot would have passed before the person, who meets its front."""
    x = np.concatenate([[0.0], np.cumsum(np.clip(0.6 - rate * (T[1:] - 3.0), 0.0, 0.6) / 16.0)])
    person = Track(x=np.interp(4.0, T, x) + 0.25 + ZERO, y=3.0 * (4.0 - T) + 0.2)
    case = Case(name="", told="", fault=False, rule="", shown=(), robot=Track(x=x, y=ZERO),
                people=(person,))  # fmt: skip
    found = person_contacts(case.run(), 10.0, 1e-9, 0.05)
    assert len(found)
    assert not swerved(case.run(), found, USUAL_RULE, 10.0).any()
