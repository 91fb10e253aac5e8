"""Which image of a camera is made when, and that it is the one that was seen."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from crowdbot.core.crowd import state as s
from crowdbot.core.sensing.depth_mm import depth_mm
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sim.cameras.images import Images, capture, view_size
from crowdbot.plugin import Pose, RobotState, TiltableMount
from crowdbot.plugins.sensors.rgbd_camera import RgbdCameraSpec
from crowdbot.plugins.sensors.rgbd_camera_build import RgbdCamera

Array = NDArray[np.float64]
SPEC = RgbdCameraSpec(width=8, height=6, mount=TiltableMount(z=0.5), noise=0.01)


class Counting(RgbdCamera):
    """Counts how often it is asked."""

    readings = images = 0

    def read(self, *given: Any) -> Array:
        self.readings += 1
        return super().read(*given)

    def depth_mm(self, *given: Any) -> NDArray[np.uint16]:
        self.images += 1
        return depth_mm(super().read(*given))


class OnlyReads:
    """A camera that has no whole millimetres."""

    def __init__(self, camera: RgbdCamera) -> None:
        self.info, self.read = camera.info, camera.read


def shown(scene: Scene, k: int) -> tuple[Pose, Array]:
    """An instant, and what the camera saw of it."""
    rng = np.random.default_rng(k)
    people = np.zeros((3, s.AGENT_COLUMNS))
    people[:, [s.X, s.Y]] = rng.uniform(0.7, 4.0, (3, 2)) * [1.0, 0.3]
    people[:, [s.VX, s.WALKED, s.DIR_X]] = [0.5, rng.random(), 1.0]
    robot = RobotState(0.1 * k, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0, 0.01, 0.0, 0.0)
    scene.update(
        robot, people[:, s.X : s.VY + 1], people[:, s.WAITING] == 0.0,
        people[:, s.DIR_X : s.DIR_Y + 1], people[:, s.WALKED],
    )  # fmt: skip
    view = np.empty(view_size(3))
    capture(robot, people, view)
    return Pose(robot.x, robot.y, robot.yaw), view


def rng(stamp: float) -> np.random.Generator:
    return sensor_rng(0, "robot", "camera", round(128 * stamp))


def room() -> Scene:
    return Scene([[5.0, -9.0, 5.0, 9.0]], [0.0, 2.5], np.full(3, 0.33), np.full(3, 1.7))


def test_a_reading_is_made_when_somebody_asks_and_once() -> None:
    scene, camera = room(), Counting(SPEC)
    images = Images(camera, rng, None)
    pose, view = shown(scene, 1)
    expected = camera.read(scene, pose, 0.125, rng(0.125))
    camera.readings = 0
    frame = images.frame(scene, pose, 0.125, view)
    assert (camera.images, camera.readings) == (1, 0)
    np.testing.assert_array_equal(frame.depth_mm, depth_mm(expected))
    shown(scene, 2)  # the world goes on
    for _ in range(2):
        reading = images.reading(scene, 0.125, view)
        np.testing.assert_array_equal(reading.values, expected)
        assert not reading.values.flags.writeable
    assert (camera.images, camera.readings) == (1, 1)


def test_another_view_is_seen_anew() -> None:
    scene, camera = room(), Counting(SPEC)
    images = Images(camera, rng, None)
    (_, one), (pose, two) = shown(scene, 1), shown(scene, 2)
    images.frame(scene, pose, 0.125, two)
    later = images.reading(scene, 0.125, two).values
    earlier = images.reading(scene, 0.125, one).values
    assert not np.array_equal(earlier, later)
    np.testing.assert_array_equal(images.reading(scene, 0.125, two).values, later)
    # Equal views at other times have other noise.
    assert not np.array_equal(images.reading(scene, 0.25, two).values, later)


@pytest.mark.parametrize("recorded", [True, False])
def test_a_colour_image_is_drawn_once(recorded: bool) -> None:
    drawn: list[Pose] = []

    def paint(_scene: Scene, pose: Pose) -> NDArray[np.uint8]:
        drawn.append(pose)
        return np.full((6, 8, 3), len(drawn), np.uint8)

    scene = room()
    images = Images(Counting(SPEC), rng, paint)
    pose, view = shown(scene, 1)
    if recorded:
        frame = images.frame(scene, pose, 0.125, view)
        assert frame.colour is not None
        assert not frame.colour.flags.writeable
    for _ in range(2):
        colour = images.reading(scene, 0.125, view).colour
        assert colour is not None
        assert np.all(colour == 1)
    assert drawn == [pose]


def test_a_camera_without_millimetres_is_rounded_and_its_reading_kept() -> None:
    scene, camera = room(), Counting(SPEC)
    images = Images(OnlyReads(camera), rng, None)
    pose, view = shown(scene, 1)
    frame = images.frame(scene, pose, 0.125, view)
    reading = images.reading(scene, 0.125, view)
    assert (camera.images, camera.readings) == (0, 1)
    np.testing.assert_array_equal(frame.depth_mm, depth_mm(reading.values))
