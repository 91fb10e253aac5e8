"""push_work, evasive_acceleration: hand cases, failures, and who would be fooled."""

from __future__ import annotations

import dataclasses
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.trajectories.trajectories import Trajectories
from tests.plugins.metrics.scenes import (
    REACH,
    Array,
    Body,
    grid,
    line,
    random_scene,
    scene,
    scores_of,
    value_of,
    why,
)

T = grid(4, 1 / 16)
MASS = 70.0


def speeding_up(t: Array, start: float, speed: float, gain: float) -> Body:
    """Along x, from ``speed`` (m/s) on with the acceleration ``gain`` (m/s²)."""
    zero = np.zeros(len(t))
    return Body(start + speed * t + gain * t**2 / 2, zero, speed + gain * t, zero)


def pushed(robot_speed: float, gain: float) -> Trajectories:
    robot = line(T, (0, 0), (robot_speed, 0))
    return scene(T, robot, [speeding_up(T, 0.6, robot_speed, gain)], goal_time=4.0)


def without_robot(run: Trajectories, *people: Body) -> Trajectories:
    return scene(run.t, None, list(people))


def test_work_is_force_times_advance() -> None:
    found = scores_of("push_work", pushed(0.65, 0.1))
    assert value_of(found) == pytest.approx(MASS * 0.1 * 0.65 * 4)
    assert value_of(found, "total") == value_of(found)
    assert found["corrected"].extras == {"people_met": 1.0}


def test_work_is_per_person_met() -> None:
    run = pushed(0.65, 0.1)
    near, far = line(T, (0.6, 1.0), (0.65, 0)), line(T, (0.6, 9.0), (0.65, 0))
    both = scene(
        T, line(T, (0, 0), (0.65, 0)), [speeding_up(T, 0.6, 0.65, 0.1), near, far], goal_time=4.0
    )
    assert value_of(scores_of("push_work", both)) == pytest.approx(
        value_of(scores_of("push_work", run)) / 2
    )


def test_a_robot_that_pushes_without_touching_is_seen() -> None:
    """No contact, and no fault: the work tells it from a robot that waits."""
    pushes, waits = pushed(0.65, 0.1), pushed(0.0, 0.1)
    assert scores_of("collision_count", pushes)["corrected"].value == 0
    assert scores_of("contacts_at_fault", pushes)["corrected"].value == 0
    assert value_of(scores_of("push_work", pushes)) > 10
    assert value_of(scores_of("push_work", waits)) == 0


def forced(robot_speed: float, gap: float, gain: float) -> float:
    """The rate of a robot behind somebody who speeds up."""
    person = speeding_up(T, REACH + gap, robot_speed, gain)
    run = scene(T, line(T, (0, 0), (robot_speed, 0)), [person], robot_goal=(20.0, 0.0))
    return value_of(scores_of("push_work", run), "forced")


def demanded(room_left: float, speed: float = 0.8, wide: float = 0.0) -> float:
    """Return the rate of a robot that brakes to rest before a person who stands ``wide`` aside.

    It drives for 2 s and then stands, ``room_left`` short of the person.
    """
    t = grid(4, 1 / 128)
    x = speed * np.minimum(t, 2.0)
    robot = Body(x, 0 * t, np.where(t < 2.0, speed, 0.0), 0 * t)
    person = line(t, (2.0 * speed + REACH + room_left, wide), (0, 0))
    run = scene(t, robot, [person], robot_goal=(20.0, 0.0))
    return value_of(scores_of("push_work", run), "rate")


def test_the_demand_is_what_people_need_beyond_what_they_do_anyway() -> None:
    """Straight towards a person who stands: b = 2 s / t², s the reach and half a metre."""
    speed, left = 0.8, 0.3
    t = np.linspace(0.0, 2.0, 20001)
    until = (2.0 * speed + REACH + left - speed * t) / speed
    need = np.minimum(3.0, 2.0 * (REACH + 0.5) / np.maximum(until, 0.5) ** 2) * (until < 2.0)
    power = np.maximum(0.0, need - 0.5) * speed * MASS
    work = float(np.sum((power[1:] + power[:-1]) / 2.0 * np.diff(t)))
    assert demanded(left, speed) == pytest.approx(work / 1.6, rel=0.02)


def test_people_who_need_no_more_than_usual_are_no_burden() -> None:
    assert demanded(0.3, wide=REACH + 0.49) == 0.0  # 1 cm in a second or two
    assert demanded(0.3, wide=REACH + 0.1) > 0.0


def test_the_demand_grows_without_a_step_as_a_robot_comes_nearer() -> None:
    """A bully that brakes half a second before a person pays more than one that does so before."""
    rates = [demanded(room) for room in np.linspace(1.5, 0.05, 60)]
    assert all(a <= b + 1e-9 for a, b in pairwise(rates))
    assert max(np.diff(rates)) < 0.07 * max(rates)
    assert rates[0] == pytest.approx(0.0, abs=0.05 * max(rates))


def test_the_rate_is_work_on_those_who_had_to_make_way() -> None:
    """0.4 s behind somebody who speeds up just enough to stay ahead for the 4 s, a while."""
    found = forced(1.0, 0.4, 0.01)  # after 4 s 0.08 m farther: 0.48 s
    assert found == pytest.approx(MASS * 0.01 * 1.0 * 4 / 4.0, rel=1e-6)
    assert forced(1.0, 0.6, 0.01) == 0.0
    assert forced(0.5, 0.4, 0.01) == 0.0  # the slower robot leaves 0.8 s


def test_the_rate_of_who_waits_is_zero_and_of_who_stays_unknown() -> None:
    """People may do what they like around a robot that stands; parking wins nothing."""
    jumps = speeding_up(T, REACH + 0.05, 0.0, 2.0)
    parked = scene(T, line(T, (0, 0), (0, 0)), [jumps], robot_goal=(20.0, 0.0))
    assert scores_of("push_work", parked)["forced"].reason == "zero_denominator"
    later = np.where(T < 2.0, 0.0, T - 2.0)
    robot = Body(-later, 0 * T, np.where(T < 2.0, 0.0, -1.0), 0 * T)
    leaves = scene(T, robot, [jumps], robot_goal=(-20.0, 0.0))
    assert value_of(scores_of("push_work", leaves), "forced") == 0.0


def test_who_stops_in_time_has_forced_nobody() -> None:
    """Both come within 0.1 m of somebody who steps back; only one came fast."""
    steps_back = speeding_up(T, REACH + 2.1, 0.0, 0.05)
    fast = scene(T, line(T, (0, 0), (0.6, 0)), [steps_back], robot_goal=(20.0, 0.0))
    slows = 2.0 * (1 - np.exp(-T))
    careful = scene(
        T, Body(slows, 0 * T, 2.0 * np.exp(-T), 0 * T), [steps_back], robot_goal=(20.0, 0.0)
    )
    rates = [value_of(scores_of("push_work", run), "forced") for run in (fast, careful)]
    assert rates[1] == 0.0
    assert value_of(scores_of("push_work", careful)) > 0.0
    assert rates[0] > 0.0


def test_who_turns_towards_the_robot_is_not_pushed() -> None:
    robot = line(T, (0, 0), (0.5, 0))
    braking = speeding_up(T, 1.5, 0.6, -0.1)
    assert value_of(scores_of("push_work", scene(T, robot, [braking]))) == 0


def test_a_ghost_takes_off_what_happens_without_a_robot() -> None:
    """Somebody speeds up alike with and without the robot: it is blamed, but not in excess."""
    run = pushed(0.65, 0.1)
    alone = without_robot(run, speeding_up(T, 0.6, 0.65, 0.1))
    for metric in ("push_work", "evasive_acceleration"):
        found = scores_of(metric, run, None, alone)
        assert value_of(found) > 0
        assert value_of(found, "excess") == pytest.approx(0, abs=1e-9)
    calm = without_robot(run, line(T, (0.6, 0), (0.65, 0)))
    found = scores_of("push_work", run, None, calm)
    assert value_of(found, "excess") == pytest.approx(value_of(found))
    found = scores_of("evasive_acceleration", run, None, calm)
    assert value_of(found, "excess") == pytest.approx(value_of(found, "rms"))


def test_a_ghost_needs_the_same_samples() -> None:
    run = pushed(0.65, 0.1)
    other = grid(4, 0.1)
    alone = scene(other, None, [line(other, (0, 0), (1, 0))])
    assert scores_of("push_work", run, None, alone)["excess"].reason == "sampling_mismatch"
    assert scores_of("push_work", run)["excess"].reason == "no_reference"


def test_the_acceleration_of_who_steps_aside() -> None:
    robot = line(T, (0, 0), (0.5, 0))
    aside = Body(1 + 0.5 * T, 0.1 * T**2 / 2, np.full(len(T), 0.5), 0.1 * T)
    found = scores_of("evasive_acceleration", scene(T, robot, [aside]))
    for variant in ("corrected", "peak", "rms"):
        assert value_of(found, variant) == pytest.approx(0.1)


def test_one_peak_of_one_person_is_the_peak_only() -> None:
    """Forty people walk beside the robot, one of them starts: the percentile is not his alone."""
    robot = line(T, (0, 0), (1, 0))
    calm = [line(T, (0, 1 + 0.01 * k), (1, 0)) for k in range(40)]
    vx = np.where(T < 2, 1.0, 1.25)
    starts = Body(np.cumsum(vx) / 16, np.full(len(T), -1.0), vx, np.zeros(len(T)))
    found = scores_of("evasive_acceleration", scene(T, robot, [*calm, starts]))
    assert value_of(found, "peak") == pytest.approx(0.25 * 16)
    assert value_of(found, "all") == pytest.approx(0, abs=1e-9)


def test_failures() -> None:
    robot, far = line(T, (0, 0), (1, 0)), line(T, (0, 50), (1, 0))
    for metric in ("push_work", "evasive_acceleration"):
        assert why(scores_of(metric, scene(T, None, [far]))) == {("undefined", "invalid_no_robot")}
        assert why(scores_of(metric, scene(T, robot))) == {("undefined", "no_agents")}
        assert why(scores_of(metric, scene(T, robot, [far]))) == {("undefined", "no_neighbours")}


def test_a_teleport_is_no_acceleration() -> None:
    robot = line(T, (0, 0), (0, 0))
    person = line(T, (1, 0), (0.1, 0))
    jump = np.zeros((len(T) - 1, 1), bool)
    jump[30] = True
    vx = np.where(np.arange(len(T)) > 30, -5.0, 0.1)
    run = scene(T, robot, [dataclasses.replace(person, vx=vx)], agent_jump=jump)
    assert value_of(scores_of("evasive_acceleration", run), "peak") == pytest.approx(0, abs=1e-9)


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=40)
def test_work_is_never_negative_and_needs_advance(seed: int) -> None:
    run = random_scene(seed)
    found = scores_of("push_work", run)
    if found["corrected"].value is None:
        return
    assert value_of(found) >= 0
    assert run.robot is not None
    still = np.zeros(len(run.t))
    parked = dataclasses.replace(run.robot, x=still, y=still, theta=still, v=still, w=still)
    again = scores_of("push_work", dataclasses.replace(run, robot=parked))
    assert again["corrected"].value in (0.0, None)
