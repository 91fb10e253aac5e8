"""collision_count: hand cases and failures."""

import dataclasses
from typing import Any

import numpy as np
import pytest

from crowdbot.core.trajectories.encounters import contact_onsets, encounter
from crowdbot.core.trajectories.tracks import ContactEvents
from crowdbot.core.trajectories.trajectories import Trajectories
from tests.plugins.metrics.scenes import (
    REACH,
    Body,
    grid,
    line,
    polyline,
    present_during,
    scene,
    scores_of,
    with_columns,
)

T = grid(10)
STILL = line(T, (0, 0), (0, 0))


def counts(run: Trajectories, **fields: Any) -> tuple[float | None, float | None]:
    found = scores_of("collision_count", run, **fields)
    return found["literal"].value, found["corrected"].value


def at_gaps(gaps: list[float], dt: float = 0.1) -> Trajectories:
    """A robot that stands, and somebody at these gaps between the surfaces."""
    t = np.arange(len(gaps), dtype=np.float64) * dt
    zero = np.zeros(len(t))
    body = Body(REACH + np.array(gaps), zero, zero, zero)
    return scene(t, line(t, (0, 0), (0, 0)), [body])


def head_on(dt: float = 0.1, *, start: float = 10.0, speed: float = 1.0) -> Trajectories:
    t = grid(10, dt)
    return scene(t, line(t, (0, 0), (speed, 0)), [line(t, (start, 0), (-speed, 0))])


def test_head_on() -> None:  # b01
    assert counts(head_on()) == (1, 1)
    found = scores_of("collision_count", head_on())["corrected"]
    assert found.extras["first_time"] == pytest.approx(4.785)


def test_the_sampling_rate_does_not_matter() -> None:
    for dt in (0.1, 0.05, 0.025, 0.2):
        assert counts(head_on(dt))[1] == 1


def test_two_at_once_are_two() -> None:  # b10
    agents = [line(T, (5, 0.2), (-1, 0)), line(T, (5, -0.2), (-1, 0))]
    assert counts(scene(T, STILL, agents)) == (2, 2)


def test_one_bump_that_flickers_is_one() -> None:  # b11
    assert counts(at_gaps([0.2, -0.01, 0.01, -0.01, 0.03, -0.01, 0.2])) == (3, 1)


def test_three_bumps_are_three() -> None:  # b12
    assert counts(at_gaps([0.2, -0.01, 0.2, -0.01, 0.06, -0.01, -0.02, 0.2])) == (3, 3)


def test_the_release_gap() -> None:
    gaps = [0.2, -0.01, 0.08, -0.01, 0.2]
    assert counts(at_gaps(gaps)) == (2, 2)
    assert counts(at_gaps(gaps), release_gap="10 cm") == (2, 1)
    assert counts(at_gaps([0.2, -0.01, 0.05, -0.01, 0.2])) == (2, 1)
    assert counts(at_gaps([0.2, -0.01, 0.0501, -0.01, 0.2])) == (2, 2)


def test_a_release_needs_a_sample_of_its_own() -> None:
    """In contact, out beyond the gap, back in: the gap at the sample between decides."""
    assert counts(at_gaps([-0.01, 0.04, 0.04, 0.04, -0.01])) == (2, 1)
    assert counts(at_gaps([-0.01, 0.04, 0.06, 0.04, -0.01])) == (2, 2)


def test_tunnelling_between_two_samples() -> None:  # b08
    t = np.array([0.0, 0.5, 1.0, 1.5])
    run = scene(t, line(t, (0, 0), (0, 0)), [line(t, (3.75, 0), (-5, 0))])
    assert counts(run) == (0, 1)
    onset = scores_of("collision_count", run)["corrected"].extras["first_time"]
    assert onset == pytest.approx((3.75 - REACH) / 5)


def test_both_bodies_move_between_two_samples() -> None:
    """They swap places; neither path alone meets the other's samples."""
    t = np.array([0.0, 1.0])
    run = scene(t, line(t, (-1, 0), (2, 0)), [line(t, (1, 0.1), (-2, 0))])
    assert counts(run) == (0, 1)
    beside = scene(t, line(t, (-1, 0), (2, 0)), [line(t, (1, 0.5), (-2, 0))])
    assert counts(beside) == (0, 0)


def test_convoys_do_not_collide() -> None:
    run = scene(T, line(T, (0, 0), (1, 0)), [line(T, (REACH + 0.01, 0), (1, 0))])
    assert counts(run) == (0, 0)


def test_touching_is_colliding() -> None:
    assert counts(at_gaps([0.2, 0.0, 0.2])) == (1, 1)
    assert counts(at_gaps([0.2, 1e-10, 0.2])) == (1, 1)
    assert counts(at_gaps([0.2, 1e-6, 0.2])) == (0, 0)
    assert counts(at_gaps([0.2, 1e-6, 0.2]), contact_tol="0.01 mm") == (1, 1)


def test_grazing_is_colliding() -> None:
    """Nearest exactly at a touch, between two samples."""
    t = np.array([0.0, 0.7, 1.3, 2.0])
    run = scene(t, line(t, (0, 0), (0, 0)), [line(t, (-1, REACH), (1, 0))])
    assert counts(run) == (0, 1)
    onset = scores_of("collision_count", run)["corrected"].extras["first_time"]
    assert onset == pytest.approx(1.0)


def test_initial_overlap() -> None:  # b07
    agent = line(T, (0.2, 0), (1, 0))
    run = scene(T, STILL, [agent])
    assert counts(run) == (1, 1)
    assert scores_of("collision_count", run)["corrected"].extras["first_time"] == 0


def test_nothing_after_the_arrival() -> None:  # e09
    run = head_on()
    assert run.robot is not None
    for goal_time, count in ((4.7, 0), (4.79, 0), (4.8, 1)):
        robot = dataclasses.replace(run.robot, goal_time=goal_time)
        assert counts(dataclasses.replace(run, robot=robot)) == (count, count)


def test_radii_of_robot_and_person_count() -> None:
    t = grid(1)
    still = line(t, (0, 0), (0, 0))
    agents = [line(t, (0.6, 0), (0, 0)), line(t, (0, 0.6), (0, 0))]
    assert counts(scene(t, still, agents, agent_radius=[0.41, 0.43])) == (1, 1)
    assert counts(scene(t, still, agents, agent_radius=[0.43, 0.43])) == (2, 2)


def test_absence_ends_a_contact() -> None:
    here = np.abs(T - 5) > 0.05
    run = scene(T, STILL, [present_during(line(T, (0.2, 0), (0, 0)), here)])
    assert counts(run) == (2, 2)
    body = dataclasses.replace(STILL, x=np.where(here, 0.0, np.nan))
    assert counts(scene(T, body, [line(T, (0.2, 0), (0, 0))])) == (2, 2)


def test_a_teleport_ends_a_contact_and_touches_nobody_on_its_way() -> None:
    jump = np.zeros((len(T) - 1, 1), dtype=bool)
    jump[49] = True
    over = polyline(T, [(0, 2, 0), (4.9, 2, 0), (5.0, -2, 0), (10, -2, 0)])
    assert counts(scene(T, STILL, [over])) == (0, 0)  # 40 m/s
    assert counts(scene(T, STILL, [over], agent_jump=jump)) == (0, 0)
    assert counts(scene(T, STILL, [over], agent_jump=~jump & False)) == (0, 1)
    stays = line(T, (0.2, 0), (0, 0))
    assert counts(scene(T, STILL, [stays], agent_jump=jump)) == (2, 2)


def test_landing_on_the_robot_is_one() -> None:
    jump = np.zeros((len(T) - 1, 1), dtype=bool)
    jump[49] = True
    lands = polyline(T, [(0, 9, 0), (4.9, 9, 0), (5.0, 0.2, 0), (10, 0.2, 0)])
    found = scores_of("collision_count", scene(T, STILL, [lands], agent_jump=jump))
    assert [s.value for s in found.values()] == [1, 1]
    assert found["corrected"].extras["first_time"] == pytest.approx(5.0)


def test_a_teleporting_robot_touches_nobody_on_its_way() -> None:
    body = polyline(T, [(0, 0, 0), (4.9, 0, 0), (5.0, 8, 0), (10, 8, 0)])
    assert counts(scene(T, body, [line(T, (4, 0), (0, 0))])) == (0, 0)
    assert counts(scene(T, body, [line(T, (4, 0), (0, 0))]), jump_speed=100.0) == (0, 1)


def test_onsets_name_the_person_and_the_sample_before() -> None:
    agents = [line(T, (8, 0), (-1, 0)), line(T, (5, 0), (-1, 0)), line(T, (0.1, 0), (0, 0))]
    run = scene(T, STILL, agents)
    assert run.robot is not None
    assert run.agents is not None
    pair = encounter(run, 10.0)
    onsets = contact_onsets(pair, contact_tol=1e-9, release_gap=0.05)
    assert onsets.agent.tolist() == [2, 1, 0]
    assert onsets.time == pytest.approx([0, 5 - REACH, 8 - REACH])
    assert onsets.sample.tolist() == [0, 45, 75]


def test_no_people_no_collisions() -> None:
    for nobody in (scene(T, STILL), with_columns(head_on(), [])):
        found = scores_of("collision_count", nobody)
        assert [(s.status, s.value) for s in found.values()] == [("ok", 0.0)] * 2
        assert not found["corrected"].extras


def test_one_sample() -> None:
    assert counts(at_gaps([-0.1])) == (1, 1)
    assert counts(at_gaps([0.1])) == (0, 0)


def test_reasons() -> None:
    found = scores_of("collision_count", scene(T, None, [STILL]))
    assert {(s.status, s.reason) for s in found.values()} == {("undefined", "invalid_no_robot")}


# ------------------------------------------------------------- the table of contacts
def with_table(run: Trajectories, *rows: tuple[float, float, int, float]) -> Trajectories:
    """Onset, end, person, relative speed."""
    columns = np.array(rows, dtype=np.float64).reshape(-1, 4).T
    t0, t1, agent, speed = columns
    return dataclasses.replace(
        run,
        contacts=ContactEvents(
            t0=t0,
            t1=t1,
            agent=agent.astype(np.int64),
            impulse=t0 * 0 + 1.0,
            peak_force=t0 * 0 + 1.0,
            relative_speed=speed,
            bearing=t0 * np.nan,
        ),
    )


def test_a_bounce_of_30_ms_between_two_samples_is_counted() -> None:
    """No sample is in contact, nor is the straight line between two of them."""
    run = at_gaps([0.2, 0.02, 0.02, 0.2], dt=1 / 16)
    assert counts(run) == (0, 0)
    bounced = with_table(run, (0.08, 0.11, 0, 0.9))
    assert counts(bounced) == (0, 1)
    found = scores_of("collision_severity", bounced)
    reduced = 6.3 * 70.0 / 76.3
    assert found["corrected"].value == pytest.approx(0.5 * reduced * 0.9**2)
    assert found["impulse"].value == pytest.approx(reduced * 0.9)
    assert scores_of("success_no_collision", bounced)["corrected"].reason == "invalid_no_goal"
    there = dataclasses.replace(bounced, goal_zone=np.array([[0.0, -1], [1, -1], [1, 1]]))
    assert scores_of("success_no_collision", there)["corrected"].value == 0
    rate = scores_of("collision_rate", bounced)["per_time"].value
    assert rate == pytest.approx(1 / (run.t[-1] - run.t[0]))


def test_the_table_is_the_truth_where_there_is_one() -> None:
    """An empty table says that nothing was felt; walls are not people."""
    assert counts(with_table(head_on())) == (1, 0)
    assert counts(with_table(head_on(), (2.0, 2.1, -1, 1.0))) == (1, 0)
    assert counts(with_table(head_on(), (2.0, 2.1, 0, 1.0), (3.0, 3.1, 0, 1.0))) == (1, 2)


def test_contacts_with_somebody_who_is_not_in_the_table_of_people() -> None:
    run = with_table(head_on(), (2.0, 2.1, 77, 1.0))
    assert counts(run) == (1, 1)
    assert scores_of("collision_severity", run)["corrected"].value == 0
    fault = scores_of("collisions_at_fault", run)
    assert (fault["robot"].value, fault["person"].value) == (0, 1)
