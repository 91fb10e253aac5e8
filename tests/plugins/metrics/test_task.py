"""Arrival, goal, motion, reference path, contacts, walls, planner: definitions and failures."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

from crowdbot.core.trajectories.trajectories import Trajectories
from tests.plugins.metrics.scenes import (
    ROBOT_RADIUS,
    driven,
    grid,
    line,
    polyline,
    scene,
    scores_of,
    trips,
    value_of,
    values,
    why,
)

T = grid(10)
GOAL: dict[str, Any] = {"robot_goal": (10.0, 0.0), "robot_goal_radius": 0.5}
ZONE = [[9.0, -5.0], [12.0, -5.0], [12.0, 5.0], [9.0, 5.0]]


def going(*, arrives: bool = True, **more: Any) -> Trajectories:
    """9.5 m straight ahead, 1 m/s but for a pause of 0.5 s; the goal's disc begins there."""
    return driven(T, v=0.95, goal_time=10.0 if arrives else None, **{**GOAL, **more})


def value(metric: str, run: Trajectories, *refs: Trajectories, **fields: Any) -> float:
    return value_of(scores_of(metric, run, *refs, **fields))


def test_success() -> None:
    bump = scene(T, line(T, (0, 0), (1, 0)), [line(T, (5, 0), (0, 0))], goal_time=10.0)
    free = scene(T, line(T, (0, 0), (1, 0)), [line(T, (5, 9), (0, 0))], goal_time=10.0)
    never = scene(T, line(T, (0, 0), (1, 0)), [line(T, (5, 9), (0, 0))], **GOAL)
    names = ("success", "success_no_collision", "timeout")
    assert [value(n, bump) for n in names] == [1, 0, 0]
    assert [value(n, free) for n in names] == [1, 1, 0]
    assert [value(n, never) for n in names] == [0, 0, 1]
    after = scene(T, line(T, (0, 0), (1, 0)), [line(T, (5, 0), (0, 0))], goal_time=4.0)
    assert value("success_no_collision", after) == 1


def test_without_a_goal_there_is_no_task() -> None:
    """A drive without a goal neither arrives nor fails to; one that arrived had a goal."""
    free, there = driven(T, v=1.0), driven(T, v=1.0, goal_time=10.0)
    zone = driven(T, v=0.1, goal_zone=ZONE)
    for metric in ("success", "success_no_collision", "timeout", "stl", "aggregated_time"):
        assert why(scores_of(metric, free, there)) == {("undefined", "invalid_no_goal")}
        for run in (there, zone):
            found = scores_of(metric, run, there)["corrected"]
            assert found.reason != "invalid_no_goal"


def test_spl() -> None:
    assert value("spl", going()) == pytest.approx(1)
    assert value("spl", going(arrives=False)) == 0
    detour = polyline(T, [(0, 0, 0), (5, 4.75, 4.75), (10, 9.5, 0)])
    run = scene(T, detour, goal_time=10.0, **GOAL)
    assert value("spl", run) == pytest.approx(1 / math.sqrt(2))
    assert value("path_efficiency", run) == pytest.approx(1 / math.sqrt(2))
    zoned = scene(T, detour, goal_time=10.0, **GOAL, goal_zone=ZONE)
    assert value("spl", zoned) == pytest.approx(9 / (9.5 * math.sqrt(2)))
    short = driven(T, v=0.5, goal_time=10.0, **GOAL)
    assert value("spl", short) == pytest.approx(1)  # never above 1
    there = driven(T, v=0.0, goal_time=10.0, robot_goal=(0.0, 0.0))
    assert why(scores_of("spl", there)) == {("undefined", "zero_denominator")}
    assert why(scores_of("spl", driven(T, v=1.0))) == {("undefined", "invalid_no_goal")}
    found = scores_of("path_efficiency", going(arrives=False))["corrected"]
    assert found.status == "censored"
    assert found.upper == pytest.approx(1)


def test_stl() -> None:
    alone, slow = driven(T, v=1.0, goal_time=8.0), driven(T, v=1.0, goal_time=10.0)
    assert value("stl", slow, alone) == pytest.approx(0.8)
    assert value("stl", alone, slow) == 1
    assert value("stl", driven(T, v=1.0, **GOAL), alone) == 0
    assert why(scores_of("stl", slow)) == {("undefined", "no_reference")}


def test_distance_to_goal() -> None:
    past = driven(grid(20), v=1.0, robot_goal=(10.0, 3.0))
    assert value("final_distance_to_goal", past) == pytest.approx(math.hypot(10, 3))
    assert value("min_distance_to_goal", past) == pytest.approx(3)
    zone = driven(T, v=0.5, goal_zone=ZONE)
    assert value("final_distance_to_goal", zone) == pytest.approx(4)
    assert value("min_distance_to_goal", driven(T, v=1.0, goal_zone=ZONE)) == 0
    for metric in ("final_distance_to_goal", "min_distance_to_goal", "failure_to_progress"):
        assert why(scores_of(metric, driven(T, v=1.0))) == {("undefined", "invalid_no_goal")}


def test_failure_to_progress() -> None:
    t = grid(21)
    v = np.where((t > 5) & (t < 15), 0.0, 1.0)
    run = driven(t, v=v, robot_goal=(100.0, 0.0))
    found = scores_of("failure_to_progress", run)["corrected"]
    assert (found.value, found.extras["windows"]) == (2, 4)
    assert value("failure_to_progress", run, progress_window=7.0) == 1


def test_aggregated_time() -> None:
    people = [line(T, (0, 5), (1, 0)), line(T, (0, 7), (1, 0))]
    rows = ((0, 0, 4, True), (1, 2, 9, True))
    run = scene(T, line(T, (0, 0), (1, 0)), people, goal_time=10.0, **trips(*rows))
    assert value("aggregated_time", run) == pytest.approx(10 + 4 + 7)
    late = scene(T, line(T, (0, 0), (1, 0)), people, **trips(*rows), **GOAL)
    found = scores_of("aggregated_time", late)["corrected"]
    assert found.status == "censored"
    assert found.lower == pytest.approx(21)


# ------------------------------------------------------------------------- motion
def test_standing_and_stalling() -> None:
    v = np.where(T <= 2 + 1e-9, 0.0, np.where(T <= 5 + 1e-9, 0.04, 1.0))
    w = np.where(T <= 1 + 1e-9, 0.5, 0.0)
    run = driven(T, v=v, w=w)
    assert value("time_not_moving", run) == pytest.approx(1.0)
    assert value("stalled_time", run) == pytest.approx(5.05)


def test_turning() -> None:
    w = np.where(T < 5, 0.3, -0.3)
    run = driven(T, v=1.0, w=w)
    assert value("cumulative_heading_change", run) == pytest.approx(3.0, abs=0.05)
    assert value("path_irregularity", run) == pytest.approx(0.3, abs=0.01)
    circle = driven(T, v=1.0, w=1.0)
    assert circle.robot is not None
    wrapped = np.angle(np.exp(1j * circle.robot.theta)).astype(np.float64)
    seam = dataclasses.replace(circle, robot=dataclasses.replace(circle.robot, theta=wrapped))
    assert value("cumulative_heading_change", seam) == pytest.approx(10)


def test_speeds_and_their_changes() -> None:
    t = np.array([0.0, 1.0, 3.0, 4.0])
    run = driven(t, v=[0.0, -1.0, 1.0, 1.0])
    found = values(scores_of("speed", run))
    assert found == pytest.approx({"min": 0, "avg": (0 + 1.5 + 1.5 + 0.5) / 4, "max": 1})
    found = values(scores_of("acceleration", run))  # 1, 1, 0
    assert found == pytest.approx({"min": 0, "avg": 3 / 4, "max": 1})
    found = values(scores_of("jerk", run))  # (1 + 1)/1.5, 1/1.5
    assert found == pytest.approx({"min": 1 / 1.5, "avg": 3 / 3, "max": 2 / 1.5})
    total = (2 / 1.5) ** 2 * 1.5 + (1 / 1.5) ** 2 * 1.5
    assert value("dimensionless_jerk", run) == pytest.approx(total * 4**3)


# ----------------------------------------------------------------- reference path
def test_distance_from_the_path_alone() -> None:
    alone = scene(T, line(T, (0, 0), (1, 0)), goal_time=10.0)
    beside = scene(T, line(T, (0, 2), (1, 0)), goal_time=8.0)
    slower = scene(T, line(T, (0, 0), (0.5, 0)))
    assert value("ade_to_reference", beside, alone) == pytest.approx(2)
    assert value("ade_to_reference", slower, alone) == pytest.approx(2.5)
    assert value("fde_to_reference", slower, alone) == pytest.approx(5)
    later = dataclasses.replace(slower, t=slower.t + 7)
    assert value("fde_to_reference", later, alone) == pytest.approx(5)
    coarse = scene(grid(10, 0.4), line(grid(10, 0.4), (0, 0), (0.5, 0)))
    assert value("fde_to_reference", coarse, alone) == pytest.approx(5)
    for metric in ("ade_to_reference", "fde_to_reference"):
        assert why(scores_of(metric, slower)) == {("undefined", "no_reference")}


# ----------------------------------------------------------------------- contacts
CONTACTS = {
    "t0": [1.0, 2.0, 3.0, 9.5],
    "t1": [1.5, 2.1, 3.5, 9.9],
    "agent": [4, -1, 0, 4],
    "impulse": [2.0, 50.0, 3.0, 100.0],
    "peak_force": [30.0, 900.0, 20.0, 500.0],
    "relative_speed": [1.0, 1.0, 1.0, 1.0],
}


def test_recorded_contacts() -> None:
    run = driven(T, v=1.0, goal_time=9.0, contacts=CONTACTS)
    assert value("max_contact_force", run) == 30
    assert value("contact_impulse", run) == 5
    assert value("contact_time", run) == pytest.approx(1.0)
    assert values(scores_of("wall_contact_count", run))["recorded"] == 1
    none = driven(T, v=1.0, contacts={name: [] for name in CONTACTS})
    unknown = driven(T, v=1.0)
    for metric in ("max_contact_force", "contact_impulse", "contact_time"):
        assert value(metric, none) == 0
        assert why(scores_of(metric, unknown)) == {("undefined", "invalid_no_contacts")}


WALLS = [[0.0, 1.0, 20.0, 1.0], [8.0, -3.0, 8.0, 3.0]]


def test_walls() -> None:
    run = driven(T, v=0.5, walls=WALLS)
    assert value("min_wall_clearance", run) == pytest.approx(1 - ROBOT_RADIUS)
    assert value("avg_wall_clearance", run) == pytest.approx(1 - ROBOT_RADIUS)
    away = driven(T, v=0.5, walls=[WALLS[1]])
    assert value("min_wall_clearance", away) == pytest.approx(3 - ROBOT_RADIUS)
    assert value("avg_wall_clearance", away) == pytest.approx(5.5 - ROBOT_RADIUS)
    assert scores_of("wall_contact_count", run)["geometric"].value == 0
    for metric in ("min_wall_clearance", "avg_wall_clearance", "wall_contact_count"):
        found = scores_of(metric, driven(T, v=0.5))
        assert why(found) <= {
            ("undefined", "invalid_no_walls"),
            ("undefined", "invalid_no_contacts"),
        }


def test_wall_contacts() -> None:
    through = driven(np.array([0.0, 8.0, 16.0]), v=1.0, walls=[[4.0, -1.0, 4.0, 1.0]])
    assert scores_of("wall_contact_count", through)["geometric"].value == 1
    x = np.array([0, 0.5, 0.83, 0.81, 0.83, 0.5, 0.83])
    t = 0.1 * np.arange(7)
    bumps = driven(t, robot_x=x, walls=[[1.0, -1.0, 1.0, 1.0]])
    assert scores_of("wall_contact_count", bumps)["geometric"].value == 2
    box = [[-0.6, -0.2], [0.6, -0.2], [0.6, 0.2], [-0.6, 0.2]]
    long = driven(T, v=0.5, walls=[WALLS[1]], robot_footprint=box)
    assert value("min_wall_clearance", long) == pytest.approx(3 - 0.6)
    stuck = driven(T, v=0.0, walls=[[0.0, -3.0, 0.0, 3.0]], robot_footprint=box)
    assert value("min_wall_clearance", stuck) <= 0
    assert scores_of("wall_contact_count", stuck)["geometric"].value == 1


def test_planner_times() -> None:
    run = driven(T, v=1.0, planner_step_time=[0.01, 0.02, 0.06])
    assert value("mean_planner_time", run) == pytest.approx(0.03)
    assert value("max_planner_time", run) == pytest.approx(0.06)
    for metric in ("mean_planner_time", "max_planner_time"):
        assert why(scores_of(metric, driven(T, v=1.0))) == {
            ("undefined", "invalid_no_planner_time")
        }
