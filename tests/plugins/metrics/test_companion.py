"""Metrics of tasks about people: hand-computed values, and who is told from whom."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import crowdbot
from crowdbot.core.types.person_task import PersonTask, PersonTaskKind, TaskPerson
from crowdbot.core.types.score import Score

T = np.linspace(0.0, 40.0, 641)
NAMES = (
    "assisted", "time_in_place", "time_to_place", "person_distance_error", "person_angle_error",
    "person_comfort",
)  # fmt: skip


def drive(
    kind: PersonTaskKind, x: Any, walker: Any, *, done: bool = False, **more: Any
) -> crowdbot.Trajectories:
    """A robot at ``x`` (N,) that looks ahead, and a person at ``walker`` (N,) who faces east."""
    zero = np.zeros(len(T))
    task = PersonTask(
        kind=kind, distance=1.2, tolerance=0.6, angle=math.radians(60.0), hold=20.0, radius=0.25
    )
    return crowdbot.Trajectories.from_arrays(
        t=T, robot_x=zero + x, robot_y=zero, robot_theta=zero, robot_radius=0.25,
        robot_mass=30.0, robot_goal_time=40.0 if done else None,
        agent_x=(zero + walker)[:, None], agent_y=zero[:, None], agent_radius=0.25,
        agent_mass=70.0,
        person=TaskPerson(task=task, id=np.array([0]), facing=np.array([more.get("facing", 0.0)])),
    )  # fmt: skip


def found(run: crowdbot.Trajectories) -> dict[str, Score]:
    scores = crowdbot.score(run, metrics=list(NAMES))
    return {s.metric: s for s in scores if s.variant == "corrected"}


WALK = 4.0 + 0.4 * T


def test_a_good_companion_is_told_from_bad_ones() -> None:
    good = found(drive("follow", WALK - 1.7, WALK, done=True))
    stands = found(drive("follow", 0.0, WALK))
    near = found(drive("follow", WALK - 0.8, WALK))
    bumps = found(drive("follow", np.where((T > 20.0) & (T < 20.2), WALK - 0.45, WALK - 1.7), WALK))
    assert [good[n].value for n in NAMES] == pytest.approx([1, 1, 0, 0, 0, 1], abs=1e-9)
    assert (stands["assisted"].value, stands["time_in_place"].value) == (0.0, 0.0)
    assert (stands["time_to_place"].status, stands["time_to_place"].lower) == ("censored", 40.0)
    assert stands["person_distance_error"].value == pytest.approx(2.3 + 8.0, abs=1e-6)
    assert near["time_in_place"].value == 0.0  # 0.3 m from the back
    assert near["person_distance_error"].value == pytest.approx(0.9)
    assert near["person_comfort"].value == pytest.approx(2.0 / 3.0, abs=1e-9)
    assert bumps["assisted"].value == 0.0
    comfort = bumps["person_comfort"].value
    assert comfort is not None
    assert comfort <= 0.5


def test_an_approach_counts_its_end_and_a_robot_that_rushes_in_is_felt() -> None:
    def approach(speed: float) -> dict[str, Score]:
        x = np.minimum(speed * T, 4.0)
        return found(drive("approach", x, 5.7, facing=math.pi, done=True))

    slow, fast = approach(0.5), approach(4.0)
    for one in (slow, fast):
        assert one["person_distance_error"].value == pytest.approx(0.0, abs=0.05)
        assert one["person_angle_error"].value == pytest.approx(0.0)
        assert one["assisted"].value == 1.0
    assert slow["time_to_place"].value == pytest.approx(3.4 / 0.5, abs=0.1)
    assert slow["person_comfort"].value == pytest.approx(1.0)
    assert (fast["person_comfort"].value or 0.0) < 0.8
    behind = found(drive("approach", np.minimum(0.5 * T, 4.0), 5.7, facing=0.0))
    assert behind["time_in_place"].value == 0.0
    assert behind["person_angle_error"].value == pytest.approx(math.pi)


def test_one_who_walks_into_a_robot_that_stands_is_not_rushed_at() -> None:
    walker = np.maximum(10.0 - T, 1.0)
    still = found(drive("approach", 0.0, walker, facing=math.pi))
    assert still["person_comfort"].value == 1.0


def test_without_a_person_they_are_scored_only_by_name() -> None:
    whole = drive("follow", WALK - 1.7, WALK)
    names = {s.metric for s in crowdbot.score(whole)}
    assert set(NAMES) <= names
    plain = crowdbot.Trajectories.from_arrays(
        t=T, robot_x=T, robot_y=0 * T, robot_theta=0 * T, robot_radius=0.2, robot_mass=30.0
    )
    assert not set(NAMES) & {s.metric for s in crowdbot.score(plain)}
    (score,) = crowdbot.score(plain, metrics="person_comfort")
    assert (score.status, score.reason) == ("undefined", "invalid_no_person")
