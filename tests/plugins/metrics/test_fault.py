"""contacts_at_fault, contacts_per_km, safe_efficiency: hand cases, failures, adversaries."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.trajectories.trajectories import Trajectories
from tests.plugins.metrics.scenes import (
    Body,
    grid,
    line,
    random_scene,
    scene,
    scores_of,
    value_of,
    why,
)

T = grid(10, 1 / 16)
GOAL: dict[str, Any] = {"robot_goal": (10.0, 0.0), "robot_speed_limit": 1.0}


def table(*rows: tuple[float, float, int, float]) -> dict[str, Any]:
    """Onset, end, person, bearing."""
    t0, t1, agent, bearing = zip(*rows, strict=True) if rows else ((), (), (), ())
    ones = np.ones(len(t0))
    return {
        "t0": t0, "t1": t1, "agent": np.array(agent, np.int64), "bearing": bearing,
        "impulse": ones, "peak_force": ones, "relative_speed": ones,
    }  # fmt: skip


def drive(speed: float, *people: Body, contacts: dict[str, Any] | None = None) -> Trajectories:
    """Along x for 10 s; it arrives if it makes the 10 m."""
    arrival = 10.0 / speed if speed >= 1.0 else None
    robot = line(T, (0, 0), (speed, 0))
    return scene(T, robot, people, goal_time=arrival, contacts=contacts, **GOAL)


def faults(run: Trajectories, **fields: Any) -> tuple[float, float]:
    found = scores_of("contacts_at_fault", run, **fields)
    return value_of(found), value_of(found, "person")


# -------------------------------------------------------------------- whose fault
def test_who_drives_into_somebody_is_at_fault() -> None:
    assert faults(drive(0.5, line(T, (3, 0), (0, 0)))) == (1, 0)


def test_a_blind_robot_in_counterflow_is_at_fault() -> None:
    """The person is faster, which excuses nobody; `collisions_at_fault` says otherwise."""
    run = drive(0.5, line(T, (6, 0), (-1.3, 0)))
    assert faults(run) == (1, 0)
    old = scores_of("collisions_at_fault", run)
    assert (old["robot"].value, old["person"].value) == (0, 1)


def test_who_stands_or_is_bumped_from_behind_is_not() -> None:
    assert faults(drive(0.0, line(T, (3, 0), (-1, 0)))) == (0, 1)
    assert faults(drive(0.5, line(T, (-3, 0), (1.5, 0)))) == (0, 1)


def test_creeping_is_standing() -> None:
    creeps = drive(0.04, line(T, (3, 0), (-1, 0)))
    assert faults(creeps) == (0, 1)
    assert faults(creeps, fault_speed="3 cm/s") == (1, 0)


def test_the_bearing_of_the_table_decides() -> None:
    far = line(T, (3, 9), (0, 0))
    for bearing, expected in ((0.0, (1, 0)), (np.pi, (0, 1)), (np.pi / 2, (0, 1)), (0.5, (1, 0))):
        assert faults(drive(0.5, far, contacts=table((2.0, 2.1, 0, bearing)))) == expected


def test_without_a_bearing_the_person_does_and_without_a_person_the_robot_is_at_fault() -> None:
    behind = line(T, (-0.43, 0), (0.5, 0))
    assert faults(drive(0.5, behind, contacts=table((2.0, 2.1, 0, np.nan)))) == (0, 1)
    assert faults(drive(0.5, behind, contacts=table((2.0, 2.1, 99, np.nan)))) == (1, 0)
    assert faults(drive(0.0, behind, contacts=table((2.0, 2.1, 99, np.nan)))) == (0, 1)


# ------------------------------------------------------------------------ the rate
def test_the_rate_per_way_made_good() -> None:
    found = scores_of("contacts_per_km", drive(0.5, line(T, (3, 0), (0, 0))))
    assert value_of(found) == pytest.approx(1000 / 5)
    assert value_of(found, "driven") == pytest.approx(1000 / 5)


def test_circles_do_not_lower_the_rate() -> None:
    """Nothing is gained by driving back and forth far from everybody."""
    x = np.interp(T, [0, 4, 5, 6, 7, 8, 10], [0, 4, 2, 4, 2, 4, 5])
    body = Body(x, np.zeros(len(T)), np.gradient(x, T), np.zeros(len(T)))
    found = scores_of(
        "contacts_per_km", scene(T, body, [], contacts=table((2, 2.1, 0, 0.0)), **GOAL)
    )
    assert value_of(found) == pytest.approx(1000 / 5)
    assert value_of(found, "driven") < 100


def test_nobody_escapes_by_staying() -> None:
    stays, touched = drive(0.0), drive(0.0, contacts=table((2.0, 2.1, 0, 0.0)))
    assert scores_of("contacts_per_km", stays)["corrected"].reason == "zero_denominator"
    assert value_of(scores_of("contacts_per_km", touched)) == 1000


def test_no_goal() -> None:
    run = scene(T, line(T, (0, 0), (1, 0)))
    found = scores_of("contacts_per_km", run)
    assert found["corrected"].reason == found["at_fault"].reason == "invalid_no_goal"
    assert value_of(found, "driven") == 0
    assert why(scores_of("safe_efficiency", run)) == {("undefined", "invalid_no_goal")}


# ------------------------------------------------------------------ safe efficiency
def efficiency(run: Trajectories) -> float:
    return value_of(scores_of("safe_efficiency", run))


def arriving(seconds: float, *people: Body, contacts: dict[str, Any] | None = None) -> Trajectories:
    t = grid(seconds, 1 / 16)
    robot = line(t, (0, 0), (10 / seconds, 0))
    return scene(t, robot, people, goal_time=seconds, contacts=contacts, **GOAL)


def test_full_speed_straight_on_is_one() -> None:
    assert efficiency(arriving(10.0)) == pytest.approx(1.0)


def test_half_speed_gains_nothing() -> None:
    """Against its own run alone it would lose nothing; the reference is everybody's."""
    slow = arriving(20.0)
    assert efficiency(slow) == pytest.approx(0.5)
    assert value_of(scores_of("relative_time_to_goal", slow, slow)) == 1.0


def test_parked_or_late_is_zero() -> None:
    assert efficiency(drive(0.0)) == 0
    assert efficiency(drive(0.9)) == 0


def test_a_bounce_of_30_ms_between_two_samples_counts() -> None:
    """No sample is in contact; the table has it."""
    aside = line(T, (3, 0.6), (0, 0))
    bounce = table((3.02, 3.05, 0, 0.4))
    samples, told = arriving(10.0, aside), arriving(10.0, aside, contacts=bounce)
    assert efficiency(samples) == 1.0
    assert efficiency(told) == 0.0
    assert scores_of("safe_efficiency", told)["corrected"].extras["contacts_at_fault"] == 1


def test_a_contact_that_is_somebody_elses_fault_costs_nothing() -> None:
    bumped = table((3.02, 3.05, 0, np.pi))
    assert efficiency(arriving(10.0, line(T, (3, 5), (0, 0)), contacts=bumped)) == 1.0


def test_contacts_after_the_arrival_do_not_count() -> None:
    run = drive(2.0, contacts=table((7.0, 7.1, 0, 0.0)))
    assert efficiency(run) == pytest.approx(1.0)  # never more, however fast


def test_what_is_needed() -> None:
    run = arriving(10.0)
    assert run.robot is not None
    unknown = dataclasses.replace(run, robot_speed_limit=None)
    assert why(scores_of("safe_efficiency", unknown)) == {("undefined", "invalid_no_speed_limit")}
    there = dataclasses.replace(run, robot=dataclasses.replace(run.robot, goal=(0.0, 0.0)))
    assert why(scores_of("safe_efficiency", there)) == {("undefined", "zero_denominator")}


@given(seed=st.integers(0, 2**32 - 1), slower=st.floats(1.0, 5.0))
@settings(max_examples=40, deadline=None)
def test_slowness_never_helps(seed: int, slower: float) -> None:
    """The same run on a slower clock is worth as much less as it is slower, or nothing."""
    run = random_scene(seed)
    assert run.robot is not None
    robot = dataclasses.replace(run.robot, goal=(30.0, 0.0))
    run = dataclasses.replace(run, robot=robot, robot_speed_limit=1.0)
    stretched = dataclasses.replace(
        robot,
        goal_time=None if robot.goal_time is None else robot.goal_time * slower,
        v=robot.v / slower,
        w=robot.w / slower,
    )
    again = dataclasses.replace(run, t=run.t * slower, robot=stretched, agents=None)
    first = dataclasses.replace(run, agents=None)
    assert efficiency(again) <= efficiency(first) + 1e-12
