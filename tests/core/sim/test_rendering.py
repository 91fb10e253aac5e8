"""Colour pictures show what the depth camera measures; machines that cannot draw say so."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from crowdbot.cli import main
from crowdbot.core.interfaces import Pose, RobotState
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sim.person_mesh import leg_obj, trunk_obj
from crowdbot.core.sim.rendering import Renderer, check_egl
from crowdbot.dsl import TiltableMount
from crowdbot.errors import MissingLibraryError
from crowdbot.plugins.sensors.rgbd_camera import RgbdCameraSpec
from crowdbot.plugins.sensors.rgbd_camera_build import build
from tests.core.sim.sim_worlds import constant, rig, scenario

pytestmark = pytest.mark.slow

SPEC = RgbdCameraSpec(
    mount=TiltableMount(x=0.3, y=-0.2, z=1.0, yaw=0.4), width=160, height=120, depth_min=0.0,
    depth_max=150.0, colour=True,
)  # fmt: skip
POSE = Pose(1.0, 2.0, -0.3)


@pytest.fixture(scope="module", autouse=True)
def _can_draw() -> None:
    try:
        check_egl()
    except MissingLibraryError as error:
        pytest.skip(str(error))


def _scene(people: object = (), pillars: object = ()) -> Scene:
    xy = np.reshape(np.asarray(people, np.float64), (-1, 2))
    scene = Scene([], [0.0, 2.5], np.full(len(xy), 0.33), 1.7, pillars, [0.0, 2.5])  # type: ignore[arg-type]
    robot = RobotState(*POSE, 0, 0, 0, 0, 0.0102, 0, 0)
    scene.update(robot, np.hstack([xy, np.zeros_like(xy)]), np.ones(len(xy), np.bool_))
    return scene


def _both(scene: Scene) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
    camera = build(SPEC)
    pinhole = camera.info().camera
    assert pinhole is not None
    depth = camera.read(scene, POSE, 0.0, sensor_rng(0, "robot", "camera", 0))
    return depth, Renderer(scene, pinhole, camera.info().mount)(scene, POSE)


def _sky(picture: NDArray[np.uint8]) -> NDArray[np.bool_]:
    return np.asarray(np.all(np.abs(picture - np.array([191.0, 217.0, 242.0])) < 3, axis=2))


def test_a_pillar_stands_where_the_depth_camera_sees_it() -> None:
    depth, picture = _both(_scene(pillars=[[4.5, 2.2, 0.3], [6.0, 0.5, 0.5]]))
    assert picture.shape == (120, 160, 3)
    assert picture.dtype == np.uint8
    sky, nothing = _sky(picture), np.isinf(depth)
    assert 0.1 < nothing.mean() < 0.9
    # Edges of polygons inside circles: a pixel of difference along the outlines.
    assert np.mean(sky != nothing) < 0.01


def test_people_are_drawn_where_they_are_and_the_absent_are_not() -> None:
    here = (1.0 + 4.0 * math.cos(0.1), 2.0 + 4.0 * math.sin(0.1))
    _, empty = _both(_scene())
    depth, picture = _both(_scene([here]))
    changed = np.any(picture != empty, axis=2)
    person = depth < 5.0
    assert changed[person & (depth > 3.0) & ~_floor(depth)].mean() > 0.8
    gone = _scene([here])
    gone.update(gone.robot, np.array(gone.people), np.zeros(1, np.bool_))
    _, absent = _both(gone)
    np.testing.assert_array_equal(absent, empty)


def _floor(depth: NDArray[np.float64]) -> NDArray[np.bool_]:
    return np.isclose(depth, build(SPEC).read(_scene(), POSE, 0.0, np.random.default_rng(0)))


def test_readings_carry_colour() -> None:
    extra = "robots.robot.sensors.camera={kind: rgbd_camera, width: 32, height: 24, colour: true}"
    planner = constant(0.2)
    rig(scenario(extra), planner, sensors=("odometry", "camera")).advance(0.2)
    pictures = [obs.readings["camera"].colour for obs in planner.seen]
    assert len(pictures) == 4
    for picture in pictures:
        assert picture is not None
        assert picture.shape == (24, 32, 3)
        assert not picture.flags.writeable
        assert np.ptp(picture) > 20


@pytest.mark.parametrize("walked", [0.0, 0.35, 0.6, 1.06])
def test_legs_are_drawn_where_the_depth_camera_sees_them(walked: float) -> None:
    """Side view of somebody who walks: as many pixels differ as along any outline."""
    scene = _scene([(4.0, 2.2)])
    velocity = np.array([[4.0, 2.2, 0.0, 1.3]])
    ways = np.array([[0.0, 1.0]]), np.array([walked])
    scene.update(scene.robot, velocity, np.ones(1, np.bool_), *ways)
    depth, picture = _both(scene)
    _, empty = _both(_scene())
    drawn = np.any(picture != empty, axis=2)
    seen = (depth < 5.0) & ~_floor(depth)
    below = np.arange(120)[:, np.newaxis] > 64  # of the hip
    assert np.sum(below & seen) > 150
    assert np.sum(below & (drawn != seen)) < 0.2 * np.sum(below & seen)


def test_no_wall_is_black() -> None:
    """Corridors in four directions, seen from their middle."""
    for turn in (0.0, 0.5 * math.pi):
        c, s = math.cos(turn), math.sin(turn)
        ends = np.array([[-9, -2, 9, -2], [9, 2, -9, 2]], np.float64)
        walls = [
            [c * a - s * b, s * a + c * b, c * e - s * f, s * e + c * f] for a, b, e, f in ends
        ]
        scene = Scene(walls, [0.0, 2.5], [], [])
        scene.update(
            RobotState(*POSE, 0, 0, 0, 0, 0.0102, 0, 0), np.zeros((0, 4)), np.zeros(0, np.bool_)
        )
        for way in (0.0, math.pi):
            pinhole = build(SPEC).info().camera
            assert pinhole is not None
            picture = Renderer(scene, pinhole, (0.0, 0.0, 1.0, 0.0))(scene, Pose(0, 0, turn + way))
            assert np.all(picture.max(axis=2) > 30)


def test_a_person_is_low_poly_and_as_tall_as_said() -> None:
    leg = leg_obj(1.8, 0.33).splitlines()
    assert sum(line.startswith("f ") for line in leg) < 40
    lines = trunk_obj(1.8, 0.33).splitlines()
    points = np.array([[float(x) for x in li.split()[1:]] for li in lines if li.startswith("v ")])
    faces = [line for line in lines if line.startswith("f ")]
    assert 40 <= len(faces) <= 60
    assert points[:, 2].min() == pytest.approx(0.53 * 1.8)
    assert points[:, 2].max() == pytest.approx(1.8)
    assert np.hypot(points[:, 0], points[:, 1]).max() < 0.33
    normals = [line for line in lines if line.startswith("vn ")]
    for face in faces:
        for corner in face.split()[1:]:
            vertex, normal = (int(n) for n in corner.split("//"))
            assert 1 <= vertex <= len(points)
            assert 1 <= normal <= len(normals)


def test_without_egl_the_error_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    """The loader of EGL finds no driver: the failed try dies in its own process."""
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere.json")
    with pytest.raises(MissingLibraryError, match="apt-get install libegl1 libgl1"):
        check_egl.__wrapped__()


def test_a_run_that_cannot_draw_ends_before_it_starts(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    extra = "robots.robot.sensors.camera={kind: rgbd_camera, colour: true}"
    arguments = ["simulate", "challenge-2020", "in-d0125-slow-c01-r02", "--planner", "goal_seek"]
    check_egl.cache_clear()
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere.json")
    try:
        assert main([*arguments, "--set", extra, "--out", str(tmp_path / "runs")]) == 4
    finally:
        check_egl.cache_clear()
    assert "colour images need EGL" in capsys.readouterr().err
    assert not (tmp_path / "runs").exists()
