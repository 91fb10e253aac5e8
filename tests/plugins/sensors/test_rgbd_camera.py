"""The depth camera against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from pydantic import ValidationError

from crowdbot.core.registry.build_reference import load_build
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.scene import Scene
from crowdbot.plugin import Pose, RobotState, TiltableMount
from crowdbot.plugins.sensors.rgbd_camera import RGBD_CAMERA, RgbdCameraSpec
from crowdbot.plugins.sensors.rgbd_camera_build import RgbdCamera, build
from crowdbot.testing.sensor_scenes import context

Array = NDArray[np.float64]
BASE = 0.0102
ORIGIN = Pose(0.0, 0.0, 0.0)
FACING = [[3.0, -99.0, 3.0, 99.0]]
LOW = {"depth_min": 0.0, "depth_max": 50.0}


def scene_of(walls: object = (), *people: tuple[float, float], top: float = 1e3) -> Scene:
    xyv = np.zeros((len(people), 4))
    xyv[:, :2] = np.reshape(people, (-1, 2))
    scene = Scene(walls, [0.0, top], np.full(len(people), 0.33), 1.7)  # type: ignore[arg-type]
    robot = RobotState(0, 0, 0, 0, 0, 0, 0, BASE, 0, 0)
    scene.update(robot, xyv, np.ones(len(people), np.bool_))
    return scene


def read(camera: RgbdCamera, scene: Scene, pose: Pose = ORIGIN, tick: int = 0) -> Array:
    depth = camera.read(scene, pose, tick / 128, sensor_rng(0, "robot", "camera", tick))
    assert depth.dtype == np.float32
    return depth


def camera_at(z: float = 0.5, yaw: float = 0.0, **fields: object) -> RgbdCamera:
    return build(RgbdCameraSpec(mount=TiltableMount(z=z - BASE, yaw=yaw), **fields), context())  # type: ignore[arg-type]


def rays(camera: RgbdCamera) -> tuple[Array, Array]:
    """Ways to the left and up per metre of depth, of each pixel (H, W)."""
    pinhole = camera.info().camera
    assert pinhole is not None
    column, row = pinhole.centre
    left = (column - np.arange(pinhole.width)) / pinhole.focal
    up = (row - np.arange(pinhole.height)) / pinhole.focal
    grid = np.meshgrid(left, up)
    return grid[0], grid[1]


def test_info_of_the_challenge() -> None:
    info = build(RgbdCameraSpec(mount=TiltableMount(x=-0.087, z=0.287)), context()).info()
    assert (info.category, info.ros_type) == ("camera", "sensor_msgs/msg/Image")
    assert info.shape == (240, 320)
    assert info.mount == (-0.087, 0.0, 0.287, 0.0)
    assert (info.range_min, info.range_max, info.memory, info.privileged) == (0.4, 8.0, 0, False)
    assert info.camera is not None
    assert info.camera.centre == (159.5, 119.5)
    # The borders of the picture lie at half the field of view.
    assert math.atan(160.0 / info.camera.focal) == pytest.approx(math.pi / 6)
    assert load_build(RGBD_CAMERA) is build


@settings(max_examples=30)
@given(st.floats(-1.2, 1.2), st.floats(0.5, 6.0), st.integers(2, 40), st.integers(2, 40))
def test_a_wall_at_an_angle(yaw: float, ahead: float, width: int, height: int) -> None:
    """Depth along the axis: x = ahead, seen by a camera that looks along ``yaw``."""
    camera = camera_at(5.0, yaw, width=width, height=height, **LOW)
    left, up = rays(camera)
    depth = read(camera, scene_of([[ahead, -999.0, ahead, 999.0]]))
    with np.errstate(divide="ignore", invalid="ignore"):
        wall = ahead / (math.cos(yaw) - left * math.sin(yaw))
        floor = np.where(up < 0.0, -5.0 / up, np.inf)
    expected = np.minimum(np.where(wall > 0.0, wall, np.inf), floor)
    expected[expected > 50.0] = np.inf
    close = np.abs(expected - 50.0) > 1e-6
    np.testing.assert_allclose(depth[close], expected[close], rtol=2e-7)


def test_a_wall_that_faces_the_camera_has_one_depth() -> None:
    depth = read(camera_at(100.0, depth_max=5.0), scene_of(FACING))
    assert depth == pytest.approx(3.0)


def test_the_floor() -> None:
    camera = camera_at(0.3, **LOW)
    _, up = rays(camera)
    depth = read(camera, scene_of())
    assert np.all(np.isinf(depth[up >= 0.0]))
    below = up < -0.3 / 50.0
    np.testing.assert_allclose(depth[below], -0.3 / up[below], rtol=2e-7)


def test_first_row_is_on_top_and_first_column_on_the_left() -> None:
    depth = read(camera_at(), scene_of([[1.0, 0.1, 1.0, 9.0]], top=0.5))
    assert depth[200, 40] == pytest.approx(0.5 / (80.5 / (160.0 * math.sqrt(3.0))), abs=1.0)
    assert depth[122, 40] == pytest.approx(1.0)  # the wall is on the left
    assert depth[118, 40] == np.inf  # and ends at the height of the camera
    assert depth[122, 280] == np.inf


def test_a_person_has_legs_and_a_trunk_and_hides_the_wall() -> None:
    camera = camera_at(0.5, depth_max=10.0)
    left, up = rays(camera)
    depth = read(camera, scene_of([[6.0, -99.0, 6.0, 99.0]], (3.0, 0.0)))
    at = {
        (round(a, 1), round(b, 1)): depth[
            np.unravel_index(np.argmin((left * 3 - a) ** 2 + (up * 3 + 0.5 - b) ** 2), depth.shape)
        ]
        for a, b in ((0.0, 0.5), (0.0, 1.2), (0.146, 0.5), (-0.146, 0.5), (0.7, 0.5), (0.0, 1.5))
    }
    trunk = 0.5 * 0.259 * 1.7
    assert at[0.0, 1.2] == pytest.approx(3.0 - trunk, abs=0.01)
    assert at[0.0, 1.5] == pytest.approx(3.0 - trunk, abs=0.01)
    for side in (0.1, -0.1):
        assert at[side, 0.5] == pytest.approx(3.0 - 0.07, abs=0.01)
    assert at[0.0, 0.5] == pytest.approx(6.0)  # between the legs
    assert at[0.7, 0.5] == pytest.approx(6.0)


def test_out_of_range() -> None:
    near = camera_at(100.0, depth_min=3.5, depth_max=5.0)
    assert np.all(read(near, scene_of(FACING)) == 0.0)
    far = camera_at(100.0, depth_max=2.5)
    assert np.all(np.isinf(read(far, scene_of(FACING))))


def test_inside_a_person_everything_is_too_near() -> None:
    assert np.all(read(camera_at(1.2), scene_of(FACING, (0.0, 0.0))) == 0.0)


def test_moves_with_the_robot() -> None:
    mount = TiltableMount(x=0.2, y=0.1, z=50.0, yaw=0.3)
    camera = build(RgbdCameraSpec(mount=mount, depth_max=20.0), context())
    pose = Pose(1.0, 2.0, math.pi / 2 - 0.3)
    depth = read(camera, scene_of([[-99.0, 9.0, 99.0, 9.0]]), pose)
    y = 2.0 + 0.2 * math.sin(pose.yaw) + 0.1 * math.cos(pose.yaw)
    assert depth == pytest.approx(9.0 - y)


@pytest.mark.parametrize("ahead", [1.0, 2.0, 4.0])
def test_noise_grows_as_the_square_of_the_depth(ahead: float) -> None:
    camera = camera_at(100.0, noise=0.0014)
    scene = scene_of([[ahead, -99.0, ahead, 99.0]])
    error = np.concatenate([read(camera, scene, tick=k) - ahead for k in range(3)])
    assert error.std() == pytest.approx(0.0014 * ahead**2, rel=0.02)
    assert abs(error.mean()) < 4 * error.std() / math.sqrt(error.size)
    assert np.array_equal(read(camera, scene, tick=5), read(camera, scene, tick=5))
    assert not np.array_equal(read(camera, scene, tick=5), read(camera, scene, tick=6))


def test_noise_stays_within_range_and_on_hits() -> None:
    camera = camera_at(0.3, noise=0.5, depth_min=0.4, depth_max=4.0)
    depth, clean = read(camera, scene_of()), read(camera_at(0.3, depth_max=4.0), scene_of())
    assert np.array_equal(np.isinf(depth), np.isinf(clean))
    hits = depth[np.isfinite(depth) & (depth > 0.0)]
    assert hits.min() >= np.float32(0.4)
    assert hits.max() <= 4.0


def test_quantised() -> None:
    depth = read(camera_at(0.3, resolution=0.01), scene_of())
    hits = depth[np.isfinite(depth)]
    np.testing.assert_allclose(hits / 0.01, np.rint(hits / 0.01), atol=1e-4)
    assert len(np.unique(hits)) > 100


def test_bits_are_steps_of_the_range() -> None:
    spec = {"depth_min": 0.5, "depth_max": 8.5}
    true = read(camera_at(0.3, **spec), scene_of())
    depth = read(camera_at(0.3, bits=5, **spec), scene_of())
    hits = np.isfinite(true) & (true > 0.0)
    expected = np.maximum(np.floor(true[hits] / 0.25) * 0.25, 0.5)
    assert np.array_equal(depth[hits], expected)
    assert np.array_equal(depth[~hits], true[~hits])
    assert len(np.unique(expected)) > 20


def test_pixels_are_lost() -> None:
    camera, scene = camera_at(100.0, dropout=0.2), scene_of(FACING)
    depths = [read(camera, scene, tick=k) for k in range(4)]
    assert camera.info().random
    assert np.mean(np.isinf(depths)) == pytest.approx(0.2, abs=0.005)
    assert set(np.unique(depths[0]).tolist()) == {3.0, math.inf}
    assert not np.array_equal(depths[0], depths[1])
    assert np.array_equal(depths[2], read(camera, scene, tick=2))


@settings(max_examples=30)
@given(st.floats(-0.9, 0.9), st.floats(0.3, 1.4))
def test_what_is_struck_at_a_slant_is_not_seen(yaw: float, limit: float) -> None:
    """A wall x = 3 and the floor, each with the angle of its own normal to the ray."""
    scene = scene_of([[3.0, -99.0, 3.0, 99.0]])
    limited = camera_at(0.8, yaw, max_incidence=limit, width=64, height=48, **LOW)
    left, up = rays(limited)
    depth = read(limited, scene)
    whole = read(camera_at(0.8, yaw, width=64, height=48, **LOW), scene)
    ahead, length = math.cos(yaw) - left * math.sin(yaw), np.sqrt(1.0 + left**2 + up**2)
    with np.errstate(divide="ignore", invalid="ignore"):
        on_floor = (up < 0.0) & ((ahead <= 0.0) | (-0.8 / up < 3.0 / ahead))
    cosine = np.where(on_floor, -up, ahead) / length
    seen, sure = cosine > math.cos(limit), np.abs(cosine - math.cos(limit)) > 1e-6
    np.testing.assert_allclose(depth[sure & seen], whole[sure & seen], rtol=1e-6)
    assert np.all(np.isinf(depth[sure & ~seen]))


def test_a_slanted_body_hides_what_is_behind_it() -> None:
    scene = scene_of([[2.0, 0.0, 4.0, 0.2], [6.0, -99.0, 6.0, 99.0]])
    plain, limited = (
        read(camera_at(0.8, max_incidence=limit, **LOW), scene) for limit in (math.pi / 2, 1.0)
    )
    behind = (plain > 2.5) & (plain < 3.5)
    assert behind.sum() > 100
    assert np.all(np.isinf(limited[behind]))


@pytest.mark.parametrize(
    "fields",
    [
        {"bits": 33}, {"bits": -1}, {"dropout": 1.0}, {"dropout": -0.1}, {"max_incidence": 0.0},
        {"max_incidence": 2.0},
        {"width": 0}, {"height": 0}, {"width": 1}, {"height": -3}, {"width": 4096, "height": 4096},
        {"depth_min": 3.0, "depth_max": 3.0}, {"horizontal_view": math.pi},
        {"horizontal_view": 0.0}, {"noise": -1.0}, {"rate": 129.0}, {"rate": 0.0},
    ],
)  # fmt: skip
def test_refused(fields: dict[str, float]) -> None:
    with pytest.raises(ValidationError):
        RgbdCameraSpec(**fields)  # type: ignore[arg-type]
