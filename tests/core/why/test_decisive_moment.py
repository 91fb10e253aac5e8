"""The decisive moment of made-up runs, one for each cause."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from crowdbot.core.runs.record_parts import EndedPart
from crowdbot.core.trajectories.fault.driven_aside import driven_aside
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.ending import Ending
from crowdbot.core.why.causes import DECIDING, Cause
from crowdbot.core.why.decisive_moment import ASIDE, DecisiveMoment, decisive_moment
from crowdbot.core.why.sentences import what_happened, why_late
from crowdbot.core.why.strip import BEFORE, strip
from tests.plugins.metrics.scenes import Body, grid, line, polyline, scene, scores_of

T = grid(10, 1 / 16)
FAR = (10.0, 0.0)


def drive(speed: float, *people: Body, **more: Any) -> Trajectories:
    """Along x for 10 s to a goal 10 m away."""
    arrival = 10.0 / speed if speed >= 1.0 else None
    robot = line(T, (0, 0), (speed, 0))
    return scene(T, robot, people, goal_time=arrival, robot_goal=FAR, **more)


def ended(status: str = "timeout", **more: Any) -> EndedPart:
    given = {"reason": "", "goal_time": None, "sim_time": 10.0, **more}
    return EndedPart.model_validate({"status": status, **given})


def contact(t: float, agent: int) -> dict[str, Any]:
    one = np.ones(1)
    return {
        "t0": [t], "t1": [t + 0.1], "agent": np.array([agent]), "bearing": [0.0],
        "impulse": one, "peak_force": one, "relative_speed": one,
    }  # fmt: skip


def jump_aside() -> Body:
    """Stand in the way, and flee ahead and to the left at the last moment, at 3 m/s² each."""
    since = np.clip(T - 4.3, 0.0, 1.0)
    way = 1.5 * since**2 + 3.0 * np.clip(T - 5.3, 0.0, None)
    return Body(5.0 + way, way, 3.0 * since, 3.0 * since)


AHEAD = line(T, (3, 0), (0, 0))
CASES = {
    Cause.RAN_INTO: (drive(0.5, AHEAD), ended(), 0),
    Cause.WALL: (drive(0.5, line(T, (3, 5), (0, 0)), contacts=contact(4.0, -1)), ended(), None),
    Cause.BLOCKED: (drive(0.0, line(T, (2, 0), (0, 0))), ended(), 0),
    Cause.SLOW: (drive(0.4, line(T, (3, 3), (0, 0))), ended(), 0),
    Cause.STRUCK: (drive(1.0, line(T, (-3, 0), (1.5, 0))), ended("arrived", goal_time=10.0), 0),
    Cause.CLOSE: (drive(1.0, line(T, (5, 2), (0, 0))), ended("arrived", goal_time=10.0), 0),
    Cause.ASIDE: (drive(1.0, jump_aside()), ended("arrived", goal_time=10.0), 0),
    Cause.ALONE: (drive(1.0), ended("arrived", goal_time=10.0), None),
    Ending.TOPPLED: (drive(0.5, AHEAD), ended("toppled", toppled_time=5.5), 0),
    Ending.PLANNER_FAILED: (drive(0.5, line(T, (3, 3), (0, 0))), ended("planner_failed"), None),
}


def moment(cause: Ending | Cause) -> DecisiveMoment:
    run, how, _ = CASES[cause]
    return decisive_moment(run, how)


@pytest.mark.parametrize("cause", CASES)
def test_each_cause_is_found_with_the_person_involved(cause: Ending | Cause) -> None:
    found = moment(cause)
    assert (found.cause, found.agent) == (cause, CASES[cause][2])


def test_each_cause_has_a_case_and_a_word_of_its_own() -> None:
    assert set(Cause) <= set(CASES)
    assert len(set(map(str, DECIDING))) == len(DECIDING)


@pytest.mark.parametrize("ending", [e for e in DECIDING if isinstance(e, Ending)])
def test_an_ending_that_says_what_happened_is_the_cause(ending: Ending) -> None:
    run = drive(0.5, line(T, (3, 3), (0, 0)))
    found = decisive_moment(run, ended(ending))
    assert (found.cause, found.t) == (ending, float(run.t[-1]))
    assert what_happened(run, found)[0] == f"10.0 s: {ending.happened}"


def test_the_moment_is_when_it_began() -> None:
    assert moment(Cause.RAN_INTO).t == pytest.approx(4.9, abs=0.8)  # discs touch before 6 s
    assert moment(Cause.WALL).t == 4.0
    assert moment(Cause.BLOCKED).t == 0.0
    assert moment(Cause.BLOCKED).stood == pytest.approx(10.0, abs=0.1)
    assert moment(Ending.TOPPLED).t == 5.5
    assert moment(Cause.CLOSE).t == pytest.approx(5.0, abs=0.07)


def test_who_is_driven_aside_halves_the_score() -> None:
    run, found = replace(CASES[Cause.ASIDE][0], robot_speed_limit=1.0), moment(Cause.ASIDE)
    assert 4.3 < found.t < 5.0
    halved = scores_of("safe_efficiency", run)["corrected"]
    assert halved.extras["driven_aside"] == 1.0
    times = driven_aside(run, jump_speed=10.0, **ASIDE)
    assert times.tolist() == [found.t]


def test_why_time_was_up_is_told_after_a_contact() -> None:
    stands = scene(T, polyline(T, [(0, 0, 0), (3, 3, 0), (10, 3, 0)]), (AHEAD,), robot_goal=FAR)
    assert decisive_moment(stands, ended()).cause == Cause.RAN_INTO
    assert re.fullmatch(r"it stood for [67]\.\d s from [23]\.\d s on", why_late(stands))
    assert why_late(CASES[Cause.SLOW][0]) == "it moved until time was up"


@pytest.mark.parametrize("cause", CASES)
def test_words_and_pictures_of_each(cause: Ending | Cause) -> None:
    run, found = CASES[cause][0], moment(cause)
    values = what_happened(run, found)
    assert values[0].startswith(f"{found.t:.1f} s: ")
    assert any(s.startswith("person 0") for s in values) == (found.agent is not None)
    pictures = strip(run, found)
    assert len(pictures) == sum(found.t - b >= 0.0 for b in BEFORE)
    assert all(p.shapes for p in pictures)


def test_no_number_is_a_negative_zero() -> None:
    robot, person = line(T, (0, -0.01), (0.5, -0.0001)), line(T, (3, 3), (0, 0))
    run = scene(T, robot, (person,), robot_goal=FAR)
    text = "\n".join(what_happened(run, decisive_moment(run, ended())))
    assert re.search(r"the robot at \(\d\.\d, 0\.0\) drove at", text), text
    assert re.search(r"turned at 0 °/s", text), text


def test_words_name_side_gap_and_speed() -> None:
    text = "\n".join(what_happened(CASES[Cause.CLOSE][0], moment(Cause.CLOSE)))
    assert "stood, left of the robot" in text
    place = r"\(-?\d+\.\d, -?\d+\.\d\)"
    assert re.search(rf"the robot at {place} drove at 1\.00 m/s and turned at 0 °/s", text)
