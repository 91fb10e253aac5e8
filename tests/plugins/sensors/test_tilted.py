"""Sensors that are mounted with roll and pitch, against closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from crowdbot.core.geometry.rotation import quaternion, rotation
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.scene import Scene
from crowdbot.plugin import Mount, Pose, RobotState, TiltableMount
from crowdbot.plugins.sensors.bumper import BumperSpec
from crowdbot.plugins.sensors.contact_force import ContactForceSpec
from crowdbot.plugins.sensors.lidar2d import Lidar2dSpec
from crowdbot.plugins.sensors.people_tracker import PeopleTrackerSpec
from tests.core.sensing.sensing_worlds import BASE, ORIGIN, read, scalar, scene_of, sensor

Array = NDArray[np.float64]
EMPTY = scene_of()
ROOM = [[-4, -3, 6, -3], [6, -3, 6, 3], [6, 3, -4, 3], [-4, 3, -4, -3]]
PEOPLE = [(1.5, 0.2), (2.5, -1.0), (-1.0, 1.5)]
TILT = st.floats(-1.4, 1.4)
FEWER_RAYS: dict[str, dict[str, Any]] = {
    "lidar3d": {"layers": 5, "angle_step": 0.02},
    "rgbd_camera": {"width": 60, "height": 40},
    "ultrasound": {"max_incidence": 1.0},  # the floor lies flatter than this under its zone
}


def mounted(height: float, **turn: float) -> dict[str, float]:
    """A mount at a height above the floor, m."""
    return {"z": height - BASE, **turn}


@pytest.mark.parametrize("degrees", [5.0, 30.0, 60.0, 89.0])
def test_a_lidar_that_looks_down_sees_the_floor_at_h_over_sin_pitch(degrees: float) -> None:
    """Ahead at h / sin(pitch); a beam at the angle a goes down by sin(pitch) cos(a) per metre."""
    pitch, h = math.radians(degrees), 1.2
    lidar = sensor(
        "lidar2d", mount=mounted(h, pitch=pitch), angle_min=-1.0, angle_max=1.0, range_max=30.0
    )
    angles = lidar.info().angles
    assert angles is not None
    found = read(lidar, EMPTY)
    np.testing.assert_allclose(found, h / (math.sin(pitch) * np.cos(angles)), rtol=1e-12)
    assert found[np.argmin(np.abs(angles))] == pytest.approx(h / math.sin(pitch), rel=1e-4)


def test_one_that_looks_up_meets_nothing_and_passes_over_low_walls() -> None:
    lidar = sensor("lidar2d", mount=mounted(1.0, pitch=-math.radians(30.0)), angle_min=-0.1,
                   angle_max=0.1)  # fmt: skip
    near, far = scene_of(walls=[[2, -5, 2, 5]]), scene_of(walls=[[3, -5, 3, 5]])
    ahead = 2.0 / math.cos(math.radians(30.0))  # at a height of 2.15 m, below the wall's 2.5 m
    assert read(lidar, near)[11] == pytest.approx(ahead, rel=1e-3)
    assert np.all(np.isinf(read(lidar, far)))
    assert np.all(np.isinf(read(lidar, EMPTY)))


def test_upside_down_left_is_right() -> None:
    """Half a turn of roll: the same scan, from the other side."""
    turn = {"angle_min": -2.0, "angle_max": 2.0, "angle_step": 0.01}
    level = sensor("lidar2d", mount=mounted(0.4), **turn)
    hung = sensor("lidar2d", mount=mounted(0.4, roll=math.pi), **turn)
    scene = scene_of(PEOPLE, ROOM)
    # The end of a scan is not part of it: the first beam has no counterpart.
    np.testing.assert_allclose(read(hung, scene)[1:], read(level, scene)[:0:-1], atol=1e-9)


@pytest.mark.parametrize("kind", ["lidar2d", "lidar3d", "ultrasound", "rgbd_camera"])
def test_hardly_tilted_is_as_level(kind: str) -> None:
    """Two programs for the same rays: level sensors go body by body, tilted ones ray by ray."""
    fields = FEWER_RAYS.get(kind, {})
    scene, pose = scene_of(PEOPLE, ROOM), Pose(0.3, -0.2, 0.7)
    level, tilted = (
        read(sensor(kind, mount=mounted(0.6, yaw=0.2, pitch=p), **fields), scene, pose)
        for p in (0.0, 1e-12)
    )
    assert np.mean(np.isfinite(level)) > 0.5
    np.testing.assert_allclose(tilted, level, rtol=2e-6)


@given(roll=TILT, pitch=TILT, yaw=st.floats(-3.0, 3.0), height=st.floats(0.2, 2.0))
@settings(max_examples=30)
def test_a_cloud_lies_on_what_it_sees(roll: float, pitch: float, yaw: float, height: float) -> None:
    """Turned back into the world, every point is on the floor or on a wall of the room."""
    lidar = sensor("lidar3d", layers=3, angle_step=0.3, range_max=40.0,
                   mount=mounted(height, roll=roll, pitch=pitch, yaw=yaw))  # fmt: skip
    angles, pose = lidar.info().angles, Pose(0.5, 0.4, 1.1)
    assert angles is not None
    found = read(lidar, scene_of(walls=ROOM), pose)
    azimuth, rise = angles[..., 0], angles[..., 1]
    rays = np.stack([np.cos(rise) * np.cos(azimuth), np.cos(rise) * np.sin(azimuth), np.sin(rise)])
    turned = np.einsum("ij,jlc->lci", rotation(roll, pitch, pose.yaw + yaw), rays)
    hit = np.isfinite(found)
    points = found[hit, None] * turned[hit] + (pose.x, pose.y, height)
    x, y, z = points.T
    away = np.min([np.abs(z), np.abs(x + 4), np.abs(x - 6), np.abs(y - 3), np.abs(y + 3)], axis=0)
    assert np.all(away < 1e-9)
    assert np.all(z > -1e-9)
    # What goes down meets something; what is lost goes over the walls, which are 2.5 m high.
    assert np.all(turned[~hit][:, 2] > 0.0)


def test_a_camera_that_looks_down_sees_the_floor_row_by_row() -> None:
    """Depth h / (sin p - s cos p) of the row whose rays rise by s per metre of depth."""
    pitch, h = 0.5, 1.3
    camera = sensor("rgbd_camera", width=32, height=24, depth_min=0.0, depth_max=60.0,
                    mount=mounted(h, pitch=pitch))  # fmt: skip
    pinhole = camera.info().camera
    assert pinhole is not None
    rise = (pinhole.centre[1] - np.arange(24)) / pinhole.focal
    fall = math.sin(pitch) - rise * math.cos(pitch)
    expected = np.where(fall > h / 60.0, h / fall, np.inf)
    found = read(camera, EMPTY)
    np.testing.assert_allclose(found, np.repeat(expected[:, None], 32, axis=1), rtol=1e-6)


def test_a_camera_on_its_side_has_a_wall_in_its_columns() -> None:
    """A quarter turn of roll: the floor is at the side of the picture, one depth in a column."""
    camera = sensor("rgbd_camera", width=32, height=24, depth_min=0.0, depth_max=60.0,
                    mount=mounted(0.5, roll=math.pi / 2))  # fmt: skip
    found = read(camera, EMPTY)
    assert np.all(np.isinf(found[:, :16]))  # its left is up
    assert np.all(np.isfinite(found[:, 16:]))
    np.testing.assert_allclose(found[:, 16:], np.repeat(found[:1, 16:], 24, axis=0), rtol=1e-6)


def test_images_in_millimetres_are_those_in_metres() -> None:
    camera = sensor("rgbd_camera", width=32, height=24, mount=mounted(0.8, pitch=0.4, roll=0.1))
    scene = scene_of(PEOPLE, ROOM)
    depth = read(camera, scene)
    image = camera.depth_mm(scene, ORIGIN, 0.0, sensor_rng(0, "r", "c", 0))  # type: ignore[attr-defined]
    near = np.isfinite(depth)
    assert near.any()
    np.testing.assert_array_equal(image[near], np.rint(depth[near] * 1000.0))
    assert np.all(image[~near] == 0)


@pytest.mark.parametrize("kind", ["ultrasound", "infrared"])
def test_sonar_and_infrared_measure_a_step(kind: str) -> None:
    """Straight down from 0.6 m; from the edge of a table of that height nothing comes back."""
    fields = {"range_max": 2.0, "radius": 0.5} if kind == "ultrasound" else {"range_max": 2.0}
    down = {"mount": mounted(0.6, pitch=math.pi / 2), **fields}
    assert scalar(sensor(kind, **down), EMPTY) == pytest.approx(0.6, abs=1e-3)
    over = {**down, "range_max": 0.55}
    assert math.isinf(scalar(sensor(kind, **over), EMPTY))
    level = {"mount": mounted(0.6), **fields}
    assert math.isinf(scalar(sensor(kind, **level), EMPTY))


def test_a_smooth_floor_throws_a_slanted_echo_away() -> None:
    """20 degrees down, a zone of 10.5 degrees strikes it at 59 to 81: lost with a limit of 45."""
    down = {"mount": mounted(0.4, pitch=math.radians(20.0)), "range_max": 2.5, "radius": 0.3}
    assert scalar(sensor("ultrasound", **down), EMPTY) < 2.0
    limited = sensor("ultrasound", max_incidence=math.radians(45.0), **down)
    assert math.isinf(scalar(limited, EMPTY))


@given(roll=st.floats(-3.0, 3.0), pitch=TILT, yaw=st.floats(-3.0, 3.0))
@settings(max_examples=30)
def test_an_imu_feels_gravity_where_up_is(roll: float, pitch: float, yaw: float) -> None:
    """At rest g (-sin p, cos p sin r, cos p cos r); a turn about the vertical likewise."""
    imu: Any = sensor("imu", gyro_noise=0.0, force_noise=0.0, rate=64.0,
                      mount={"roll": roll, "pitch": pitch, "yaw": yaw})  # fmt: skip
    scene, memory = Scene([], [0, 1], [], []), np.zeros(imu.info().memory)
    scene.move_robot(RobotState(0, 0, 0.4, 0, 0, 0.7, 0, 0, 0, 0))
    found = imu.read(scene, Pose(0, 0, 0.4), 0.0, sensor_rng(0, "r", "imu", 0), memory)
    up = np.array(
        [-math.sin(pitch), math.cos(pitch) * math.sin(roll), math.cos(pitch) * math.cos(roll)]
    )
    np.testing.assert_allclose(found, [*(0.7 * up), *(9.81 * up)], atol=1e-12)


@given(roll=st.floats(-3.0, 3.0), pitch=st.floats(-3.0, 3.0), yaw=st.floats(-3.0, 3.0))
def test_quaternion_and_matrix_are_one_rotation(roll: float, pitch: float, yaw: float) -> None:
    """And the one of `scipy`, by fixed axes x, y, z."""
    expected = Rotation.from_euler("xyz", [roll, pitch, yaw])
    np.testing.assert_allclose(rotation(roll, pitch, yaw), expected.as_matrix(), atol=1e-12)
    found = np.array(quaternion(roll, pitch, yaw))
    assert abs(found @ expected.as_quat()) == pytest.approx(1.0, abs=1e-12)


def test_specs_take_a_level_mount_as_one_without_tilt() -> None:
    """Python code that was written before mounts could be tilted."""
    spec = Lidar2dSpec(mount=Mount(x=0.1, z=0.3))  # type: ignore[arg-type]
    assert spec.mount == TiltableMount(x=0.1, z=0.3)
    assert "pitch" not in spec.model_dump()["mount"]
    assert spec.model_copy(update={"mount": TiltableMount(pitch=0.2)}).model_dump()["mount"] == {
        "x": 0.0, "y": 0.0, "z": 0.0, "yaw": 0.0, "pitch": 0.2,
    }  # fmt: skip


@pytest.mark.parametrize("model", [BumperSpec, ContactForceSpec, PeopleTrackerSpec])
def test_sensors_without_a_tilt_refuse_it(model: Any) -> None:
    with pytest.raises(ValueError, match="pitch"):
        model.model_validate({"kind": model.model_fields["kind"].default, "mount": {"pitch": 0.1}})
