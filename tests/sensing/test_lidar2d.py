"""The planar lidar."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from crowdbot.core.interfaces import Pose, RobotState
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.scene import Scene
from crowdbot.dsl.base import Mount
from crowdbot.plugins.sensors.lidar2d import LIDAR2D, Lidar2dSpec
from crowdbot.plugins.sensors.lidar2d_build import Lidar2d, build

Array = NDArray[np.float64]
ORIGIN = Pose(0, 0, 0)
WALLS = [[3.0, -9.0, 3.0, 9.0]]


def scene_of(*people: tuple[float, float], z: float | None = 0.0102) -> Scene:
    xyv = np.zeros((len(people), 4))
    xyv[:, :2] = np.reshape(people, (-1, 2))
    scene = Scene(WALLS, [0.0, 2.5], np.full(len(people), 0.33), 1.7)
    robot = None if z is None else RobotState(0, 0, 0, 0, 0, 0, 0, z, 0, 0)
    scene.update(robot, xyv, np.ones(len(people), dtype=np.bool_))
    return scene


def read(lidar: Lidar2d, scene: Scene, pose: Pose = ORIGIN, tick: int = 0) -> Array:
    return lidar.read(scene, pose, tick / 128, sensor_rng(0, "robot", "lidar", tick))


def test_info_of_the_challenge() -> None:
    info = build(Lidar2dSpec(mount=Mount(x=0.17, z=0.24))).info()
    assert (info.category, info.ros_type) == ("lidar", "sensor_msgs/msg/LaserScan")
    assert info.angles is not None
    assert info.shape == (480,) == info.angles.shape
    assert info.angles[0] == pytest.approx(math.radians(-120))
    assert info.angles[-1] == pytest.approx(math.radians(119.5))
    assert info.mount == (0.17, 0.0, 0.24, 0.0)
    assert LIDAR2D.load_build() is build


@pytest.mark.parametrize("yaw", [0.0, 0.4, -2.0])
def test_wall_seen_at_the_right_angles(yaw: float) -> None:
    lidar = build(Lidar2dSpec(mount=Mount(x=0.1, y=0.05, yaw=0.3), noise=0.0, range_max=5.0))
    scan, angles = read(lidar, scene_of(), Pose(0.5, -0.2, yaw)), lidar.info().angles
    assert angles is not None
    x = 0.5 + 0.1 * math.cos(yaw) - 0.05 * math.sin(yaw)
    heading = yaw + 0.3 + angles
    with np.errstate(divide="ignore"):
        expected = np.where(np.cos(heading) > 0, (3.0 - x) / np.cos(heading), np.inf)
    expected[expected > 5.0] = np.inf
    np.testing.assert_allclose(scan, expected, atol=1e-9)


def test_rear_lidar_sees_what_is_behind() -> None:
    rear = build(Lidar2dSpec(mount=Mount(x=-0.17, yaw=math.pi), noise=0.0))
    assert read(rear, scene_of((-2.0, 0.0)))[240] == pytest.approx(2.0 - 0.17 - 0.33)


def test_noise_only_on_hits_and_of_the_right_size() -> None:
    lidar = build(Lidar2dSpec(noise=0.01, range_max=5.0))
    clean = read(build(Lidar2dSpec(noise=0.0, range_max=5.0)), scene_of())
    errors = []
    for tick in range(200):
        scan = read(lidar, scene_of(), tick=tick)
        np.testing.assert_array_equal(np.isinf(scan), np.isinf(clean))
        inner = clean < 4.9
        errors.append(scan[inner] - clean[inner])
    error = np.concatenate(errors)
    assert abs(error.mean()) < 4 * 0.01 / math.sqrt(error.size)
    assert error.std() == pytest.approx(0.01, rel=0.02)


def test_readings_stay_within_range() -> None:
    lidar = build(Lidar2dSpec(noise=0.5, range_min=0.1, range_max=3.1))
    scan = read(lidar, scene_of((0.0, 0.6)))
    hits = scan[np.isfinite(scan)]
    assert hits.min() == 0.1
    assert hits.max() == 3.1


def test_what_touches_the_lidar_is_not_infinite() -> None:
    lidar = build(Lidar2dSpec(range_min=0.1))
    inside = read(lidar, scene_of((0.1, 0.0)))
    np.testing.assert_allclose(inside, 0.1, atol=0.006)
    close = read(lidar, scene_of((0.38, 0.0)))  # 0.05 m before it
    assert close[240] == pytest.approx(0.1, abs=1e-12)


def test_height_of_the_beams() -> None:
    """A base lifted by 2 m looks over people's heads but not over the wall."""
    lidar = build(Lidar2dSpec(mount=Mount(z=0.24), noise=0.0))
    assert read(lidar, scene_of((2.0, 0.0)))[240] == pytest.approx(1.67)
    assert read(lidar, scene_of((2.0, 0.0), z=2.0))[240] == pytest.approx(3.0)
    assert read(lidar, scene_of((2.0, 0.0), z=None))[240] == pytest.approx(1.67)


def test_one_beam_is_independent_of_the_others() -> None:
    lidar = build(Lidar2dSpec(noise=0.01))
    a, b = read(lidar, scene_of()), read(lidar, scene_of((0.0, 2.0)))
    same = a == b
    assert same.sum() > 200
    assert not same.all()
