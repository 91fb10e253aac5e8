"""Crop, windows, valid steps, velocities, weights."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.trajectories.preprocess import (
    agent_velocities,
    duration,
    path_length,
    robot_velocity,
    samples_of_shorter,
    time_weights,
    travel_time,
    truncate,
    truncate_at_arrival,
    truncate_to_shorter,
    valid_agent_steps,
    valid_robot_steps,
)
from crowdbot.core.trajectories.tracks import AgentTracks, RobotTrack
from crowdbot.core.trajectories.trajectories import Trajectories, cached_beside
from crowdbot.errors import InputError

NAN = np.nan


def run_of(t: Any, *, goal_time: float | None = None, **more: Any) -> Trajectories:
    """A robot along x at 1 m/s, two people who stand."""
    t = np.asarray(t, dtype=float)
    return Trajectories.from_arrays(
        t=t,
        robot_x=t,
        robot_y=0 * t,
        robot_theta=0 * t,
        robot_v=1 + 0 * t,
        robot_w=0 * t,
        robot_radius=0.2,
        robot_mass=6.0,
        robot_goal_time=goal_time,
        agent_x=np.zeros((len(t), 2)),
        agent_y=np.ones((len(t), 2)),
        agent_radius=0.25,
        agent_mass=70.0,
        **more,
    )


def robot_of(run: Trajectories) -> RobotTrack:
    assert run.robot is not None
    return run.robot


def people_of(t: Any, x: Any, **more: Any) -> tuple[Any, AgentTracks]:
    """One person on the x axis."""
    x = np.asarray(x, dtype=float)[:, None]
    given = {"agent_y": 0 * x, "agent_radius": 0.25, "agent_mass": 70.0, **more}
    run = Trajectories.from_arrays(t=t, agent_x=x, **given)
    assert run.agents is not None
    return run.t, run.agents


# ------------------------------------------------------------------------ crop
@pytest.mark.parametrize(
    ("goal_time", "count"),
    [
        (None, 5),
        (0.0, 1),
        (1.0, 2),
        (1.0 - 5e-10, 2),
        (1.0 - 1e-6, 1),
        (1.9, 2),
        (4.0, 5),
        (4.5, 5),
    ],
)
def test_crop_keeps_samples_up_to_the_arrival(goal_time: float | None, count: int) -> None:
    jump = np.zeros((4, 2), dtype=bool)
    run = truncate_at_arrival(run_of(range(5), goal_time=goal_time, agent_jump=jump))
    assert run.t.tolist() == list(range(count))
    assert run.agents is not None
    assert run.agents.jump is not None
    assert len(robot_of(run).x) == len(run.agents.x) == len(run.agents.jump) + 1 == count
    assert robot_of(run).goal_time == goal_time


@pytest.mark.parametrize("goal_time", [-1.0, np.nan, np.inf])
def test_an_impossible_arrival(goal_time: float) -> None:
    with pytest.raises(InputError, match="goal_time"):
        truncate_at_arrival(run_of(range(5), goal_time=goal_time))


def test_crop_twice_is_crop_once() -> None:
    once = truncate_at_arrival(run_of(range(9), goal_time=3.3))
    assert np.array_equal(truncate_at_arrival(once).t, once.t)


TRIPS: dict[str, Any] = {
    "trip_agent": [0, 0, 1, 1],
    "trip_t0": [0.0, 2.0, 0.0, 3.5],
    "trip_t1": [2.0, 3.3, 9.0, 3.9],
    "trip_reached": [True, True, True, False],
}


def test_trips_end_with_the_window() -> None:
    run = truncate_at_arrival(run_of(range(9), goal_time=3.1, **TRIPS))
    assert run.trips is not None
    assert run.trips.agent.tolist() == [0, 0, 1]
    assert run.trips.t1.tolist() == [2.0, 3.1, 3.1]
    assert run.trips.reached.tolist() == [True, False, False]


def test_without_arrival_trips_end_with_the_record() -> None:
    run = truncate_at_arrival(run_of(range(6), **TRIPS))
    assert run.trips is not None
    assert run.trips.t1.tolist() == [2.0, 3.3, 5.0, 3.9]
    assert run.trips.reached.tolist() == [True, True, False, False]


def test_contacts_end_with_the_window() -> None:
    zeros = [0.0, 0.0, 0.0]
    contacts: dict[str, Any] = {
        "t0": [0.5, 1.5, 2.5],
        "t1": [0.6, 2.6, 2.7],
        "agent": [0, 1, -1],
        "impulse": [1.0, 2.0, 3.0],
        "peak_force": zeros,
        "relative_speed": zeros,
    }
    run = truncate_at_arrival(run_of(range(9), goal_time=2.0, contacts=contacts))
    assert run.contacts is not None
    assert run.contacts.t1.tolist() == [0.6, 2.0]
    assert run.contacts.impulse.tolist() == [1.0, 2.0]


def test_the_common_window_starts_with_each_run() -> None:
    a, b = run_of(np.arange(0, 5, 0.5)), run_of(np.arange(100, 103.1, 0.25))
    for first, second in ((a, b), (b, a)):
        one, two = truncate_to_shorter(first, second)
        assert duration(one.t) == duration(two.t) == 3.0
        assert one.t[0] == first.t[0]


def test_of_the_shorter_run_all_samples_are_asked_as_they_are() -> None:
    short, long = (Trajectories(t=np.arange(float(n))) for n in (4, 9))
    found, cut = samples_of_shorter(short, long)
    assert found is short
    assert cut.t.tolist() == short.t.tolist()


def test_what_two_runs_give_is_computed_once_for_each_other() -> None:
    run, one, two = (Trajectories(t=np.arange(3.0) + k) for k in range(3))
    asked: list[float] = []

    def begin_of(other: Trajectories) -> float:
        def ask() -> float:
            asked.append(float(other.t[0]))
            return asked[-1]

        return cached_beside(run, other, "begin", ask)

    assert [begin_of(other) for other in (one, two, one, two)] == [1.0, 2.0, 1.0, 2.0]
    assert asked == [1.0, 2.0]


def test_travel_time() -> None:
    t = np.arange(100, 105)
    assert travel_time(run_of(t), robot_of(run_of(t))) == 4
    arrived = run_of(t, goal_time=103.25)
    assert travel_time(arrived, robot_of(arrived)) == 3.25


def test_windowed_leaves_the_given_run_alone() -> None:
    run = run_of(range(9), **TRIPS)
    truncate(run, 2.0)
    assert len(run.t) == 9
    assert run.trips is not None
    assert run.trips.reached.tolist() == TRIPS["trip_reached"]


# --------------------------------------------------------------------- weights
def test_weights_are_trapezoidal() -> None:
    assert time_weights(np.array([0.0, 1.0, 4.0])).tolist() == [0.5, 2.0, 1.5]
    assert time_weights(np.array([7.0])).tolist() == [0.0]


@given(st.lists(st.floats(1e-3, 1.0), min_size=1, max_size=50))
def test_weights_sum_to_the_duration(steps: list[float]) -> None:
    t = np.cumsum([3.0, *steps])
    assert time_weights(t).sum() == pytest.approx(duration(t))
    assert time_weights(t) @ t == pytest.approx((t[-1] ** 2 - t[0] ** 2) / 2)


# ----------------------------------------------------------------------- steps
def test_recorded_jumps_decide() -> None:
    t, agents = people_of(
        range(5), [0, 1, 51, NAN, 52], agent_jump=[[True], [False], [False], [False]]
    )
    assert valid_agent_steps(t, agents, 10.0)[:, 0].tolist() == [False, True, False, False]


def test_without_recorded_jumps_speed_decides() -> None:
    t, agents = people_of([0, 1, 2, 2.5, 3.5, 4.5], [0, 1, 11, 17, 27.1, NAN])
    found = valid_agent_steps(t, agents, 10.0)[:, 0]
    assert found.tolist() == [True, True, False, False, False]
    assert valid_agent_steps(t, agents, 12.1)[:, 0].tolist() == [True, True, True, True, False]


def test_the_robot_may_not_teleport() -> None:
    run = run_of([0.0, 1.0, 11.0, 12.0])
    x = np.array([0.0, 1.0, 99.0, 120.0])
    robot = robot_of(run_like(run, x))
    assert valid_robot_steps(run.t, robot, 10.0).tolist() == [True, True, False]
    assert path_length(run.t, robot, 10.0) == 99.0


def run_like(run: Trajectories, x: Any, **more: Any) -> Trajectories:
    robot = robot_of(run)
    given = {"robot_y": robot.y, "robot_theta": robot.theta, "robot_v": robot.v, **more}
    return Trajectories.from_arrays(
        t=run.t, robot_x=x, robot_w=robot.w, robot_radius=0.2, robot_mass=6.0, **given
    )


# ------------------------------------------------------------------ velocities
def test_recorded_velocities_are_kept() -> None:
    n = np.ones((3, 1))
    t, agents = people_of(range(3), [0, 5, 7], agent_vx=0.3 * n, agent_vy=-0.2 * n)
    vx, vy = agent_velocities(t, agents, 10.0)
    assert vx[:, 0].tolist() == [0.3] * 3
    assert vy[:, 0].tolist() == [-0.2] * 3


def test_derived_velocities_are_secants() -> None:
    t, agents = people_of([0.0, 1.0, 3.0, 4.0], [0.0, 1.0, 7.0, 7.0])
    assert agent_velocities(t, agents, 10.0)[0][:, 0] == pytest.approx([1, 7 / 3, 2, 0])


def test_never_across_a_teleport_or_an_absence() -> None:
    jump = np.array([[False], [True], [True], [False], [False], [False]])
    x = [0.0, 1.0, 50.0, 10.0, 12.0, NAN, 14.0]
    t, agents = people_of(range(7), x, agent_jump=jump)
    vx = agent_velocities(t, agents, 10.0)[0][:, 0]
    np.testing.assert_array_equal(vx, [1.0, 1.0, NAN, 2.0, 2.0, NAN, NAN])


def test_absent_people_have_no_velocity_even_if_one_is_recorded() -> None:
    vx = np.ones((3, 1))
    t, agents = people_of(range(3), [0, NAN, 2], agent_vx=vx, agent_vy=vx)
    np.testing.assert_array_equal(agent_velocities(t, agents, 10.0)[0][:, 0], [1.0, NAN, 1.0])


def test_one_sample_has_no_secant() -> None:
    t, agents = people_of([0.0], [1.0])
    assert np.isnan(agent_velocities(t, agents, 10.0)[0]).all()


def test_the_robots_velocity_lies_along_its_heading() -> None:
    run = run_like(
        run_of(range(3)), [0, 1, 2], robot_v=[1.0, -2.0, NAN], robot_theta=[0.0, np.pi / 2, 1.0]
    )
    vx, vy = robot_velocity(run.t, robot_of(run), 10.0)
    assert vx == pytest.approx([1, 0, 1], abs=1e-12)  # the last one is derived
    assert vy == pytest.approx([0, -2, 0], abs=1e-12)
