"""The planar lidar."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from crowdbot.core.registry.build_reference import load_build
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.scene import Scene
from crowdbot.plugin import Pose, TiltableMount
from crowdbot.plugins.sensors.lidar2d import LIDAR2D, Lidar2dSpec
from crowdbot.plugins.sensors.lidar2d_build import build
from crowdbot.testing.sensor_scenes import context
from tests.core.sensing.sensing_worlds import (
    ORIGIN,
    Array,
    crowd_of,
    cylinders,
    read,
    scene_of,
    sensor,
)

WALLS = [[3.0, -9.0, 3.0, 9.0]]
APART = 0.5 * 0.9 * 0.191 * 1.7  # of a leg from the middle, m


def wall(*people: tuple[float, float], z: float | None = 0.0102) -> Scene:
    """A wall, and people who walk away along x: their legs are beside each other."""
    return scene_of(people, WALLS, robot_z=z)


def test_info_of_the_challenge() -> None:
    info = build(Lidar2dSpec(mount=TiltableMount(x=0.17, z=0.24)), (), context()).info()
    assert (info.category, info.ros_type) == ("lidar", "sensor_msgs/msg/LaserScan")
    assert info.angles is not None
    assert info.shape == (480,) == info.angles.shape
    assert info.angles[0] == pytest.approx(math.radians(-120))
    assert info.angles[-1] == pytest.approx(math.radians(119.5))
    assert info.mount == (0.17, 0.0, 0.24, 0.0)
    assert load_build(LIDAR2D) is build


@pytest.mark.parametrize("yaw", [0.0, 0.4, -2.0])
def test_wall_seen_at_the_right_angles(yaw: float) -> None:
    lidar = build(
        Lidar2dSpec(mount=TiltableMount(x=0.1, y=0.05, yaw=0.3), range_max=5.0), (), context()
    )
    scan, angles = read(lidar, wall(), Pose(0.5, -0.2, yaw)), lidar.info().angles
    assert angles is not None
    x = 0.5 + 0.1 * math.cos(yaw) - 0.05 * math.sin(yaw)
    heading = yaw + 0.3 + angles
    with np.errstate(divide="ignore"):
        expected = np.where(np.cos(heading) > 0, (3.0 - x) / np.cos(heading), np.inf)
    expected[expected > 5.0] = np.inf
    np.testing.assert_allclose(scan, expected, atol=1e-9)


def test_rear_lidar_sees_what_is_behind() -> None:
    rear = build(Lidar2dSpec(mount=TiltableMount(x=-0.17, yaw=math.pi)), (), context())
    assert read(rear, wall((-2.0, APART)))[240] == pytest.approx(2.0 - 0.17 - 0.07)


def test_noise_only_on_hits_and_of_the_right_size() -> None:
    lidar = sensor("lidar2d", noise="1 cm", range_max=5.0)
    clean = read(sensor("lidar2d", range_max=5.0), wall())
    errors = []
    for tick in range(200):
        scan = read(lidar, wall(), tick=tick)
        np.testing.assert_array_equal(np.isinf(scan), np.isinf(clean))
        inner = clean < 4.9
        errors.append(scan[inner] - clean[inner])
    error = np.concatenate(errors)
    assert abs(error.mean()) < 4 * 0.01 / math.sqrt(error.size)
    assert error.std() == pytest.approx(0.01, rel=0.02)


def test_readings_stay_within_range() -> None:
    lidar = sensor("lidar2d", noise=0.5, range_min=0.1, range_max=3.1)
    scan = read(lidar, wall((0.0, 0.6)))
    hits = scan[np.isfinite(scan)]
    assert hits.min() == 0.1
    assert hits.max() == 3.1


def test_what_touches_the_lidar_is_not_infinite() -> None:
    lidar = sensor("lidar2d", noise="1 mm")
    inside = read(lidar, wall((0.05, APART)))  # within the right leg
    np.testing.assert_allclose(inside, 0.1, atol=0.006)
    close = read(sensor("lidar2d"), wall((0.12, APART)))  # 0.05 m before it
    assert close[240] == 0.1


def test_height_of_the_beams() -> None:
    """A base lifted by 2 m looks over people's heads but not over the wall."""
    lidar = sensor("lidar2d", mount={"z": "0.24 m"})
    assert read(lidar, wall((2.0, APART)))[240] == pytest.approx(1.93)
    assert read(lidar, wall((2.0, 0.0)))[240] == pytest.approx(3.0)  # between the legs
    assert read(lidar, wall((2.0, APART), z=2.0))[240] == pytest.approx(3.0)
    assert read(lidar, wall((2.0, APART), z=None))[240] == pytest.approx(1.93)
    assert read(lidar, wall((2.0, 0.0), z=1.0))[240] == pytest.approx(2.0 - 0.5 * 0.259 * 1.7)


def test_one_beam_is_independent_of_the_others() -> None:
    lidar = sensor("lidar2d", noise="1 cm")
    a, b = read(lidar, wall()), read(lidar, wall((0.5, 2.0)))
    same = a == b
    assert same.sum() > 200
    assert not same.all()


def test_one_gaussian_is_one_normal_number_for_each_beam() -> None:
    """A change here changes every recorded run."""
    scan = read(sensor("lidar2d", noise="1 mm"), wall(), tick=5, seed=7)
    errors = sensor_rng(7, "robot", "it", 5).standard_normal(480)
    inner = slice(150, 330)
    clean = read(sensor("lidar2d"), wall())
    np.testing.assert_array_equal(scan[inner], (clean + 0.001 * errors)[inner])


@settings(max_examples=60)
@given(st.integers(0, 2**32 - 1), st.integers(1, 40))
def test_sees_everybody_in_line_of_sight(seed: int, count: int) -> None:
    """Half a degree between beams finds every leg within 10 m that nothing hides."""
    xyv, direction, walked = crowd_of(seed, count)
    solids = np.array(cylinders(xyv, direction, walked, 1.7, 0.33))
    legs = solids[solids[:, 3] == 0.0]
    away, half = _seen_as(legs)
    assume((away - legs[:, 2]).min() > 0.1)
    scene = Scene(np.empty((0, 4)), [0, 2.5], np.full(count, 0.33), 1.7)
    scene.update(None, xyv, np.ones(count, np.bool_), direction, walked)
    angles = np.arange(720) * math.pi / 360 - math.pi
    scan = read(sensor("lidar2d", angle_min=-math.pi, angle_max=math.pi), scene)
    bearing = np.arctan2(legs[:, 1], legs[:, 0])
    for k, leg in enumerate(legs):
        others = np.arange(len(legs)) != k
        apart = np.abs(np.angle(np.exp(1j * (bearing - bearing[k]))))
        hidden = (apart < half + half[k]) & (away < away[k] + 0.3) & others
        if hidden.any() or away[k] > 9.9:
            continue
        mine = np.abs(np.angle(np.exp(1j * (angles - bearing[k])))) < half[k]
        assert mine.any()
        assert (scan[mine] <= away[k]).all()
        assert (scan[mine] >= away[k] - leg[2] - 1e-9).all()


def _seen_as(legs: Array) -> tuple[Array, Array]:
    """Distance of the axes from the origin and half the angle that the legs cover."""
    away = np.hypot(legs[:, 0], legs[:, 1])
    return away, np.arcsin(np.minimum(1.0, legs[:, 2] / np.maximum(away, 1e-9)))


def test_the_robot_never_sees_itself() -> None:
    """Alone in the world, whatever its pose and wherever on it the sensor is."""
    for kind in ("lidar2d", "ultrasound", "infrared"):
        for x in (-0.17, 0.0, 0.17):
            one = sensor(kind, mount={"x": x, "z": 0.24, "yaw": 2.0})
            for pose in (ORIGIN, Pose(3.0, -2.0, 1.0)):
                assert np.isinf(read(one, scene_of(), pose)).all()


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"angle_min": 1.0, "angle_max": 1.0}, "angle_min must be below"),
        ({"angle_min": -4.0, "angle_max": 4.0}, "one turn"),
        ({"angle_step": 1e-6}, "angle_step is too small"),
        ({"angle_step": 5e-324}, "angle_step is too small"),
        ({"range_min": 11.0}, "range_min must be below"),
        ({"max_incidence": 0.0}, "greater than 0"),
        ({"max_incidence": "91 deg"}, "less than or equal"),
        ({"bits": 33}, "less than or equal to 32"),
        ({"dropout": 1.0}, "less than 1"),
        ({"noise": -0.1}, "greater than or equal to 0"),
        ({"noise": "1 kg"}, "not a quantity of length"),
        ({"noise": {"a": {"kind": "gausian", "std": 1.0}}}, "gausian"),
        ({"noise": [0.1]}, "dictionary"),
        ({"noise": True}, "dictionary"),
    ],
)
def test_documents_that_make_no_sense(fields: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        sensor("lidar2d", **fields)


def test_a_whole_turn_in_degrees() -> None:
    assert sensor("lidar2d", angle_min="-180 deg", angle_max="180 deg").info().shape == (720,)
