"""displacement, delay: planted effects are recovered, and nothing else is."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.trajectories.paired_people import WINDOW
from crowdbot.core.trajectories.path_overlay import follow, longest_parts
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.score import Score
from tests.plugins.metrics.scenes import Array, scores_of, value_of, why

T = np.arange(0.0, 60.0 + 1e-9, 1 / 16)
LENGTH = 30.0
SPEEDS = np.linspace(0.8, 1.6, 40)


def crowd(late: Array, aside: Array, *, t: Array = T, robot: bool = True) -> Trajectories:
    """Forty people who walk ``LENGTH`` and then leave; a robot stands where they start.

    ``late`` (s): each waits so long after a third of his way. ``aside`` (m): a bow around halfway.
    """
    duration = LENGTH / SPEEDS + late
    stop = LENGTH / 3 / SPEEDS
    moving = t[:, None] - np.clip(t[:, None] - stop, 0.0, late)
    x = SPEEDS * moving
    y = np.arange(40.0) + aside * np.exp(-(((x - LENGTH / 2) / 2) ** 2))
    here = t[:, None] <= duration
    reached = duration <= t[-1]
    given: dict[str, Any] = {}
    if robot:
        zero = np.zeros(len(t))
        names = ("x", "y", "theta", "v", "w")
        given = {f"robot_{n}": zero for n in names} | {"robot_radius": 0.2, "robot_mass": 6.3}
    return Trajectories.from_arrays(
        t=t,
        agent_x=np.where(here, x, np.nan),
        agent_y=np.where(here, y, np.nan),
        agent_radius=0.25,
        agent_mass=70.0,
        trip_agent=np.arange(40),
        trip_t0=np.zeros(40),
        trip_t1=np.minimum(duration, t[-1]),
        trip_reached=reached,
        **given,
    )


def one(value: float, who: int = 7) -> Array:
    found = np.zeros(40)
    found[who] = value
    return found


NOBODY = np.zeros(40)
ALONE = crowd(NOBODY, NOBODY, robot=False)


def scores(
    metric: str, run: Trajectories, alone: Trajectories = ALONE, **fields: Any
) -> dict[str, Score]:
    """Everybody meets the robot all the time, unless ``fields`` say otherwise."""
    return scores_of(metric, run, None, alone, **{"neighbour_radius": "300 m", **fields})


def delays(run: Trajectories, alone: Trajectories = ALONE, **fields: Any) -> dict[str, Score]:
    return scores("delay", run, alone, **fields)


def test_half_a_second_of_one_person_is_recovered() -> None:
    found = delays(crowd(one(0.5), NOBODY))
    assert value_of(found) * 40 == pytest.approx(0.5, abs=0.05)
    assert value_of(found, "whole") * 40 == pytest.approx(0.5, abs=0.05)
    assert value_of(found, "worst") * 2 == pytest.approx(0.5, abs=0.05)  # of forty, two
    assert value_of(delays(crowd(one(0.55), NOBODY)), "count") == 1
    assert value_of(delays(crowd(one(0.45), NOBODY)), "count") == 0
    assert value_of(scores("displacement", crowd(one(0.5), NOBODY))) == (pytest.approx(0, abs=1e-9))


def test_half_a_second_is_recovered_before_the_trip_ends() -> None:
    """The record ends when nobody has arrived: the lag on the way tells."""
    early = T[T <= 16.0]
    found = delays(crowd(one(0.5, 30), NOBODY, t=early))
    assert value_of(found) * 40 == pytest.approx(0.5, abs=0.05)
    cut = delays(crowd(one(0.5, 30), NOBODY), crowd(NOBODY, NOBODY, t=early, robot=False))
    assert value_of(cut, "whole") * 40 == pytest.approx(0.5, abs=0.05)


def test_who_is_pushed_aside_is_displaced_and_hardly_delayed() -> None:
    found = scores("displacement", crowd(NOBODY, one(0.75)))
    assert value_of(found) * 40 == pytest.approx(0.75, abs=0.01)
    assert value_of(found, "count") == 1
    assert value_of(found, "worst") * 2 == pytest.approx(0.75, abs=0.01)
    assert value_of(delays(crowd(NOBODY, one(0.75)))) == pytest.approx(0, abs=1e-9)


def test_a_robot_that_meets_nobody_changes_nobody_by_a_bit() -> None:
    run = crowd(NOBODY, NOBODY)
    for metric in ("displacement", "delay"):
        found = scores(metric, run)
        for variant in ("corrected", "worst", "count", "whole"):
            assert found[variant].value == 0
        assert found["slope"].value == pytest.approx(0, abs=1e-12)


def test_who_pays() -> None:
    """0.5 s for each m/s: the slope says so; if all pay alike, it is 0."""
    assert value_of(delays(crowd(0.5 * SPEEDS, NOBODY)), "slope") == pytest.approx(0.5, rel=1e-6)
    assert value_of(delays(crowd(NOBODY + 0.5, NOBODY)), "slope") == pytest.approx(0, abs=1e-6)


def test_people_are_matched_by_id_and_not_by_column() -> None:
    run = crowd(one(0.5), NOBODY)
    assert run.agents is not None
    back = slice(None, None, -1)
    rows = {n: getattr(run.agents, n)[:, back] for n in ("x", "y", "vx", "vy")}
    turned = dataclasses.replace(run.agents, **rows, id=run.agents.id[back])
    again = delays(dataclasses.replace(run, agents=turned))
    assert value_of(again) == pytest.approx(value_of(delays(run)))


def test_trips_that_begin_elsewhere_are_not_compared() -> None:
    run = crowd(NOBODY, NOBODY)
    assert run.agents is not None
    y = run.agents.y + 0.2
    moved = dataclasses.replace(run, agents=dataclasses.replace(run.agents, y=y))
    assert why(delays(moved)) == {("undefined", "no_trips"), ("undefined", "no_neighbours")}
    found = delays(moved, same_start="30 cm")
    assert found["corrected"].extras == {"people": 40.0, "left_out": 0.0}


def test_failures() -> None:
    assert why(scores_of("delay", ALONE)) == {("undefined", "no_reference")}
    bare = dataclasses.replace(ALONE, trips=None)
    assert why(delays(bare)) == {("undefined", "no_trips")}
    found = delays(ALONE)
    assert found["corrected"].reason == "invalid_no_robot"
    assert found["whole"].value == 0


# ------------------------------------------------------------------------- meetings
def meeting(late: Array, aside: Array, place: float, who: int = 7, **fields: Any) -> Trajectories:
    """A robot that stands 1 m beside one person's way."""
    run = crowd(late, aside, **fields)
    assert run.robot is not None
    here = dataclasses.replace(run.robot, x=run.t * 0 + place, y=run.t * 0 + who + 0.4)
    return dataclasses.replace(run, robot=here)


def test_only_who_meets_the_robot_is_compared() -> None:
    """Two people wait; one of them where the robot stands, the other elsewhere."""
    run = meeting(one(0.5) + one(2.0, 30), NOBODY, LENGTH / 3)
    found = scores("delay", run, neighbour_radius="50 cm")
    assert found["corrected"].extras == {"people": 1.0, "left_out": 0.0}
    assert value_of(found) == pytest.approx(0.5, abs=0.05)
    assert value_of(found, "whole") * 40 == pytest.approx(2.5, abs=0.1)


def test_who_was_disturbed_before_he_met_the_robot_says_nothing_of_it() -> None:
    """He waited long before; or walks beside his way already."""
    for run in (meeting(one(0.5), NOBODY, 25.0), meeting(NOBODY, one(0.3), LENGTH / 2)):
        found = scores("delay", run, neighbour_radius="50 cm")
        assert found["corrected"].reason == "no_neighbours"
    fine = scores("delay", meeting(one(0.05), NOBODY, 25.0), neighbour_radius="50 cm")
    assert fine["corrected"].extras["people"] == 1.0


def test_what_happens_after_the_meeting_is_not_the_robots_doing() -> None:
    """He waits, but far behind the robot."""
    early = meeting(one(0.5), NOBODY, 2.0)
    assert value_of(scores("delay", early, neighbour_radius="50 cm")) == pytest.approx(0, abs=1e-6)
    later = scores("delay", early, neighbour_radius="50 cm", after_meeting="30 s")
    assert value_of(later) == pytest.approx(0.5, abs=0.05)


@given(wait=st.floats(0.0, 5.0), who=st.integers(0, 39))
@settings(max_examples=20)
def test_every_wait_is_recovered(wait: float, who: int) -> None:
    assert value_of(delays(crowd(one(wait, who), NOBODY))) * 40 == pytest.approx(wait, abs=0.05)


@given(bow=st.floats(-3.0, 3.0), who=st.integers(0, 39))
@settings(max_examples=20)
def test_every_bow_is_recovered(bow: float, who: int) -> None:
    found = scores("displacement", crowd(NOBODY, one(bow, who)))
    assert value_of(found) * 40 == pytest.approx(abs(bow), abs=0.02)


def _followed(one: Array, other: Array) -> tuple[list[float], list[float]]:
    """As `follow`, but every segment of the window is looked at."""
    at, beside, late = 0, [], []
    for x, y, t in one.T:
        best, near, behind = np.inf, at, 0.0
        for s in range(max(0, at - WINDOW), min(other.shape[1] - 1, at + WINDOW + 1)):
            (wx, wy, wt), (ex, ey, et) = other[:, s], other[:, s + 1] - other[:, s]
            px, py, square = x - wx, y - wy, ex * ex + ey * ey
            u = (px * ex + py * ey) / square if square > 0.0 else 0.0
            u = min(max(u, -1.0 if s == 0 else 0.0), 2.0 if s == other.shape[1] - 2 else 1.0)
            apart = (px - u * ex) ** 2 + (py - u * ey) ** 2
            lag = t - wt - u * et
            if apart < best - 1e-18 or (apart <= best + 1e-18 and abs(lag) < abs(behind)):
                best, near, behind = min(apart, best), s, lag
        at = near
        beside.append(np.sqrt(best))
        late.append(behind)
    return beside, late


@pytest.mark.parametrize("seed", range(6))
def test_segments_that_are_far_away_may_be_left_out(seed: int) -> None:
    """Ways that wind, wait, cross themselves, and lie apart."""
    random = np.random.default_rng(seed)
    ways = []
    for count in (150, 180):
        moves = random.choice([0.0, 0.05, 0.1, 0.3], count) * (seed != 5 or count == 150)
        turns = np.cumsum(random.normal(0.0, 0.3, count))
        x, y = np.cumsum(moves * np.cos(turns)), np.cumsum(moves * np.sin(turns))
        ways.append(np.stack([np.round(x, 2), np.round(y, 2), np.arange(count) / 16.0]))
    beside, late = np.empty(150), np.empty(150)
    follow(ways[0], ways[1], WINDOW, beside, late)
    expected = _followed(*ways)
    np.testing.assert_allclose(beside, expected[0], rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(late, expected[1], rtol=1e-12, atol=1e-12)


def test_of_a_trip_its_longest_part_is_compared() -> None:
    """Of equally long ones the first; of somebody without a column, and of no sample, none."""
    valid = np.ones((9, 2), np.bool_)
    valid[[2, 5], 1] = False  # samples 0 to 2, 3 to 5, 6 to 9
    first, last = np.array([0, 0, 0, 4, 7]), np.array([9, 9, 5, 3, 9])
    column = np.array([0, 1, 1, 0, -1])
    parts = np.zeros((5, 3), np.int64)
    longest_parts(valid, first, last, column, parts)
    assert parts[:, 1].tolist() == [10, 10, 3, 0, 0]
    assert parts[:, 0].tolist() == [0, 6, 0, 0, 0]
