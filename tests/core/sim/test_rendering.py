"""Colour pictures show what the depth camera measures; machines that cannot draw say so."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from crowdbot.cli import main
from crowdbot.core.figures.figure import Figure, load_figure
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.registry.registry import discover
from crowdbot.core.robots.build import build_model
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.other_robots import OtherRobot
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sim.cameras.person_mesh import leg_obj, trunk_obj
from crowdbot.core.sim.cameras.rendering import Renderer, check_egl
from crowdbot.dsl.spec.component_specs import SceneLight
from crowdbot.errors import MissingLibraryError
from crowdbot.plugin import Pose, RobotModel, RobotState, TiltableMount
from crowdbot.plugins.sensors.rgbd_camera import RgbdCameraSpec
from crowdbot.plugins.sensors.rgbd_camera_build import build
from crowdbot.testing.sensor_scenes import context
from tests.core.figures.small_gltf import write
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


def _both(
    scene: Scene, tilt: tuple[float, float] = (0.0, 0.0), robots: Sequence[RobotModel] = ()
) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
    mount = SPEC.mount.model_copy(update={"roll": tilt[0], "pitch": tilt[1]})
    camera = build(SPEC.model_copy(update={"mount": mount}), context())
    info = camera.info()
    assert info.camera is not None
    depth = camera.read(scene, POSE, 0.0, sensor_rng(0, "robot", "camera", 0))
    return depth, Renderer(scene, info.camera, info.mount, info.tilt, robots)(scene, POSE)


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


TILTS = [(0.0, 0.2), (0.0, -0.15), (0.35, 0.0), (-0.3, 0.25)]


@pytest.mark.parametrize(("roll", "pitch"), TILTS)
def test_the_horizon_tilts_with_the_camera(roll: float, pitch: float) -> None:
    """Sky is where the ray of a pixel, turned by Ry(pitch) Rx(roll), points above the horizon."""
    _, picture = _both(_scene(), (roll, pitch))
    pinhole = build(SPEC, context()).info().camera
    assert pinhole is not None
    v, u = np.mgrid[0:120, 0:160]
    (cx, cy), f = pinhole.centre, pinhole.focal
    left, up = (cx - u) / f, (cy - v) / f
    left, up = (left * math.cos(roll) - up * math.sin(roll),
                left * math.sin(roll) + up * math.cos(roll))  # fmt: skip
    above = up * math.cos(pitch) - math.sin(pitch) > 0.0
    assert 0.1 < above.mean() < 0.9
    assert np.mean(_sky(picture) != above) < 0.02  # two rows: the floor ends 200 m away


@pytest.mark.parametrize("tilt", TILTS)
def test_a_tilted_camera_sees_pillars_where_depth_does(tilt: tuple[float, float]) -> None:
    depth, picture = _both(_scene(pillars=[[4.5, 2.2, 0.3], [6.0, 0.5, 0.5]]), tilt)
    _, empty = _both(_scene(), tilt)
    drawn = np.any(picture != empty, axis=2)
    seen = depth < floor_alone(tilt) - 1e-6
    assert seen.sum() > 500
    assert np.mean(drawn != seen) < 0.015


def floor_alone(tilt: tuple[float, float]) -> NDArray[np.float64]:
    """(H, W) the floor alone, m."""
    return _both(_scene(), tilt)[0]


@pytest.mark.parametrize("kind", ["turtlebot2", "pepper", "qolo", "cuybot", "smart_wheelchair"])
def test_another_robot_is_drawn_as_it_looks_within_its_outline(kind: str) -> None:
    """In its colours; no more than what the depth camera takes for its body, and much of it."""
    registry = discover(allow=())
    model = build_model(registry, registry.find("robot", kind).spec(kind=kind))
    body = OtherRobot(footprint_of_model(model), model.height)
    scene = Scene([], [0.0, 2.5], [], [], robots=[body])
    scene.show_robots([Pose(3.8, 2.2, 2.5)])
    robot = RobotState(*POSE, 0, 0, 0, 0, 0.0102, 0, 0)
    scene.update(robot, np.zeros((0, 4)), np.zeros(0, np.bool_))
    depth, picture = _both(scene, robots=[model])
    empty_depth, empty = _both(_scene())
    drawn = np.any(picture != empty, axis=2)
    body_seen = depth < empty_depth - 1e-6
    assert np.sum(drawn & ~body_seen) < 0.08 * np.sum(drawn)
    assert np.sum(drawn & body_seen) > 0.3 * np.sum(body_seen)
    assert len(np.unique(picture[drawn] // 24, axis=0)) >= 4
    _, upright = _both(scene)  # where nothing is known of its look
    assert np.mean(np.any(upright != empty, axis=2) != body_seen) < 0.01


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
    return np.isclose(
        depth, build(SPEC, context()).read(_scene(), POSE, 0.0, np.random.default_rng(0))
    )


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
            pinhole = build(SPEC, context()).info().camera
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
        more = ["--set", extra, "--out", str(tmp_path / "runs"), "--record", "all"]
        assert main([*arguments, *more]) == 4
    finally:
        check_egl.cache_clear()
    assert "colour images need EGL" in capsys.readouterr().err
    assert not (tmp_path / "runs").exists()


def test_light_changes_how_bright_the_picture_is_and_nothing_else() -> None:
    scene = _scene(pillars=[[4.5, 2.2, 0.3]])
    info = build(SPEC, context()).info()
    assert info.camera is not None
    lights = None, SceneLight(), SceneLight(sun=0.1, ambient=0.2, sky="#101018")
    pictures = [
        Renderer(scene, info.camera, info.mount, info.tilt, (), light)(scene, POSE).astype(float)
        for light in lights
    ]
    assert pictures[1].mean() == pytest.approx(pictures[0].mean(), rel=0.15)
    assert pictures[2].mean() < 0.4 * pictures[0].mean()
    assert np.allclose(pictures[2][0, 0], [16, 16, 24], atol=3)


@pytest.mark.parametrize("yaw", [0.0, 0.8, math.pi / 2, math.pi, -math.pi / 2])
def test_light_from_all_sides_reaches_every_wall_wherever_the_camera_looks(yaw: float) -> None:
    """Half of it makes walls and floor half as bright, and none of them black."""
    x, y, c, s = POSE.x, POSE.y, math.cos(yaw), math.sin(yaw)
    left, right = (
        [x - side * s, y + side * c, x - side * s + 9 * c, y + side * c + 9 * s]
        for side in (1.5, -1.5)
    )
    scene = Scene([left, right], [0.0, 2.5], [], [])
    info = build(SPEC, context()).info()
    camera, pose = info.camera, Pose(x, y, yaw)
    assert camera is not None

    def brightness(ambient: float) -> NDArray[np.float64]:
        light = SceneLight(sun=0.0, ambient=ambient, sky="#ffffff")
        ahead = (0.0, 0.0, 1.0, 0.0)
        image = Renderer(scene, camera, ahead, (0.0, 0.0), (), light)(scene, pose)
        return np.asarray(image.max(axis=2), np.float64)

    whole, half = brightness(1.0), brightness(0.5)
    solid = whole < 200.0  # without the sky and its edges
    assert solid.mean() > 0.3
    assert np.quantile(half[solid], 0.01) > 10.0
    assert np.quantile(np.abs(half - 0.5 * whole)[solid], 0.99) < 5.0


def test_figures_take_the_place_of_the_nearest_people(tmp_path: Path) -> None:
    red = load_figure(write(tmp_path / "red.glb", moves="node"))
    green = load_figure(write(tmp_path / "green.glb", textured=True))
    info = build(SPEC, context()).info()
    assert info.camera is not None

    def share(people: list[list[float]], figures: list[Figure], colour: int) -> float:
        scene = _scene(people)
        image = Renderer(scene, info.camera, info.mount, info.tilt, (), None, figures)(scene, POSE)  # type: ignore[arg-type]
        others = np.delete(image.astype(int), colour, axis=2).max(axis=2)
        return float((image[:, :, colour] > 2 * others + 20).mean())

    near, far = [[4.5, 2.2]], [[16.0, 2.7]]
    assert share(near, [red], 0) > 0.02
    assert share(near, [green], 1) > 0.02
    assert share(near, [], 1) == 0.0
    assert share(far, [green], 1) == 0.0
    crowd = [[4.0 + 0.3 * k, 2.0 + 0.2 * (k % 3)] for k in range(20)]
    assert share(crowd, [red, green], 1) > 0.005
