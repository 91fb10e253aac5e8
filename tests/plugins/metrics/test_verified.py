"""What an acceptance test from the specification alone found: wrong, unsaid or unguarded."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.core.trajectories.commands import Commands
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.errors import InputError
from tests.plugins.metrics.scenes import (
    Body,
    grid,
    line,
    polyline,
    scene,
    scores_of,
    trips,
    value_of,
)

T = grid(10)
STILL = line(T, (0, 0), (0, 0))
TIME, LENGTH = "time_to_goal_similarity", "path_length_similarity"
AHEAD = line(T, (5, 1), (0.5, 0))


def given(**more: Any) -> dict[str, Any]:
    """Arrays of a robot that drives along x at 1 m/s, with its heading along it."""
    zero = np.zeros(len(T))
    robot = {"robot_x": T, "robot_y": zero, "robot_theta": zero, "robot_v": zero + 1}
    body = {"robot_w": zero, "robot_radius": 0.2, "robot_mass": 6.3, "robot_goal_time": 10.0}
    return {"t": T, **robot, **body, **more}


# ------------------------------------------------------------------ displacement
def jumping(at: float, by: float) -> tuple[Body, np.ndarray[Any, np.dtype[np.bool_]]]:
    """Walks along x at 1 m/s, and is moved by ``by`` (m) on the step that ends at ``at`` (s)."""
    late = at - 0.05 < T
    jump = np.zeros((len(T) - 1, 1), dtype=bool)
    jump[int(np.argmax(late)) - 1] = True
    return Body(T + by * late, 0 * T + 5, 0 * T + 1, 0 * T), jump


def test_displacement_is_straight_from_first_to_last_sample() -> None:
    """A teleport within a trip adds no length; first and last sample stay where they are."""
    body, jump = jumping(5.0, 10.0)
    rows = trips((0, 0, 10, True))
    run = scene(T, line(T, (0, 0), (1, 0)), [body], agent_jump=jump, goal_time=10.0, **rows)
    assert value_of(scores_of(TIME, run)) == pytest.approx(2.0)
    assert value_of(scores_of(LENGTH, run)) == pytest.approx(20 / 9.9)


def test_displacement_of_a_robot_that_was_moved() -> None:
    body = polyline(T, [(0, 0, 0), (4.9, 4.9, 0), (5.0, 15, 0), (10, 20, 0)])
    walker = line(T, (0, 5), (1, 0))
    run = scene(T, body, [walker], goal_time=10.0, **trips((0, 0, 10, True)))
    assert value_of(scores_of(TIME, run)) == pytest.approx(0.5)
    assert value_of(scores_of(LENGTH, run)) == pytest.approx(9.9 / 20)


@pytest.mark.parametrize("portal", [4.9, 5.0])
def test_a_sample_at_a_portal_belongs_to_one_trip(portal: float) -> None:
    """Both trips hold the sample; each walks on its own side of the jump."""
    body, jump = jumping(5.0, -5.0)
    rows = trips((0, 0, portal, True), (0, portal, 10, True))
    run = scene(T, line(T, (0, 0), (1, 0)), [body], agent_jump=jump, goal_time=10.0, **rows)
    assert value_of(scores_of(LENGTH, run)) == pytest.approx(1.0)
    assert value_of(scores_of(TIME, run)) == pytest.approx(9.9 / 10)


# ------------------------------------------------------------------------- input
@pytest.mark.parametrize("left_out", [("robot_v",), ("robot_w",), ("robot_v", "robot_w")])
def test_velocities_of_the_robot_may_be_left_out(left_out: tuple[str, ...]) -> None:
    turn = 0.1 * T
    curved = {
        "robot_x": np.sin(turn) / 0.1,
        "robot_y": (1 - np.cos(turn)) / 0.1,
        "robot_theta": turn,
        "robot_w": 0 * T + 0.1,
    }
    crowd = {f"agent_{n}": getattr(AHEAD, n)[:, None] for n in ("x", "y", "vx", "vy")}
    full = given(**curved, **crowd, agent_radius=0.25, agent_mass=70.0)
    known = Trajectories.from_arrays(**full)
    derived = Trajectories.from_arrays(**{k: v for k, v in full.items() if k not in left_out})
    for metric in ("velocity_similarity", "relative_path_length", "avg_clearance"):
        one, other = (scores_of(metric, run, known) for run in (known, derived))
        assert value_of(other) == pytest.approx(value_of(one), rel=1e-3)
    assert scores_of("time_not_moving", derived)["corrected"].value == 0


@pytest.mark.parametrize(("t0", "t1"), [(9.0, 3.0), (0.0, np.nan), (np.nan, 3.0)])
def test_a_trip_that_ends_before_it_begins_is_an_error(t0: float, t1: float) -> None:
    with pytest.raises(InputError, match="trip_t1"):
        scene(T, STILL, [AHEAD], **trips((0, t0, t1, True)))


def test_a_trip_of_no_length_in_time_is_none() -> None:
    assert scene(T, STILL, [AHEAD], **trips((0, 3, 3, True))).trips is not None


def test_text_for_numbers_is_an_error() -> None:
    with pytest.raises(InputError, match="not an array of numbers"):
        scene(T, STILL, [AHEAD], agent_id=["anna"])


# ------------------------------------------------------ edges that nothing guarded
def test_a_neighbour_at_the_last_sample_of_a_trip() -> None:
    """Within 3 m from 8 s on, and the trip ends there."""
    agents = [line(T, (11, 0), (-1, 0)), line(T, (0, 50), (1, 0))]
    rows = ((1, 0, 5, True),)
    at, before = (
        scores_of(
            "neighbours_time_to_goal", scene(T, STILL, agents, **trips((0, 0, e, True), *rows))
        )
        for e in (8.0, 7.9)
    )
    assert value_of(at) == pytest.approx(8 / 6.5)
    assert before["corrected"].reason == "no_neighbours"


def test_durations_are_compared_to_the_nanosecond() -> None:
    """At a tie completions come before censorings: 6 + 2/3 of 2 s, against 6 + 1/2 of 2 s."""
    agents = [line(T, (0, 20 + i), (1, 0)) for i in range(3)]
    rows = trips((0, 0, 6 + 1e-10, True), (1, 0, 6, False), (2, 0, 8, True))
    one = scene(T, None, agents, **rows)
    other = scene(T, None, agents[:1], **trips((0, 0, 8, True)))
    found = scores_of("effect_on_time", one, crowd_alone=other)
    assert value_of(found) == pytest.approx(8 / (6 + 2 * 2 / 3))


def test_the_horizon_is_not_within_the_horizon() -> None:
    """Gap 30/6 = 5 m at 1 m/s, in numbers without rounding: exactly 5 s."""
    body = Body(0 * T + 5.5, 0 * T, 0 * T - 1, 0 * T)
    still = given(robot_x=0 * T, robot_v=0 * T, robot_radius=0.25)
    people = {f"agent_{n}": getattr(body, n)[:, None] for n in ("x", "y", "vx", "vy")}
    run = Trajectories.from_arrays(**still, **people, agent_radius=0.25, agent_mass=70.0)
    assert value_of(scores_of("risk", run), "literal") == pytest.approx(5.0 * len(T))
    assert value_of(scores_of("risk", run), "exposed_time") == 0
    assert value_of(scores_of("time_exposed", run)) == 0
    assert value_of(scores_of("risk", run, risk_horizon=5.001), "exposed_time") == 10


@pytest.mark.parametrize(("side", "count"), [(0.04, 0), (-0.04, 1)])
def test_the_side_is_measured_when_it_is_overtaken(side: float, count: int) -> None:
    """Level between 2 s and 2.1 s; 3 m to the side is crossed on that very step."""
    drift = 3.0 + side * (T - 2.05) / 0.1
    body = Body(2.05 + 0 * T + 0.5 * (T - 2.05), drift, 0 * T + 0.5, 0 * T + side / 0.1)
    run = scene(T, line(T, (0, 0), (1, 0)), [body])
    assert value_of(scores_of("overtaking_count", run), "literal") == count


@pytest.mark.parametrize(("distance", "status"), [(5e-7, "undefined"), (2e-6, "ok")])
def test_a_distance_of_almost_nothing_has_no_inverse(distance: float, status: str) -> None:
    found = scores_of("proximity", scene(T, STILL, [line(T, (distance, 0), (0, 0))]))
    assert found["literal"].status == status
    assert value_of(found) == pytest.approx(10.0)


@pytest.mark.parametrize(("last", "status"), [(0, "undefined"), (1, "ok"), (2, "undefined")])
def test_weights_are_those_of_fifteen_pairs(last: int, status: str) -> None:
    form = {"ratings": [50] * 6, "weights": [5, 0, 3, 2, 4, last]}
    found = scores_of("nasa_tlx", None, questionnaires={"nasa_tlx": form})
    assert found["weighted"].status == status
    assert found["raw"].value == 50


def test_half_a_turn_is_to_the_left() -> None:
    """Differences of headings lie in (-pi, pi]: -pi is pi."""
    theta = np.where(T < 5, 0.0, -np.pi)
    bend = 0.2 * T
    crowd = {
        "agent_x": np.sin(bend)[:, None] / 0.2,
        "agent_y": -np.cos(bend)[:, None] / 0.2,
        "agent_vx": np.cos(bend)[:, None],
        "agent_vy": np.sin(bend)[:, None],
    }
    turning = given(robot_theta=theta, **crowd, agent_radius=0.25, agent_mass=70.0)
    found = scores_of("heading_similarity", Trajectories.from_arrays(**turning))
    assert value_of(found, "literal") == pytest.approx(np.pi / 0.2 / 10)


@pytest.mark.parametrize(("behind", "count"), [(5e-7, 0), (5e-6, 1)])
def test_level_is_not_behind(behind: float, count: int) -> None:
    """The record ends when the walker is level with the robot, or just behind it."""
    walker = Body(10 - behind - 0.5 * (10 - T), 0 * T + 1, 0 * T + 0.5, 0 * T)
    run = scene(T, line(T, (0, 0), (1, 0)), [walker])
    assert value_of(scores_of("overtaking_count", run), "literal") == count


def test_the_rate_of_variation_does_not_depend_on_sampling() -> None:
    """Each command given once, or repeated while it holds, the last one too."""
    t, v = np.arange(5) * 0.2, np.array([0.0, 1.0, 0.5, 0.5, 1.0])
    once, twice = (
        Commands.from_arrays(
            t=times, v_user=u, w_user=-u, v_sc=u, w_sc=u, v_max=1.0, w_max=2.0, t_end=1.0
        )
        for times, u in ((t, v), (np.arange(10) * 0.1, np.repeat(v, 2)))
    )
    rates = [
        value_of(scores_of("fluency", None, commands=c), "variation_rate") for c in (once, twice)
    ]
    assert rates == pytest.approx([2.0 * np.hypot(1.0, 0.5)] * 2)


def test_one_pause_of_the_record_is_no_other_sampling_rate() -> None:
    """The median step is what both runs must share."""
    t = np.concatenate([T, [10.0 + 3.0]])
    runs = [
        Trajectories.from_arrays(
            t=times,
            robot_x=times,
            robot_y=0 * times,
            robot_theta=0 * times,
            robot_v=np.sin(times),
            robot_w=np.cos(times),
            robot_radius=0.2,
            robot_mass=6.3,
            robot_goal_time=times[-1],
        )
        for times in (T, t, T[:2])
    ]
    assert {s.status for s in scores_of("relative_jerk", runs[1], runs[0]).values()} == {"ok"}
    short = {s.reason for s in scores_of("relative_jerk", runs[0], runs[2]).values()}
    assert short == {"too_few_samples"}
