"""Lidar points in the base frame."""

import math

import numpy as np
import pytest

from crowdbot.core.sensing.points import LidarPoints
from crowdbot.plugin import Reading, SensorInfo


def lidar(angles: list[float], mount: tuple[float, float, float, float]) -> SensorInfo:
    return SensorInfo(
        category="lidar",
        frame="lidar",
        mount=mount,
        rate=16.0,
        shape=(len(angles),),
        ros_type="sensor_msgs/msg/LaserScan",
        angles=np.array(angles),
    )


FRONT = lidar([-math.pi / 2, 0.0, math.pi / 2], (0.2, 0.1, 0.3, 0.0))
REAR = lidar([0.0], (-0.2, 0.0, 0.3, math.pi))
ODOMETRY = SensorInfo(
    category="odometry", frame="odom", mount=(0, 0, 0, 0), rate=64.0, shape=(5,), ros_type="x"
)


def test_mounts_and_misses() -> None:
    points = LidarPoints({"front": FRONT, "odometry": ODOMETRY, "rear": REAR})
    assert len(points) == 2
    readings = {
        "front": Reading(0.0, np.array([1.0, np.inf, 2.0])),
        "rear": Reading(0.0, np.array([3.0])),
    }
    got = points(readings, 0.0, (0.0, 0.0))
    np.testing.assert_allclose(got, [[0.2, -0.9], [0.2, 2.1], [-3.2, 0.0]], atol=1e-12)


def test_a_lidar_that_has_not_read_yet() -> None:
    points = LidarPoints({"front": FRONT})
    assert points({}, 0.0, (0.0, 0.0)).shape == (0, 2)


def test_old_scans_move_with_the_robot() -> None:
    """A wall point 3 m behind is 3.05 m behind after 0.1 s at 0.5 m/s."""
    points = LidarPoints({"rear": REAR})
    got = points({"rear": Reading(1.0, np.array([2.8]))}, 1.1, (0.5, 0.0))
    assert got[0] == pytest.approx([-3.05, 0.0], abs=1e-12)


def test_old_scans_turn_with_the_robot() -> None:
    points = LidarPoints({"rear": REAR})
    got = points({"rear": Reading(0.0, np.array([2.8]))}, 0.5, (0.0, 1.0))
    assert got[0] == pytest.approx([-3.0 * math.cos(0.5), 3.0 * math.sin(0.5)], abs=1e-12)


def test_a_scan_of_another_lidar_is_refused() -> None:
    points = LidarPoints({"front": FRONT})
    with pytest.raises(ValueError, match="its lidar has 3 beams"):
        points({"front": Reading(0.0, np.ones(4))}, 0.0, (0.0, 0.0))
