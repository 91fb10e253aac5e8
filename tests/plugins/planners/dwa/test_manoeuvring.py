"""A manoeuvre goes on while it can be driven; what no lidar looks at stays remembered."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import crowdbot.plugins.planners.dwa.parameters_build as entries
from crowdbot.plugin import Array, Observation, Pose, Reading, RobotLimits, SensorInfo
from crowdbot.plugins.planners.dwa.dead_ends.lidar_views_build import LidarViews
from crowdbot.plugins.planners.dwa.dead_ends.manoeuvring_build import Manoeuvring
from tests.plugins.planners.dwa.test_outlines import BOX, REACH, parameters, wall_with_door

LIMITS = RobotLimits(v_min=-1.5, v_max=1.5, w_max=1.5, a_max=1.0, alpha_max=2.0)
ANGLES = np.radians(np.arange(-120.0, 120.5, 0.5))


def lidar(x: float = 0.0, y: float = 0.0, yaw: float = 0.0) -> SensorInfo:
    return SensorInfo(
        category="lidar", frame="lidar", mount=(x, y, 0.25, yaw), rate=16.0, shape=(len(ANGLES),),
        ros_type="sensor_msgs/msg/LaserScan", angles=ANGLES,
    )  # fmt: skip


def scan(ranges: float | Array) -> dict[str, Reading]:
    return {"lidar": Reading(0.0, np.broadcast_to(ranges, ANGLES.shape).astype(np.float64))}


@given(
    st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(-4.0, 4.0)),
    st.floats(-3.1, 3.1), st.floats(0.2, 5.0), st.floats(0.5, 5.0), st.floats(-3.1, 3.1),
)  # fmt: skip
def test_what_lies_in_view_and_far_before_the_range_is_seen_past(
    pose: tuple[float, float, float], bearing: float, away: float, seen: float, yaw: float
) -> None:
    """A lidar at a corner that sees equally far everywhere; a point at a bearing from it."""
    views, at = LidarViews({"lidar": lidar(0.45, 0.28, yaw)}), Pose(*pose)
    c, s = math.cos(at.yaw), math.sin(at.yaw)
    x, y = at.x + c * 0.45 - s * 0.28, at.y + s * 0.45 + c * 0.28
    way = at.yaw + yaw + bearing
    point = np.array([[x + away * math.cos(way), y + away * math.sin(way)]])
    if min(abs(abs(bearing) - math.radians(120.0)), abs(away + 0.4 - seen)) < 0.01:
        return
    expected = abs(bearing) < math.radians(120.0) and away + 0.4 < seen
    assert views.past(scan(seen), at, point)[0] == expected


def test_a_wall_beside_the_door_that_a_lidar_looks_through_is_not_gone() -> None:
    """The robot's middle would look past it; the lidar, in the door already, does not see it."""
    views = LidarViews({"lidar": lidar(0.53, 0.0)})
    wall = np.array([[2.0, 1.0]])
    ranges = np.where(np.abs(ANGLES) < 1.5, 9.0, 0.45)  # jambs on both sides
    assert not views.past(scan(ranges), Pose(1.5, 0.0, 0.0), wall)[0]
    assert views.past(scan(9.0), Pose(1.5, 0.0, 0.0), wall)[0]


def test_beams_just_beside_a_body_do_not_show_that_it_is_gone() -> None:
    views = LidarViews({"lidar": lidar()})
    ranges = np.where(np.abs(ANGLES) < math.radians(2.0), 1.0, 9.0)
    at = np.array([[math.cos(a), math.sin(a)] for a in np.radians([0.0, 4.0, 12.0])])
    assert views.past(scan(ranges), Pose(0.0, 0.0, 0.0), at).tolist() == [False, False, True]


def test_sensors_that_tell_nothing_see_past_nothing() -> None:
    views = LidarViews({"lidar": lidar(), "us": lidar()})
    assert not views.past({}, Pose(0.0, 0.0, 0.0), np.ones((3, 2))).any()


@pytest.fixture
def chair() -> Manoeuvring:
    p = parameters()
    p[entries.PERIOD] = 1.0 / 16.0
    return Manoeuvring(BOX, p, LIMITS, LidarViews({}), 0.33, 6.0)


def observe(t: float, pose: Pose) -> Observation:
    return Observation(
        t=t, pose=pose, twist=(0.0, 0.0), goal=(5.0, 0.0), goal_zone=np.zeros((4, 2)), readings={}
    )


def refuse(chair: Manoeuvring, monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """From now on no way is found; a list that grows whenever one is looked for."""
    asked: list[int] = []

    def plan(*_: object) -> Array:
        asked.append(1)
        return np.empty((0, 4))

    monkeypatch.setattr(chair, "_plan", plan)
    return asked


def test_a_way_that_can_be_driven_is_kept(
    chair: Manoeuvring, monkeypatch: pytest.MonkeyPatch
) -> None:
    """However old it is, and when no other way is found from where the robot is by then."""
    wall, pose = wall_with_door(0.9), Pose(0.5, 0.0, 0.3)
    inside = wall - (pose.x, pose.y)
    c, s = math.cos(pose.yaw), math.sin(pose.yaw)
    seen, nobody = inside @ np.array([[c, -s], [s, c]]), np.empty((0, 4))
    assert chair.command(observe(0.0, pose), seen, nobody) is not None
    asked = refuse(chair, monkeypatch)
    for k in range(1, 40):
        assert chair.command(observe(0.5 * k, pose), seen, nobody) is not None
    assert not asked
    beside = chair.beside(pose)
    assert len(beside) == 0 or np.hypot(*beside.T).max() < REACH + 0.4


def test_one_that_is_held_looks_for_another_way_and_keeps_its_own_if_there_is_none(
    chair: Manoeuvring, monkeypatch: pytest.MonkeyPatch
) -> None:
    pose, nobody = Pose(0.5, 0.0, 0.0), np.empty((0, 4))
    wall = wall_with_door(0.9) - (pose.x, pose.y)
    assert chair.command(observe(0.0, pose), wall, nobody) is not None
    asked = refuse(chair, monkeypatch)
    somebody = np.array([[0.9, 0.0, 0.0, 0.0]])  # right ahead
    for k in range(1, 16 * 12):
        command = chair.command(observe(k / 16.0, pose), wall, somebody)
        assert command is not None
        assert command[0] <= 0.0
    assert asked
    assert chair
