"""Forced: the oracle keeps the same account of people driven aside as the primary score."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.trajectories.evasion import evasion
from crowdbot.core.trajectories.headway import share_below
from crowdbot.plugin import Array, Pose, Trajectories, Truth
from crowdbot.plugins.planners.oracle.forced_build import Forced
from tests.plugins.metrics.scenes import ROBOT_RADIUS, Body, grid, line, scene

T = grid(4.0, 1 / 16)
WIDTH = 0.2


def fleeing(ahead: float, beside: float, gain: float, speed: float) -> Trajectories:
    """A person ahead of the robot speeds up along x."""
    person = Body(ahead + gain * T**2 / 2, beside + 0 * T, gain * T, 0 * T)
    return scene(T, line(T, (0, 0), (speed, 0)), [person])


def account(run: Trajectories, radius: float) -> Forced:
    """Let the oracle's account see a run, sample by sample."""
    assert run.robot is not None
    assert run.agents is not None
    forced = Forced(np.array([[0.0, 0.0, radius]]))
    for k, t in enumerate(run.t.tolist()):
        forced.see(t, truth_at(run, k))
    return forced


def truth_at(run: Trajectories, k: int) -> Truth:
    assert run.robot is not None
    assert run.agents is not None
    robot, people = run.robot, run.agents
    return Truth(
        pose=Pose(float(robot.x[k]), float(robot.y[k]), 0.0),
        velocity=(0.0, 0.0, 0.0),
        people=np.column_stack([people.x[k], people.y[k]]),
        people_velocity=np.column_stack([people.vx[k], people.vy[k]]),
        people_radius=people.radius,
        people_id=people.id,
    )


def push(run: Trajectories) -> float:
    found = evasion(run, 2.0, 10.0)
    return float(found.push(share_below(run, 0.5, 10.0))[0])


@settings(max_examples=40)
@given(
    ahead=st.floats(0.7, 1.5), beside=st.floats(-0.3, 0.3), gain=st.floats(0.05, 0.6),
    speed=st.floats(0.2, 1.2),
)  # fmt: skip
def test_the_account_is_that_of_the_score(
    ahead: float, beside: float, gain: float, speed: float
) -> None:
    run = fleeing(ahead, beside, gain, speed)
    assert run.agents is not None
    (number,) = run.agents.id.tolist()
    found = account(run, ROBOT_RADIUS).work_on(number)
    assert found == pytest.approx(push(run), abs=2 * gain * speed / 16 + 1e-9)


def test_whom_others_touch_is_not_driven() -> None:
    robot = np.array([[0.0, 0.0, WIDTH]])
    alone, beside = Forced(robot), Forced(robot)
    for forced, rows in ((alone, [[0.5, 0.0]]), (beside, [[0.5, 0.0], [0.5, 0.3]])):
        people = np.array(rows)
        for k in range(5):
            forced.see(0.1 * k, seen(people + np.array([0.05 * k, 0.0]), 0.3 * k, 0.05 * k))
    assert alone.work_on(0) > 0.1
    assert beside.work_on(0) == 0.0


def seen(people: Array, speed: float, x: float) -> Truth:
    return Truth(
        pose=Pose(x, 0.0, 0.0),
        velocity=(0.5, 0.0, 0.0),
        people=people,
        people_velocity=np.tile([speed, 0.0], (len(people), 1)),
        people_radius=np.full(len(people), WIDTH),
        people_id=np.arange(len(people)),
    )


def test_who_comes_and_goes_is_no_error() -> None:
    forced = Forced(np.array([[0.0, 0.0, WIDTH]]))
    forced.see(0.0, seen(np.array([[0.5, 0.0]]), 0.0, 0.0))
    forced.see(0.1, seen(np.zeros((0, 2)), 0.0, 0.05))
    forced.see(0.2, seen(np.array([[0.6, 0.0], [3.0, 0.0]]), 0.4, 0.1))
    assert forced.work_on(0) == 0.0
    assert forced.work_on(7) == 0.0
