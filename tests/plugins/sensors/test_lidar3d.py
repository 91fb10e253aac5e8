"""The multi-layer lidar."""

import math

import numpy as np
import pytest

from crowdbot.core.sensing.points import LidarPoints
from crowdbot.plugin import Pose, Sensor, SensorInfo
from tests.core.sensing.sensing_worlds import BASE, ORIGIN, Array, read, scene_of, sensor

LAYERS = {"elevation_min": "-15 deg", "elevation_max": "15 deg", "layers": 4}
MOUNT = {"x": 0.1, "z": 0.4, "yaw": 0.2}


def lidar(**fields: object) -> Sensor:
    return sensor("lidar3d", **{"mount": MOUNT, "angle_step": "10 deg", **LAYERS, **fields})


def beams(info: SensorInfo) -> tuple[Array, Array]:
    assert info.angles is not None
    return info.angles[..., 0], info.angles[..., 1]


def test_shape_and_angles() -> None:
    info = lidar().info()
    azimuth, elevation = beams(info)
    assert info.shape == azimuth.shape == (4, 36)
    assert np.degrees(elevation[:, 0]) == pytest.approx([-15, -5, 5, 15])
    assert np.degrees(azimuth[0, [0, 1, 35]]) == pytest.approx([-180, -170, 170])
    assert (info.category, info.ros_type) == ("lidar3d", "sensor_msgs/msg/PointCloud2")


def test_floor_and_a_wall_at_every_angle() -> None:
    one, pose = lidar(range_max=30.0), Pose(0.5, -0.3, 0.7)
    scan = read(one, scene_of(walls=[[3.0, -99.0, 3.0, 99.0]]), pose)
    azimuth, elevation = beams(one.info())
    heading, z = azimuth + 0.9, BASE + 0.4
    x = 0.5 + 0.1 * math.cos(0.7)
    with np.errstate(divide="ignore", invalid="ignore"):
        wall = np.where(np.cos(heading) > 1e-9, (3.0 - x) / np.cos(heading), np.inf)
        top = z + wall * np.tan(elevation)
        wall[~((top >= 0.0) & (top <= 2.5))] = np.inf
        floor = np.where(elevation < 0, -z / np.tan(elevation), np.inf)
    expected = np.minimum(wall, floor) / np.cos(elevation)
    expected[expected > 30.0] = np.inf
    np.testing.assert_allclose(scan, expected, rtol=1e-9)


def test_somebody_seen_from_knee_to_chest() -> None:
    """Legs below 0.9 m, the trunk above."""
    one = sensor("lidar3d", mount={"z": 0.9 - BASE}, elevations=["-10 deg", "10 deg"], range_max=9)
    low, high = read(one, scene_of([(2.0, 0.0)], facing=math.pi / 2))[:, 360]
    assert low == pytest.approx((2.0 - 0.07 - 0.5 * 0.9 * 0.191 * 1.7) / math.cos(math.radians(10)))
    assert high == pytest.approx((2.0 - 0.5 * 0.259 * 1.7) / math.cos(math.radians(10)))


def test_incidence_limit_blanks_the_floor() -> None:
    """A ray that falls by 15 deg meets the floor at 75 deg to its normal."""
    everything, limited = lidar(), lidar(max_incidence="74 deg")
    scene = scene_of()
    assert np.isfinite(read(everything, scene)[0]).all()
    assert np.isinf(read(limited, scene)).all()


def test_one_layer_and_listed_layers() -> None:
    assert beams(lidar(layers=1).info())[1].tolist() == [[0.0] * 36]
    listed = lidar(elevations=["-20 deg", "0 deg", "3 deg"]).info()
    assert listed.shape == (3, 36)
    for wrong in (["1 deg", "0 deg"], ["1 deg", "1 deg"]):
        with pytest.raises(ValueError, match="must rise"):
            lidar(elevations=wrong)
    with pytest.raises(ValueError, match="must not be above"):
        lidar(elevation_min="16 deg")
    with pytest.raises(ValueError, match="too small"):
        lidar(layers=512, angle_step="0.1 deg")


def test_planners_that_want_planar_lidars_are_not_disturbed() -> None:
    info = lidar().info()
    assert len(LidarPoints({"dome": info})) == 0


def test_inside_a_body_every_beam_reads_the_shortest() -> None:
    scan = read(lidar(), scene_of(pillars=[[0.0, 0.0, 1.0]]), ORIGIN)
    assert (scan == 0.1).all()
