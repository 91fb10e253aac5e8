"""contacts_at_fault, contacts_per_km, safe_efficiency: hand cases, failures, adversaries."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array
from tests.plugins.metrics.scenes import (
    REACH,
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
    samples, values = arriving(10.0, aside), arriving(10.0, aside, contacts=bounce)
    assert efficiency(samples) == 1.0
    assert efficiency(values) == 0.0
    assert scores_of("safe_efficiency", values)["corrected"].extras["contacts_at_fault"] == 1


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
@settings(max_examples=40)
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


# ------------------------------------------------- who braked when it was foreseeable
def moving(speed: Array) -> Body:
    """Along x from the origin with the speeds (N,), m/s."""
    x = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 32)])
    return Body(x, 0 * T, speed, 0 * T)


def beside(turns: float, sideways: float) -> Body:
    """Walks 0.5 m/s, 0.3 m beside the robot, and from a time on into its front left as well."""
    vy = np.where(turns <= T, -sideways, 0.0)
    y = REACH * 0.6 + 0.5 + np.concatenate([[0.0], np.cumsum((vy[1:] + vy[:-1]) / 32)])
    return Body(REACH * 0.8 + 0.5 * T, np.maximum(y, 0.0), 0 * T + 0.5, vy)


def meet(robot: Body, person: Body) -> tuple[float, float]:
    return faults(scene(T, robot, [person], **GOAL))


def test_who_is_shoved_into_the_robot_at_once_is_not_its_fault() -> None:
    """0.5 m at 2.5 m/s is a fifth of a second: less than anybody needs to react."""
    brakes, straight_on = moving(np.clip(0.5 - (T - 4.3), 0.0, 0.5)), line(T, (0, 0), (0.5, 0))
    assert meet(brakes, beside(4.0, 2.5)) == (0, 1)
    assert meet(straight_on, beside(4.0, 2.5)) == (1, 0)  # it pushes on
    assert meet(brakes, beside(3.0, 0.5)) == (1, 0)  # a second is time enough


def test_who_brakes_when_it_is_foreseeable_is_not_at_fault() -> None:
    """Somebody comes straight on at 1.3 m/s; the robot, at 0.5 m/s, needs 0.8 s and 0.275 m."""
    comes = line(T, (9.0, 0.0), (-1.3, 0.0))
    contact = (9.0 - REACH) / 1.8
    for before, fault in ((0.9, (0, 1)), (0.5, (0, 1)), (0.2, (1, 0)), (-1.0, (1, 0))):
        speed = np.clip(0.5 - (T - contact + before), 0.0, 0.5)
        assert meet(moving(speed), comes) == fault, before


def test_half_braking_is_not_the_proper_response() -> None:
    comes = line(T, (9.0, 0.0), (-1.3, 0.0))
    contact = (9.0 - REACH) / 1.8
    speed = np.clip(0.5 - 0.3 * (T - contact + 0.8), 0.0, 0.5)
    assert meet(moving(speed), comes) == (1, 0)


@given(speed=st.floats(0.2, 1.5), walks=st.floats(0.0, 2.0), aside=st.floats(-0.3, 0.3))
@settings(max_examples=60)
def test_the_blind_are_always_at_fault_for_who_comes_straight(
    speed: float, walks: float, aside: float
) -> None:
    comes = line(T, (3.0, aside), (-walks, 0))
    assume((speed + walks) * T[-1] > 3.0)
    assert meet(line(T, (0, 0), (speed, 0)), comes) == (1, 0)


# --------------------------------------------------------- who is driven aside
def escaping(push: float, headway: float) -> Trajectories:
    """Somebody ahead of the robot speeds up from 1 m/s, and is pushed so much per mass; J/kg."""
    t = grid(10.0, 1 / 16)
    gain = push / 10.0  # the robot advances at 1 m/s for 10 s
    person = Body(REACH + headway + t + gain * t**2 / 2, 0 * t, 1.0 + gain * t, 0 * t)
    return scene(t, line(t, (0, 0), (1, 0)), [person], goal_time=10.0, **GOAL)


def test_whoever_is_driven_aside_halves_the_score() -> None:
    """Nobody is touched: the contact is one that only the person prevented."""
    run = escaping(0.3, 0.1)
    run = dataclasses.replace(run, robot=run.robot)
    found = scores_of("safe_efficiency", run, forced_headway="5 s")["corrected"]
    assert found.extras["driven_aside"] == 1
    assert found.value == pytest.approx(0.5)
    assert found.extras["contacts_at_fault"] == 0


def test_who_steps_aside_in_time_or_a_little_is_not_driven() -> None:
    assert efficiency(escaping(0.2, 0.1)) == pytest.approx(1.0)
    assert efficiency(escaping(0.3, 1.0)) == pytest.approx(1.0)


def test_each_person_counts_once_and_others_shove_is_not_the_robots() -> None:
    run = escaping(0.3, 0.1)
    assert run.agents is not None
    two = dataclasses.replace(
        run.agents,
        id=np.array([0, 1]), radius=np.repeat(run.agents.radius, 2),
        mass=np.repeat(run.agents.mass, 2), jump=None,
        **{k: np.repeat(getattr(run.agents, k), 2, axis=1) for k in ("x", "y", "vx", "vy")},
    )  # fmt: skip
    overlapping = dataclasses.replace(run, agents=two)
    found = scores_of("safe_efficiency", overlapping, forced_headway="5 s")["corrected"]
    assert found.extras["driven_aside"] == 0  # they touch each other all the time


def bounced(after: float, *, touched: bool = True) -> Trajectories:
    """A person ahead bounces off another person at 1 m/s, goes on at 0.4, then at ``after``."""
    t = grid(10.0, 1 / 16)
    slowed = np.clip(1.0 - 6.0 * (t - 4.0), 0.4, 1.0)
    speed = np.where(t < 4.5, slowed, np.minimum(0.4 + 1.2 * (t - 4.5), after))
    x = REACH + 1.1 + np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2.0) / 16])
    walker = Body(x, 0 * t, speed, 0 * t)
    beside = line(t, (float(np.interp(4.1, t, x)), 0.49 if touched else 2.0), (0, 0))
    return scene(t, line(t, (0, 0), (1, 0)), [walker, beside], goal_time=10.0, **GOAL)


@pytest.mark.parametrize(
    ("after", "touched", "counted", "by_robot"),
    [(1.0, True, 1, 0), (1.0, False, 1, 1), (1.6, True, 1, 1), (1.2, True, 1, 0)],
)
def test_who_bounces_off_others_regains_the_speed(
    after: float, touched: bool, counted: int, by_robot: int
) -> None:
    """The robot did not slow them; what they gain beyond their speed is for the robot."""
    found = scores_of("safe_efficiency", bounced(after, touched=touched), forced_headway="5 s")
    extras = found["corrected"].extras
    assert (extras["driven_aside"], extras["driven_aside_by_robot"]) == (counted, by_robot)
    assert found["corrected"].value == pytest.approx(0.5**counted)
    assert found["by_robot"].value == pytest.approx(0.5**by_robot)
