"""How much the robot moves like people: hand cases and failures."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

from crowdbot.core.trajectories.trajectories import Trajectories
from tests.plugins.metrics.scenes import (
    Array,
    Body,
    driven,
    grid,
    line,
    polyline,
    present_during,
    scene,
    scores_of,
    trips,
    value_of,
    values,
    why,
)

T = grid(10)
TIME, LENGTH = "time_to_goal_similarity", "path_length_similarity"
ALL_SIMILARITIES = (
    TIME, LENGTH, "heading_similarity", "velocity_similarity", "neighbour_velocity_similarity",
)  # fmt: skip


def against(robot_speed: float, agent_speed: float, *, arrives: bool = True) -> Trajectories:
    """Both straight for 10 s."""
    return scene(
        T,
        line(T, (0, 0), (robot_speed, 0)),
        [line(T, (0, 5), (agent_speed, 0))],
        goal_time=10.0 if arrives else None,
        **trips((0, 0, 10, True)),
    )


def test_like_people() -> None:  # a02
    for metric in (TIME, LENGTH, "velocity_similarity"):
        found = values(scores_of(metric, against(1, 1)))
        assert found == pytest.approx({"literal": 1, "corrected": 1})


def test_faster_and_slower() -> None:  # c01, c02
    assert values(scores_of(TIME, against(1.5, 0.5))) == pytest.approx(
        {"literal": 1, "corrected": 1 / 3}
    )
    assert value_of(scores_of(TIME, against(0.5, 1.5))) == pytest.approx(3)
    assert values(scores_of(LENGTH, against(1.5, 0.5))) == pytest.approx(
        {"literal": 3, "corrected": 1}
    )
    assert values(scores_of(LENGTH, against(0.5, 1.5))) == pytest.approx(
        {"literal": 1 / 3, "corrected": 1}
    )
    for robot, agent in ((1.5, 0.5), (0.5, 1.5)):
        found = values(scores_of("velocity_similarity", against(robot, agent)))
        assert found == pytest.approx({"literal": robot / agent, "corrected": robot / agent})


def test_a_detour() -> None:  # i04
    t = grid(7)
    robot = polyline(t, [(0, 0, 0), (3, 3, 0), (7, 3, 4)])
    run = scene(t, robot, [line(t, (0, 9), (1, 0))], goal_time=7.0, **trips((0, 0, 7, True)))
    assert values(scores_of(TIME, run)) == pytest.approx({"literal": 1, "corrected": 7 / 5})
    assert values(scores_of(LENGTH, run)) == pytest.approx({"literal": 1, "corrected": 7 / 5})


def test_no_arrival() -> None:  # e07
    t = grid(20)
    robot = line(t, (0, 0), (0.25, 0))
    run = scene(t, robot, [line(t, (0, 9), (1, 0))], **trips((0, 0, 20, True)))
    found = scores_of(TIME, run)
    assert found["literal"].status == "censored"
    assert found["literal"].lower == pytest.approx(1)
    assert found["literal"].upper is None
    assert value_of(found) == pytest.approx(4)
    found = scores_of(LENGTH, run)
    assert found["literal"].status == "censored"
    assert found["literal"].lower == pytest.approx(0.25)
    assert value_of(found) == pytest.approx(1)


def test_only_completed_trips_have_a_literal_mean() -> None:  # e06
    rows = ((0, 0, 6, True), (1, 0, 8, False), (2, 0, 10, True), (3, 0, 14, True))
    t = grid(20)
    agents = [line(t, (0, 3.0 * i), (1, 0)) for i in range(1, 5)]
    run = scene(t, line(t, (0, 0), (1, 0)), agents, goal_time=20.0, **trips(*rows))
    found = scores_of(TIME, run)
    assert value_of(found, "literal") == pytest.approx(2)
    assert value_of(found) == pytest.approx(1)
    assert value_of(scores_of(LENGTH, run), "literal") == pytest.approx(20 / 10)
    none = scene(t, line(t, (0, 0), (1, 0)), agents, **trips((0, 0, 20, False)))
    assert scores_of(TIME, none)["literal"].reason == "no_completed_trips"
    assert scores_of(TIME, none)["corrected"].status == "ok"


def test_a_spinning_robot_goes_nowhere() -> None:  # d05
    crowd: Any = scene(T, None, [line(T, (0, 5), (1, 0))], **trips((0, 0, 10, True)))
    spin = driven(T, v=0.0, w=1.0, goal_time=10.0)
    run = dataclasses.replace(spin, agents=crowd.agents, trips=crowd.trips)
    for metric in (TIME, LENGTH):
        found = scores_of(metric, run)["corrected"]
        assert (found.status, found.reason) == ("undefined", "zero_denominator")
    assert value_of(scores_of(LENGTH, run), "literal") == 0


@pytest.mark.parametrize("shared", [True, False])
def test_portals_add_no_length_and_no_displacement(shared: bool) -> None:
    """Two laps of 5 m; trips that meet on a sample, or between two."""
    lap = (T > 5.0) if shared else (T >= 5.0)
    x = T - 5.0 * lap
    jump = (np.diff(x) < 0)[:, None]
    edge = 5.0 if shared else 4.95
    rows = ((0, 0.0, edge, True), (0, edge, 10, True))
    body = Body(x, 0 * T, 0 * T + 1, 0 * T)
    robot = line(T, (0, 5), (1, 0))
    run = scene(T, robot, [body], agent_jump=jump, goal_time=10.0, **trips(*rows))
    found = scores_of(LENGTH, run)
    assert value_of(found) == pytest.approx(1)
    walked = 9.9
    assert value_of(found, "literal") == pytest.approx(10 / (walked / 2))
    displaced = 10.0 if not shared else 5.0 + 4.9 + 0.0
    assert value_of(scores_of(TIME, run)) == pytest.approx(displaced / 10, rel=2e-2)


# ------------------------------------------------------------------------ turning
def turning(robot_rate: float, *rates: float) -> Trajectories:
    """Everybody on circles; headings pass plus and minus pi."""
    t = grid(20)
    lone = driven(t, v=1.0, w=robot_rate)

    def circle(rate: float) -> Body:
        angle: Array = np.asarray(3.0 + rate * t, dtype=np.float64)
        rows = 50 + np.sin(angle) / rate, -np.cos(angle) / rate, np.cos(angle), np.sin(angle)
        return Body(*(np.asarray(row, dtype=np.float64) for row in rows))

    crowd = scene(t, None, [circle(r) for r in rates])
    assert lone.robot is not None
    wrapped = np.angle(np.exp(1j * lone.robot.theta)).astype(np.float64)
    robot = dataclasses.replace(lone.robot, theta=wrapped)
    return dataclasses.replace(lone, robot=robot, agents=crowd.agents)


@pytest.mark.parametrize(
    ("rates", "literal", "corrected"),
    [
        pytest.param((0.4, 0.2, 0.2), 2.0, 2.0, id="d03"),
        pytest.param((0.4, 0.2, -0.2), None, 2.0, id="d04"),
        pytest.param((-0.4, 0.2), -2.0, 2.0, id="i05"),
        pytest.param((0.4, 0.2, 0.6), 1.0, 1.0, id="i06"),
    ],
)
def test_turning(rates: tuple[float, ...], literal: float | None, corrected: float) -> None:
    found = scores_of("heading_similarity", turning(*rates))
    assert value_of(found) == pytest.approx(corrected)
    if literal is None:
        assert why({"literal": found["literal"]}) == {("undefined", "zero_denominator")}
    else:
        assert value_of(found, "literal") == pytest.approx(literal)
        assert found["literal"].extras["coverage"] == 1


def test_who_stands_has_no_heading() -> None:
    t = grid(4)
    slow, fast = 0.1, 0.11
    for speed, status in ((slow, "undefined"), (fast, "ok")):
        vx, vy = (np.asarray(speed * f(t), dtype=np.float64) for f in (np.cos, np.sin))
        body = Body(0 * t, 0 * t + 5, vx, vy)
        run = scene(t, line(t, (0, 0), (1, 0)), [body])
        assert scores_of("heading_similarity", run)["corrected"].status == status
    assert why(scores_of("heading_similarity", scene(t, line(t, (0, 0), (1, 0))))) == {
        ("undefined", "no_agents")
    }
    still = scene(t, line(t, (0, 0), (1, 0)), [line(t, (3, 0), (0, 0))])
    assert why(scores_of("heading_similarity", still)) == {("undefined", "no_heading")}


def test_turning_weighs_time() -> None:
    t = np.array([0.0, 1.0, 4.0])
    theta = np.array([0.0, 0.5, 0.8])
    angle = np.array([0.0, 0.25, 0.85])
    body = Body(0 * t, 0 * t + 5, np.cos(angle), np.sin(angle))
    run = scene(t, line(t, (0, 0), (0, 0)), [body])
    assert run.robot is not None
    run = dataclasses.replace(run, robot=dataclasses.replace(run.robot, theta=theta))
    found = scores_of("heading_similarity", run)
    assert value_of(found, "literal") == pytest.approx((0.5 / 0.25 + 0.1 / 0.2) / 2)
    assert value_of(found) == pytest.approx((0.5 + 0.3) / (0.25 + 0.6))


# ------------------------------------------------------------------------- speeds
def at_speeds(robot: Array, agent: Array, **more: Any) -> Trajectories:
    t = 0.1 * np.arange(len(robot), dtype=np.float64)
    body = Body(0 * t + 1, 0 * t, agent, 0 * t)
    return scene(t, Body(0 * t, 0 * t, robot, 0 * t), [body], **more)


def test_mean_of_ratios_and_ratio_of_means() -> None:  # i09
    agent = np.concatenate([np.full(41, 0.5), np.full(60, 2.0)])
    run = at_speeds(np.ones(101), agent)
    for metric in ("velocity_similarity", "neighbour_velocity_similarity"):
        found = scores_of(metric, run)
        assert value_of(found, "literal") == pytest.approx((41 * 2 + 60 * 0.5) / 101)
        assert value_of(found) == pytest.approx(10 / (0.5 * 4.05 + 2 * 5.95))


def test_moments_without_moving_people_are_skipped() -> None:
    agent = np.concatenate([np.full(50, 0.0), np.full(51, 0.5)])
    found = scores_of("velocity_similarity", at_speeds(np.ones(101), agent))
    assert values(found) == pytest.approx({"literal": 2, "corrected": 2})
    assert found["literal"].extras["coverage"] == pytest.approx(51 / 101)


def test_a_reversing_robot_is_as_fast() -> None:  # j01
    run = at_speeds(np.full(11, 0.5), np.ones(11))
    assert run.robot is not None
    back = dataclasses.replace(run.robot, v=-run.robot.v, theta=run.robot.theta + np.pi)
    found = scores_of("velocity_similarity", dataclasses.replace(run, robot=back))
    assert values(found) == pytest.approx({"literal": 0.5, "corrected": 0.5})


def test_an_omnidirectional_robot_gives_its_velocity() -> None:
    t = grid(2)
    given: dict[str, Any] = {"robot_x": 0 * t, "robot_y": t, "robot_theta": 0 * t}
    run = Trajectories.from_arrays(
        t=t,
        **given,
        robot_vx=0 * t,
        robot_vy=0 * t + 1,
        robot_w=0 * t,
        robot_radius=0.2,
        robot_mass=5.0,
        agent_x=np.zeros((len(t), 1)),
        agent_y=np.full((len(t), 1), 5.0),
        agent_vx=np.full((len(t), 1), 2.0),
        agent_vy=np.zeros((len(t), 1)),
        agent_radius=0.25,
        agent_mass=70.0,
    )
    assert values(scores_of("velocity_similarity", run)) == pytest.approx(
        {"literal": 0.5, "corrected": 0.5}
    )
    assert run.robot is not None
    assert run.robot.v == pytest.approx(0)
    found = scores_of("overtaking_count", run)
    assert found["literal"].status == "ok"
    sideways = dataclasses.replace(run.robot, vx=None, vy=None)
    forward = scores_of("velocity_similarity", dataclasses.replace(run, robot=sideways))
    assert value_of(forward) == 0


def test_only_neighbours_or_everybody() -> None:
    agents = [line(T, (0, 2), (1, 0)), line(T, (0, 50), (3, 0))]
    run = scene(T, line(T, (0, 0), (1, 0)), agents)
    assert value_of(scores_of("velocity_similarity", run)) == pytest.approx(0.5)
    assert value_of(scores_of("neighbour_velocity_similarity", run)) == pytest.approx(1)


def test_reasons_of_speeds() -> None:
    lone = scene(T, line(T, (0, 0), (1, 0)))
    for metric in ("velocity_similarity", "neighbour_velocity_similarity"):
        assert why(scores_of(metric, lone)) == {("undefined", "no_agents")}
        still = scene(T, line(T, (0, 0), (0, 0)), [line(T, (1, 0), (0, 0))])
        assert why(scores_of(metric, still)) == {("undefined", "zero_denominator")}
    far = scene(T, line(T, (0, 0), (1, 0)), [line(T, (0, 9), (1, 0))])
    assert why(scores_of("neighbour_velocity_similarity", far)) == {("undefined", "no_neighbours")}
    late = scene(T, line(T, (0, 0), (1, 0)), [present_during(line(T, (0, 1), (2, 0)), T > 9)])
    assert value_of(scores_of("velocity_similarity", late)) == pytest.approx(0.5)
    for metric in (TIME, LENGTH):
        assert why(scores_of(metric, lone)) == {("undefined", "no_trips")}


# --------------------------------------------------------------------- overtaking
def overtaking(run: Trajectories) -> tuple[float | None, float | None, float]:
    found = scores_of("overtaking_count", run)
    both = found["literal"].value, found["corrected"].value
    return (*both, found["literal"].extras["overtaken_by"])


def test_overtaking() -> None:  # c01, c02, c03
    ahead = [line(T, (2, 1), (0.5, 0)), line(T, (4, -1), (0.5, 0))]
    assert overtaking(scene(T, line(T, (0, 0), (1.5, 0)), ahead)) == (2, 2, 0)
    behind = [line(T, (-2, 1), (1.5, 0)), line(T, (-4, -1), (1.5, 0))]
    assert overtaking(scene(T, line(T, (0, 0), (0.5, 0)), behind)) == (0, 0, 2)
    oncoming = [line(T, (9, 1), (-1, 0)), line(T, (5, -1), (0, 0))]
    assert overtaking(scene(T, line(T, (0, 0), (1, 0)), oncoming)) == (0, 0, 0)


def test_a_swaying_walker() -> None:  # c04
    t = grid(30)
    sway = 0.5 * np.sin(2 * np.pi * (t - 0.025) / 10)
    body = Body(t + sway, 0 * t + 1, 1 + np.pi / 10 * np.cos(2 * np.pi * (t - 0.025) / 10), 0 * t)
    run = scene(t, line(t, (0, 0), (1, 0)), [body])
    assert overtaking(run) == (3, 0, 3)


def test_four_metres_away_nobody_is_overtaken() -> None:  # c05
    for beside, count in ((4.0, 0), (3.0, 1), (2.9, 1)):
        run = scene(T, line(T, (0, 0), (1.5, 0)), [line(T, (2, beside), (0.5, 0))])
        assert overtaking(run)[0] == count


@pytest.mark.parametrize(("angle", "count"), [(40, 1), (45, 1), (50, 0), (-45, 1), (-50, 0)])
def test_the_same_way_within_45_degrees(angle: float, count: int) -> None:
    turn = np.radians(angle)
    velocity = 0.5 * float(np.cos(turn)), 0.5 * float(np.sin(turn))
    run = scene(T, line(T, (0, 0), (1.5, 0)), [line(T, (2, -np.sign(angle)), velocity)])
    assert overtaking(run)[0] == count


def test_turning_around_and_side_by_side_overtake_nobody() -> None:
    t = grid(10)
    there_and_back = polyline(t, [(0, 0, 0), (5, 5, 0), (10, 0, 0)])
    run = scene(t, there_and_back, [line(t, (3, 1), (0.8, 0))])
    assert overtaking(run) == (0, 0, 0)
    noise = np.random.default_rng(0).normal(0, 1e-8, len(t))
    beside = Body(t + noise, 0 * t + 1, 0 * t + 1, 0 * t)
    assert overtaking(scene(t, line(t, (0, 0), (1, 0)), [beside])) == (0, 0, 0)


def test_a_teleport_overtakes_nobody() -> None:
    jumping = line(T, (2, 1), (0.5, 0))
    x = np.where(T > 5, jumping.x - 8, jumping.x)
    run = scene(T, line(T, (0, 0), (0.6, 0)), [Body(x, jumping.y, jumping.vx, jumping.vy)])
    assert overtaking(run)[0] == 0


def test_how_often_people_overtake() -> None:
    agents = [line(T, (2, 1), (0.5, 0)), line(T, (-2, -1), (1.5, 0))]
    found = scores_of("overtaking_count", scene(T, line(T, (0, 0), (1, 0)), agents))
    extras = found["literal"].extras
    # the second overtakes robot and first; the robot the first
    assert (extras["agent_mean"], extras["excess"], extras["overtaken_by"]) == (1, 0, 1)
    lone = scores_of("overtaking_count", scene(T, line(T, (0, 0), (1, 0))))
    assert values(lone) == {"literal": 0, "corrected": 0}
    assert set(lone["literal"].extras) == {"overtaken_by"}


def test_who_misses_his_goal_is_not_alike() -> None:
    """A parked robot among people who stand was as fast as they are, with status ok."""
    crowd = [line(T, (0, 3), (1, 0)), line(T, (0, 5), (1, 0.1))]
    rows = trips((0, 0, 9, True), (1, 0, 10, True))
    away = scene(T, line(T, (0, 0), (1, 0)), crowd, **rows, robot_goal=(99.0, 0.0))
    for metric in ALL_SIMILARITIES:
        found = scores_of(metric, away)["corrected"]
        if found.status == "undefined":
            continue
        assert (found.status, found.reason) == ("censored", "goal_not_reached")
        assert (found.lower, found.upper) == (None, None)
        assert away.robot is not None
        free = dataclasses.replace(away, robot=dataclasses.replace(away.robot, goal=None))
        assert found.extras["so_far"] == scores_of(metric, free)["corrected"].value
