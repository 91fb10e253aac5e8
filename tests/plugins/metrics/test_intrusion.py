"""intrusion: hand cases, failures, and who would be fooled."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.trajectories.trajectories import Trajectories
from tests.plugins.metrics.scenes import REACH, grid, line, scene, scores_of, value_of, why

T = grid(10, 1 / 16)


def following(gap: float, speed: float = 0.5) -> Trajectories:
    """Behind somebody, on the same line, for 10 s."""
    person = line(T, (REACH + gap, 0), (speed, 0))
    return scene(T, line(T, (0, 0), (speed, 0)), [person])


def intrusion(run: Trajectories, **fields: Any) -> float:
    return value_of(scores_of("intrusion", run, **fields))


def test_who_follows_closely_intrudes_without_touching_or_pushing() -> None:
    run = following(0.3)
    assert intrusion(run) == pytest.approx(5.0)
    assert value_of(scores_of("push_work", run)) == 0
    assert value_of(scores_of("collision_count", run)) == 0
    assert intrusion(following(0.6)) == 0
    assert intrusion(following(0.6), compliance="80 cm") == pytest.approx(5.0)


def test_who_waits_or_drives_away_does_not_intrude() -> None:
    """`space_compliance` blames both for whom they let pass."""
    close = line(T, (0.6, 0), (0, 0))
    waits = scene(T, line(T, (0, 0), (0, 0)), [close])
    assert intrusion(waits) == 0
    assert value_of(scores_of("space_compliance", waits)) == 0
    leaves = scene(T, line(T, (0, 0), (-0.02, 0)), [close])
    assert intrusion(leaves) == 0


def test_only_the_way_towards_somebody_counts() -> None:
    """Passing at a right angle: what is ahead of the person counts, what is behind does not."""
    run = scene(T, line(T, (-2.5, 0.6), (0.5, 0)), [line(T, (0, 0), (0, 0))])
    ahead = ((REACH + 0.5) ** 2 - 0.6**2) ** 0.5
    expected = REACH + 0.5 - 0.6  # V . n dt is how much nearer it comes
    assert intrusion(run) == pytest.approx(expected, rel=0.05)
    assert expected < ahead


def test_it_is_per_person_met() -> None:
    person = line(T, (REACH + 0.3, 0), (0.5, 0))
    beside = line(T, (0, 1.5), (0.5, 0))
    both = scene(T, line(T, (0, 0), (0.5, 0)), [person, beside])
    assert intrusion(both) == pytest.approx(2.5)
    assert value_of(scores_of("intrusion", both), "total") == pytest.approx(5.0)


@given(speed=st.floats(0.1, 2.0))
@settings(max_examples=20)
def test_it_is_a_way_and_no_time(speed: float) -> None:
    assert intrusion(following(0.3, speed)) == pytest.approx(10 * speed)


def rated(run: Trajectories) -> float:
    return value_of(scores_of("intrusion", run), "hurried")


def lacking(run: Trajectories) -> float:
    return value_of(scores_of("intrusion", run), "rate")


def towards(gap: float, speed: float, way: float = 20.0) -> Trajectories:
    """Following somebody, on the way to a goal."""
    person = line(T, (REACH + gap, 0), (speed, 0))
    return scene(T, line(T, (0, 0), (speed, 0)), [person], robot_goal=(way, 0.0))


@pytest.mark.parametrize(
    ("gap", "speed", "rate"),
    [
        (0.3, 0.5, 1.0),  # 0.6 s behind
        (0.3, 0.25, 0.0),  # 1.2 s: the slower, the nearer one may be
        (0.9, 1.0, 1.0),  # 0.9 s: more than half a metre is little for who is fast
        (1.1, 1.0, 0.0),
    ],
)
def test_hurried_asks_for_time_and_not_for_room(gap: float, speed: float, rate: float) -> None:
    assert rated(towards(gap, speed)) == pytest.approx(rate)


def test_the_rate_is_per_way_made_good() -> None:
    """Back and forth behind somebody: as much intrusion on less way."""
    straight = rated(towards(0.3, 0.5))
    aside = scene(
        T, line(T, (0, 0), (0.5, 0)), [line(T, (REACH + 0.3, 0), (0.5, 0))], robot_goal=(13.0, 50.0)
    )
    assert rated(aside) > 4 * straight  # 1.02 m are progress
    progress = math.hypot(13.0, 50.0) - math.hypot(8.0, 50.0)
    assert value_of(scores_of("intrusion", aside), "way") == pytest.approx(progress)


def test_who_stays_has_no_rate_and_who_passes_at_a_distance_has_a_good_one() -> None:
    close = line(T, (0.6, 0), (0, 0))
    stays = scene(T, line(T, (0, 0), (0, 0)), [close], robot_goal=(5.0, 0.0))
    assert why(scores_of("intrusion", stays)) >= {("undefined", "zero_denominator")}
    passes = scene(
        T, line(T, (0, 0), (0.5, 0)), [line(T, (2, 0.7), (0, 0))], robot_goal=(20.0, 0.0)
    )
    assert rated(passes) == 0.0


@pytest.mark.parametrize(("gap", "rate"), [(0.0, 1.0), (0.3, 0.6), (0.6, 0.2), (0.8, 0.0)])
def test_the_rate_weighs_the_way_by_what_is_missing_of_the_room(gap: float, rate: float) -> None:
    for speed in (0.25, 1.0):
        assert lacking(towards(gap, speed)) == pytest.approx(rate)


def test_the_rate_blames_neither_who_waits_nor_who_leaves() -> None:
    close = line(T, (0.6, 0), (0, 0))
    leaves = scene(T, line(T, (0, 0), (-0.2, 0)), [close], robot_goal=(-5.0, 0.0))
    assert lacking(leaves) == 0.0
    waits = line(T, (0, 0), (0, 0))
    assert why(scores_of("intrusion", scene(T, waits, [close], robot_goal=(5.0, 0.0)))) >= {
        ("undefined", "zero_denominator")
    }


def test_without_a_goal_there_is_no_rate() -> None:
    found = scores_of("intrusion", following(0.3))
    assert {found[v].reason for v in ("rate", "hurried", "way")} == {"invalid_no_goal"}
    assert value_of(found) == pytest.approx(5.0)


def test_failures() -> None:
    robot, far = line(T, (0, 0), (1, 0)), line(T, (0, 50), (1, 0))
    assert why(scores_of("intrusion", scene(T, None, [far]))) == {("undefined", "invalid_no_robot")}
    assert why(scores_of("intrusion", scene(T, robot))) == {("undefined", "no_agents")}
    assert why(scores_of("intrusion", scene(T, robot, [far]))) == {("undefined", "no_neighbours")}


def test_without_progress_there_is_no_rate_whatever_the_cost() -> None:
    """5 m towards somebody, and 0.25 m nearer to a goal far to the side."""
    person = line(T, (REACH + 0.3, 0), (0.5, 0))
    run = scene(T, line(T, (0, 0), (0.5, 0)), [person], robot_goal=(0.0, 50.0))
    for metric in ("intrusion", "push_work"):
        found = scores_of(metric, run)["rate"]
        assert (found.status, found.reason) == ("undefined", "zero_denominator")
        assert value_of(scores_of(metric, run), "way") == 1.0
