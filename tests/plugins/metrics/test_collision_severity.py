"""collision_severity, expected_severity and what is derived from contacts: hand cases."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.core.trajectories.trajectories import Trajectories
from tests.plugins.metrics.scenes import (
    REACH,
    grid,
    line,
    present_during,
    scene,
    scores_of,
    value_of,
    values,
    why,
)

T = grid(10)
MU = 6.3 * 70 / 76.3


def head_on(dt: float = 0.1, speed: float = 1.0) -> Trajectories:
    t = grid(10, dt)
    return scene(t, line(t, (0, 0), (speed, 0)), [line(t, (10, 0), (-1, 0))])


def test_head_on() -> None:  # b01, b09
    found = values(scores_of("collision_severity", head_on()))
    assert found == {
        "literal": pytest.approx(5 * 38.15 * 4),
        "per_event": pytest.approx(152.6),
        "corrected": pytest.approx(2 * MU),
        "impulse": pytest.approx(2 * MU),
    }
    assert found["corrected"] == pytest.approx(11.5596, abs=1e-4)
    twice = values(scores_of("collision_severity", head_on(0.05)))
    assert twice["literal"] == pytest.approx(1373.4)
    assert {**twice, "literal": found["literal"]} == pytest.approx(found)
    units = {v: s.unit for v, s in scores_of("collision_severity", head_on()).items()}
    assert units == {"literal": "J", "per_event": "J", "corrected": "J", "impulse": "N s"}


def test_hit_while_waiting() -> None:  # b13
    run = scene(T, line(T, (0, 0), (0, 0)), [line(T, (6, 0), (-1.5, 0))])
    assert value_of(scores_of("collision_severity", run)) == pytest.approx(0.5 * MU * 2.25)


def test_crossing() -> None:  # b04: the vector difference, not the one of speeds
    run = scene(T, line(T, (-5, 0), (1, 0)), [line(T, (0, -5), (0, 1))])
    assert value_of(scores_of("collision_severity", run)) == pytest.approx(MU)
    assert value_of(scores_of("expected_severity", run), "literal") == pytest.approx(
        2 * value_of(scores_of("risk", run), "literal")
    )


def test_expected_severity() -> None:  # b01
    found = scores_of("expected_severity", head_on())
    assert values(found) == {
        "literal": pytest.approx(467.52),
        "corrected": pytest.approx(4 * 2.96025),
        "rate": pytest.approx(4 * 0.296025),
    }
    assert found["corrected"].extras["mean"] == pytest.approx(4 * 0.296025)


def test_the_first_contact_gives_the_speed_not_the_fastest() -> None:  # j03
    t = grid(1)
    slow_and_near, fast_and_far = line(t, (2, 0), (-1, 0)), line(t, (20, 0), (-4, 0))
    run = scene(t, line(t, (0, 0), (0, 0)), [fast_and_far, slow_and_near])
    tau = 2 - REACH - t
    assert value_of(scores_of("expected_severity", run), "literal") == pytest.approx(tau.sum())


def test_of_several_first_contacts_the_fastest() -> None:
    t = grid(1)
    robot = line(t, (0, 0), (0, 0))
    one = line(t, (REACH + 2.0, 0), (-1, 0))
    two = line(t, (0, REACH + 4.0), (0, -2))
    run = scene(t, robot, [one, two])
    tau = 2 - t
    found = scores_of("expected_severity", run)
    assert value_of(found, "literal") == pytest.approx(4 * tau.sum())


def test_the_speed_is_the_one_before_the_contact() -> None:
    """Physics stops both at the touch; the step before it counts."""
    t = np.array([0.0, 1.0, 2.0, 3.0])
    agent = line(t, (3, 0), (-1, 0))
    vx = np.array([-1.0, -1.0, -1.0, 0.0])
    run = scene(t, line(t, (0, 0), (0, 0)), [type(agent)(agent.x, agent.y, vx, agent.vy)])
    assert value_of(scores_of("collision_severity", run)) == pytest.approx(0.5 * MU)
    assert value_of(scores_of("collision_severity", run), "literal") == 0


def test_overlap_at_first_sight_has_the_speed_of_that_sample() -> None:
    here = T >= 5
    run = scene(T, line(T, (0, 0), (0, 0)), [present_during(line(T, (0.2, 0), (0, 0)), here)])
    assert value_of(scores_of("collision_severity", run)) == 0
    passing = line(T, (-4.8, 0), (1, 0))
    run = scene(T, line(T, (0, 0), (0, 0)), [present_during(passing, here)])
    assert value_of(scores_of("collision_severity", run)) == pytest.approx(0.5 * MU)


def test_each_has_its_own_mass() -> None:
    agents = [line(T, (5, 0), (-1, 0)), line(T, (-5, 0), (1, 0))]
    run = scene(T, line(T, (0, 0), (0, 0)), agents)
    assert run.agents is not None
    heavy = Trajectories.from_arrays(
        t=T,
        robot_x=0 * T,
        robot_y=0 * T,
        robot_theta=0 * T,
        robot_v=0 * T,
        robot_w=0 * T,
        robot_radius=0.18,
        robot_mass=10.0,
        agent_x=run.agents.x,
        agent_y=run.agents.y,
        agent_vx=run.agents.vx,
        agent_vy=run.agents.vy,
        agent_radius=0.25,
        agent_mass=[10.0, 90.0],
    )
    found = scores_of("collision_severity", heavy)
    assert value_of(found) == pytest.approx(0.5 * 5 + 0.5 * 9)
    assert value_of(found, "per_event") == pytest.approx(10 + 50)
    assert value_of(found, "impulse") == pytest.approx(5 + 9)


def test_rates_and_fault() -> None:
    run = head_on(speed=2.0)
    found = scores_of("collision_rate", run)
    assert values(found) == pytest.approx({"per_time": 0.1, "per_length": 0.05})
    assert values(scores_of("collisions_at_fault", run)) == {"robot": 1, "person": 0}
    waiting = scene(T, line(T, (0, 0), (0, 0)), [line(T, (6, 0), (-1.5, 0))])
    assert values(scores_of("collisions_at_fault", waiting)) == {"robot": 0, "person": 1}
    behind = scene(
        T, line(T, (0, 0), (1, 0)), [line(T, (-2, 0), (0.9, 0)), line(T, (-3, 0), (2, 0))]
    )
    assert values(scores_of("collisions_at_fault", behind)) == {"robot": 0, "person": 1}
    assert scores_of("collision_rate", waiting)["per_length"].reason == "zero_denominator"


def test_times_to_collision() -> None:
    run = head_on()
    assert value_of(scores_of("time_exposed", run)) == pytest.approx(5.25)
    assert value_of(scores_of("integrated_time_to_collision", run)) == pytest.approx(5 * 2.96025)
    assert value_of(scores_of("min_time_to_collision", run)) == 0
    apart = scene(T, line(T, (0, 0), (1, 0)), [line(T, (2, 0), (1, 0))])
    assert scores_of("min_time_to_collision", apart)["corrected"].status == "undefined"
    short = scene(grid(1), line(grid(1), (0, 0), (1, 0)), [line(grid(1), (5, 0), (0, 0))])
    assert value_of(scores_of("min_time_to_collision", short)) == pytest.approx(4 - REACH)


def test_unknown_speeds_add_nothing() -> None:
    run = scene(T, line(T, (0, 0), (0, 0)), [line(T, (5, 0), (-1, 0))], velocities=False)
    assert value_of(scores_of("collision_severity", run)) == pytest.approx(0.5 * MU)
    lone = present_during(line(T, (0.1, 0), (1, 0)), T == 0)
    run = scene(T, line(T, (0, 0), (0, 0)), [lone], velocities=False)
    assert value_of(scores_of("collision_count", run)) == 1
    assert set(values(scores_of("collision_severity", run)).values()) == {0.0}


def test_without_robot() -> None:
    crowd = scene(T, None, [line(T, (0, 0), (1, 0))])
    for metric in (
        "collision_severity",
        "expected_severity",
        "collision_rate",
        "collisions_at_fault",
        "time_exposed",
        "min_time_to_collision",
    ):
        assert why(scores_of(metric, crowd)) == {("undefined", "invalid_no_robot")}
