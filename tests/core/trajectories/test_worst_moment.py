"""The moment to look at first: contacts at fault, then the nearest approach."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.core.trajectories import worst_moment as rule
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.trajectories.worst_moment import worst_moment
from crowdbot.plugins.metrics.fault import ContactsAtFaultSpec

T = np.arange(0.0, 10.0, 0.1)


def run_of(people: list[tuple[Any, Any]], speed: float = 0.5, **more: Any) -> Trajectories:
    """A robot along x; people by their x and y over time; bodies of 0.25 m each."""
    x = np.stack([np.broadcast_to(x, T.shape) for x, _ in people], axis=1)
    y = np.stack([np.broadcast_to(y, T.shape) for _, y in people], axis=1)
    robot: dict[str, Any] = {"robot_x": speed * T, "robot_y": 0 * T, "robot_theta": 0 * T}
    return Trajectories.from_arrays(
        t=T, **robot, robot_v=speed + 0 * T, robot_w=0 * T, robot_radius=0.25, robot_mass=6.0,
        agent_x=x, agent_y=y, agent_radius=0.25, agent_mass=70.0, **more,
    )  # fmt: skip


def test_the_first_contact_that_the_robot_drives_into() -> None:
    found = worst_moment(run_of([(3.0, 0.0), (2.0, 0.0)]))
    assert found is not None
    assert found.what == "contact at fault"
    assert found.t == pytest.approx((2.0 - 0.5) / 0.5, abs=1e-6)  # the nearer one, at the surface
    assert found.clearance is not None
    assert found.clearance <= 0.0


def test_who_walks_into_a_robot_that_stands_makes_the_least_clearance() -> None:
    found = worst_moment(run_of([(3.0 - T, 0.0)], speed=0.0))
    assert found is not None
    assert found.what == "least clearance"
    assert found.t == pytest.approx(3.0, abs=0.05)  # centres meet
    assert found.clearance == pytest.approx(-0.5)


def test_without_contact_the_nearest_approach() -> None:
    found = worst_moment(run_of([(2.0, 1.5), (3.0, 1.0)]))
    assert found is not None
    assert found.what == "least clearance"
    assert found.t == pytest.approx(6.0)
    assert found.clearance == pytest.approx(0.5)


def test_what_happens_after_the_arrival_does_not_count() -> None:
    found = worst_moment(run_of([(3.0, 0.0)], robot_goal_time=2.0))
    assert found is not None
    assert found.what == "least clearance"
    assert found.t <= 2.0


def test_nobody_there() -> None:
    alone = Trajectories.from_arrays(
        t=T, robot_x=T, robot_y=0 * T, robot_theta=0 * T, robot_v=1 + 0 * T, robot_w=0 * T,
        robot_radius=0.2, robot_mass=6.0,
    )  # fmt: skip
    assert worst_moment(alone) is None
    assert worst_moment(run_of([(np.nan, np.nan)])) is None


def test_the_rule_is_that_of_the_metric() -> None:
    spec = ContactsAtFaultSpec.model_validate({})
    assert spec.fault_speed == pytest.approx(rule.RULE.speed)
    assert spec.fault_reaction == rule.RULE.reaction
    assert spec.fault_braking == rule.RULE.braking
    assert spec.fault_margin == rule.RULE.margin
    assert spec.contact_tol == rule.CONTACT_TOL
    assert spec.release_gap == rule.RELEASE_GAP
    assert spec.jump_speed == rule.JUMP_SPEED
