"""What a robot knows of its person: told or tracked, with errors, and never the truth."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.core.assistance.finder import KnownPerson, PersonSight, ToldFinder, _nearest
from crowdbot.core.assistance.target import Target
from crowdbot.core.sensing.tracking.people_tracker import Tracks
from crowdbot.core.types.motion import Pose
from crowdbot.dsl.scenario.person_goals import ApproachGoal, WhichPerson

GOAL = ApproachGoal(person=WhichPerson(agent=0), knows="told")
EXACT = GOAL.model_copy(update={"position_error": 0.0, "heading_error": 0.0})


def target(goal: ApproachGoal) -> Target:
    one = np.array([0])
    at = {"x": np.array([5.0]), "y": np.array([1.0]), "heading": np.array([0.5])}
    return Target(goal=goal, rows=one, id=one, radius=np.array([0.25]), **at)


def sight(t: float, pose: Pose, relative: tuple[float, ...]) -> PersonSight:
    return PersonSight(
        t=t, pose=pose, twist=(0.0, 0.0), vy=0.0, readings={}, relative=np.array([relative])
    )


def tracks(*at: tuple[float, float, float], vx: float = 0.0) -> Tracks:
    rows = np.array(at).reshape(-1, 3)
    none = np.zeros(len(rows))
    velocity = np.column_stack([none + vx, none])
    return Tracks(rows[:, 0], rows[:, 1:], velocity, none, none)


def test_the_pose_at_the_start_has_the_stated_errors() -> None:
    found = [ToldFinder(target(GOAL), np.random.default_rng(k)).members[0] for k in range(400)]
    assert np.std([m.x for m in found]) == pytest.approx(0.15, rel=0.1)
    assert np.std([m.heading for m in found]) == pytest.approx(math.radians(10.0), rel=0.1)
    assert np.mean([m.y for m in found]) == pytest.approx(1.0, abs=0.03)


def test_what_is_told_is_relative_to_the_robot_wherever_odometry_has_it() -> None:
    finder = ToldFinder(target(EXACT), np.random.default_rng(0))
    finder.update(sight(0.5, Pose(10.0, 0.0, math.pi / 2), (2.0, 0.0, 0.0, 0.0, 0.0)))
    member = finder.members[0]
    assert (member.x, member.y, member.heading) == pytest.approx((10.0, 2.0, math.pi / 2))
    finder.update(sight(0.6, Pose(0.0, 0.0, 0.0), (7.0, 0.0, 0.0, 0.0, 0.0)))
    assert member.y == pytest.approx(2.0)  # nothing is told between quarters of seconds
    finder.update(sight(0.75, Pose(0.0, 0.0, 0.0), (math.nan,) * 5))
    assert (member.y, member.seen) == pytest.approx((2.0, 0.5))  # no one is there


def test_a_track_near_the_person_is_taken_and_no_other() -> None:
    person = KnownPerson(5.0, 1.0, 0.0)
    assert _nearest(person, 0.0, tracks((4, 5.3, 1.0), (9, 5.1, 1.0)), set()) == 9
    assert _nearest(person, 0.0, tracks((4, 5.3, 1.0), (9, 5.1, 1.0)), {9}) == 4
    assert _nearest(person, 5.0, tracks((4, 5.7, 1.0)), set()) == -1
    assert _nearest(person, 0.0, tracks(), set()) == -1


def test_one_who_walks_is_looked_for_further_on_and_in_a_wider_circle() -> None:
    person = KnownPerson(5.0, 1.0, 0.0, vx=1.0, seen=0.0)
    assert _nearest(person, 1.0, tracks((4, 6.9, 1.0)), set()) == 4
    assert _nearest(person, 1.0, tracks((4, 4.0, 1.0)), set()) == -1


def test_one_of_another_speed_is_another_person() -> None:
    person = KnownPerson(5.0, 1.0, 0.0, vx=0.3, moved=True)
    assert _nearest(person, 0.0, tracks((4, 5.0, 1.0), vx=1.3), set()) == -1
    assert _nearest(person, 0.0, tracks((4, 5.0, 1.0), vx=0.6), set()) == 4
    assert _nearest(person, 0.5, tracks((4, 5.0, 1.0), vx=1.3), set()) == 4  # it may have sped up
    unknown = KnownPerson(5.0, 1.0, 0.0)
    assert _nearest(unknown, 0.0, tracks((4, 5.0, 1.0), vx=1.3), set()) == 4
