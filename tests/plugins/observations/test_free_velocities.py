"""How free velocities are, by hand: a person who comes towards the robot, and a wall beside it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from crowdbot.core.learning.build import CheckedObserver
from crowdbot.core.learning.seen import LearningContext, RobotInputs
from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.core.types.robot import RobotBody, RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.errors import InputError, PluginError
from crowdbot.plugins.observations.free_velocities import FreeVelocitiesSpec
from crowdbot.plugins.observations.free_velocities_build import FreeVelocities, build

LIMITS = RobotLimits(v_min=-1.0, v_max=1.0, w_max=1.0, a_max=1.0, alpha_max=1.0)
BODY = RobotBody(
    drive="differential", radius=0.2, footprint=None, front=0.2, back=0.2, half_width=0.2
)
#: Three directions, left, ahead and right, at full speed, then to stand.
SPEC = FreeVelocitiesSpec(
    directions=3, widest=np.pi / 2, speeds=1, horizon=4.0, room=0.8, sectors=4, people=2,
    person_radius=0.3, range=6.0, fastest=2.0,
)  # fmt: skip
RIGHT, AHEAD, LEFT, STAND = range(4)


def context(category: str = "lidar") -> LearningContext:
    one = SensorInfo(
        category=category, frame="lidar", mount=(0.1, 0.0, 0.0, 0.0), rate=16.0, shape=(3,),
        ros_type="sensor_msgs/msg/LaserScan", angles=np.array([-np.pi / 2, 0.0, np.pi / 2]),
    )  # fmt: skip
    return LearningContext(worlds=1, limits=LIMITS, body=BODY, sensors={"lidar": one})


def observed(people: Any, ranges: Any, yaw: float = 0.0) -> Any:
    """The observation of a robot at the origin."""
    seen = RobotInputs(
        fresh=np.array([True]),
        stepped=np.array([False]),
        pose=np.array([[0.0, 0.0, yaw]]),
        twist=np.zeros((1, 3)),
        goal=np.array([[5.0, 0.0]]),
        readings={"lidar": np.array([ranges], np.float64)},
        people=np.array([people], np.float64).reshape(1, -1, 5),
    )
    observer = build(SPEC, context())
    (found,) = observer.observe(seen)
    assert found.shape == observer.low.shape
    assert (found >= observer.low).all()
    assert (found <= observer.high).all()
    return found


FREE = [np.inf] * 3


def test_where_there_is_nothing_all_is_free() -> None:
    found = observed([[np.nan] * 5], FREE)
    assert found[:12].tolist() == [1.0] * 12
    assert found[12:22].tolist() == [0.0] * 10


def test_a_person_who_comes_is_met_when_both_have_gone_their_parts() -> None:
    found = observed([[3.5, 0.0, -1.0, 0.0, 0.0]], FREE)
    # Surfaces are 3 m apart, at 2 m/s and, if the robot stands, at 1 m/s.
    assert found[2 * AHEAD] == pytest.approx(1.5 / 4.0)
    assert found[2 * STAND] == pytest.approx(3.0 / 4.0)
    assert found[2 * AHEAD + 1] == found[2 * STAND + 1] == 0.0
    # A robot that goes aside passes at 3.5 / sqrt(2) m between the centres.
    assert found[2 * LEFT] == found[2 * RIGHT] == 1.0
    assert found[2 * LEFT + 1] == 1.0
    assert found[8:12] == pytest.approx([1.0, 1.0, 3.0 / 6.0, 1.0])
    assert found[12:17] == pytest.approx([1.0, 3.5 / 6.0, 0.0, -0.5, 0.0])


def test_a_wall_is_met_and_a_return_of_a_person_is_no_second_body() -> None:
    wall = observed([], [1.2, np.inf, np.inf])
    assert wall[2 * RIGHT] == pytest.approx(np.sqrt(1.2**2 + 0.0) / 4.0 - 0.2 / 4.0, abs=0.01)
    assert wall[2 * LEFT] == 1.0
    alone = observed([[3.5, 0.0, -1.0, 0.0, 0.0]], FREE)
    shown = observed([[3.5, 0.0, -1.0, 0.0, 0.0]], [np.inf, 3.1, np.inf])
    assert np.array_equal(alone, shown)


def test_the_fan_turns_with_the_robot() -> None:
    turned = observed([[0.0, 3.5, 0.0, -1.0, 0.0]], FREE, yaw=np.pi / 2)
    assert turned[:22] == pytest.approx(observed([[3.5, 0.0, -1.0, 0.0, 0.0]], FREE)[:22], abs=1e-6)


def test_it_needs_a_lidar_and_is_not_privileged() -> None:
    assert SPEC.needs == ("lidar",)
    assert not SPEC.privileged
    with pytest.raises(InputError, match="a lidar is wanted"):
        build(SPEC, context("ultrasound"))


class Listed(FreeVelocities):
    """Follows what it is told."""

    def tracker(self) -> Any:
        return lambda obs: obs.rows


@pytest.mark.parametrize("rows", [np.zeros((2, 4)), np.full((1, 5), np.nan)])
def test_a_tracker_that_follows_something_else_is_named(rows: Any) -> None:
    checked = CheckedObserver(Listed(SPEC, context()), 1, PluginCall("mine"))
    follow = checked.tracker()
    assert follow(SimpleNamespace(t=0.0, rows=np.ones((2, 5)))).shape == (2, 5)
    with pytest.raises(PluginError, match=r"followed people of shape .* not \(M, 5\)"):
        follow(SimpleNamespace(t=0.0, rows=rows))
