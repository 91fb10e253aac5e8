"""Runs whose goal is a person: what the planner gets, when they end, what is recorded."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.core.planning.planner import Observation
from crowdbot.core.recording.recording import Recording
from crowdbot.core.trajectories.person_track import person_over_time
from crowdbot.errors import InputError
from tests.core.assistance.people import LIDAR, about, session, standing

FACING_WEST = [standing(0, 4.0, 0.0, math.pi)]


def drive(scenario: Any, command: Any, **changes: Any) -> tuple[Any, list[Observation]]:
    """Step a run to its end; ``command``: observation -> command."""
    with session(scenario, **changes) as run:
        seen = [run.reset()]
        while not run.done:
            found = run.step(command(seen[-1]))
            if found is not None:
                seen.append(found)
        return run, seen


def towards(obs: Observation) -> tuple[float, float, float]:
    """Go sideways and ahead to the goal, facing the person."""
    assert obs.person is not None
    dx, dy = obs.goal[0] - obs.pose.x, obs.goal[1] - obs.pose.y
    c, s = math.cos(obs.pose.yaw), math.sin(obs.pose.yaw)
    look = math.atan2(obs.person.y - obs.pose.y, obs.person.x - obs.pose.x) - obs.pose.yaw
    return c * dx + s * dy, math.remainder(look, 2.0 * math.pi), c * dy - s * dx


def still(obs: Observation) -> tuple[float, float]:
    del obs
    return 0.0, 0.0


def test_the_task_is_done_after_the_time_in_place(tmp_path: Path) -> None:
    goal = {"kind": "approach", "person": {"agent": 0}, "hold": 1.0, "knows": "told"}
    scenario = about(goal, FACING_WEST)
    file = tmp_path / "run.mcap"
    run, seen = drive(scenario, towards, recording=file)
    assert run.status == "arrived"
    person = run.task.person
    assert (person.kind, person.distance, person.radius) == ("approach", 1.5, 0.25)
    assert seen[0].person is not None
    assert math.hypot(seen[0].person.x - 4.0, seen[0].person.y) < 0.6  # an error of 0.15 m
    assert seen[0].goal != seen[-1].goal
    recorded = Recording(file).trajectories()
    assert recorded.person is not None
    assert recorded.robot is not None
    assert recorded.agents is not None
    assert recorded.person.task == person
    assert recorded.robot.goal is None
    assert recorded.goal_zone is None
    assert recorded.robot.goal_time == pytest.approx(run.t)
    assert abs(person_over_time(recorded.agents, recorded.person).heading[0]) == math.pi


def test_one_who_stands_still_is_never_done() -> None:
    goal = {"kind": "approach", "person": {"agent": 0}}
    run, _ = drive(about(goal, FACING_WEST, time_limit=4.0), still)
    assert run.status == "timeout"


def test_from_behind_is_not_from_the_front() -> None:
    goal = {"kind": "approach", "person": {"agent": 0}, "hold": 0.5}
    start = (4.0 - 0.25 - 1.5 - 0.29, 0.0, 0.0)
    ahead = about(goal, [standing(0, 4.0, 0.0, math.pi)], start=start, time_limit=1.0)
    assert drive(ahead, still)[0].status == "arrived"
    behind = about(goal, [standing(0, 4.0, 0.0, 0.0)], start=start, time_limit=1.0)
    assert drive(behind, still)[0].status == "timeout"


def test_one_who_is_led_follows_within_people_s_limits() -> None:
    goal = {"kind": "lead", "person": {"agent": 0}, "zone": "exit", "knows": "told"}
    agents = [standing(0, 1.5, 0.0, 0.0, speed=0.5)]
    scenario = about(goal, agents, start=(3.3, 0.0, 0.0), time_limit=15.0)

    def ahead(obs: Observation) -> tuple[float, float]:
        return min(0.5, obs.goal[0] - obs.pose.x), 0.0

    run, seen = drive(scenario, ahead, privileged=True)
    assert run.status == "arrived"
    people = np.array([obs.truth.people[0] for obs in seen if obs.truth])
    speed = np.hypot(*np.diff(people, axis=0).T) * 16.0
    assert people[-1, 0] > 3.0
    assert 0.3 < speed.max() < 0.6

    def away(obs: Observation) -> tuple[float, float]:
        del obs
        return 0.5, 0.0

    far = about(goal, agents, start=(4.9, 0.0, 0.0), time_limit=3.0)
    far = far.model_copy(deep=True)
    lost, seen = drive(_loses(far, 2.0), away, privileged=True)
    assert lost.status == "timeout"
    assert seen[-1].truth is not None
    assert seen[-1].truth.people[0, 0] == pytest.approx(1.5, abs=0.05)


def _loses(scenario: Any, gap: float) -> Any:
    robot = scenario.robots["robot"]
    goal = robot.task.goal.model_copy(update={"loses": gap})
    task = robot.task.model_copy(update={"goal": goal})
    return scenario.model_copy(
        update={"robots": {"robot": robot.model_copy(update={"task": task})}}
    )


def test_tracked_needs_a_lidar_and_told_does_not() -> None:
    sensors = {"odometry": {"kind": "holonomic_odometry"}}
    goal = {"kind": "follow", "person": {"agent": 0}}
    with pytest.raises(InputError, match="has no lidar; give it one, or write 'knows: told'"):
        session(about(goal, FACING_WEST, sensors=sensors))
    session(about({**goal, "knows": "told"}, FACING_WEST, sensors=sensors)).close()


def test_a_planner_without_lidars_gets_the_person_tracked_all_the_same() -> None:
    """The lidars are the robot's: they are simulated, and the planner does not see them."""
    goal = {"kind": "follow", "person": {"agent": 0}}
    walks = [{"id": 0, "x": 3.0, "y": 0.0, "goals": [[12.0, 0.0]], "speed": 0.5}]
    _, seen = drive(about(goal, walks, time_limit=4.0), still, sensors=[], privileged=True)
    last = seen[-1]
    assert not last.readings
    assert last.person is not None
    assert last.truth is not None
    assert math.hypot(*(last.truth.people[0] - [last.person.x, last.person.y])) < 0.2
    assert last.person.vx == pytest.approx(0.5, abs=0.15)
    assert last.person.age < 0.2
    assert LIDAR["kind"] == "lidar2d"
