"""The bumper: sectors, people, walls, pillars."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from crowdbot.core.registry.build_reference import load_build
from crowdbot.core.sensing.scene import Scene
from crowdbot.plugin import Mount, Pose
from crowdbot.plugins.sensors.bumper import BUMPER, BumperSpec
from crowdbot.plugins.sensors.bumper_build import build
from crowdbot.testing.sensor_scenes import context

FULL = BumperSpec(sectors=12, angle_min=-math.pi, angle_max=math.pi)


def pressed(
    spec: BumperSpec,
    walls: object = (),
    people: object = (),
    pose: Pose = Pose(0, 0, 0),  # noqa: B008 - a constant
    heights: tuple[float, float] = (0.0, 2.5),
    pillars: object = (),
    present: bool = True,
) -> list[int]:
    xy = np.reshape(np.asarray(people, np.float64), (-1, 2))
    xyv = np.hstack([xy, np.zeros_like(xy)])
    scene = Scene(walls, heights, np.full(len(xy), 0.33), 1.7, pillars)  # type: ignore[arg-type]
    scene.update(None, xyv, np.full(len(xy), present))
    values = build(spec, context()).read(scene, pose, 0.0, np.random.default_rng(0))
    assert set(values) <= {0.0, 1.0}
    return [int(k) for k in np.flatnonzero(values)]


def test_info_is_the_kobukis() -> None:
    info = build(BumperSpec(), context()).info()
    assert (info.category, info.shape, info.random, info.memory) == ("bumper", (3,), False, 0)
    assert info.angles == pytest.approx(np.radians([-90, -30, 30, 90]))
    assert load_build(BUMPER) is build


@pytest.mark.parametrize(
    ("bearing", "sectors"), [(-60, [0]), (0, [1]), (29, [1]), (31, [2]), (89, [2]), (120, [])]
)
def test_somebody_presses_the_sector_that_faces_them(bearing: float, sectors: list[int]) -> None:
    for gap, felt in ((-0.01, sectors), (0.0019, sectors), (0.0021, [])):
        away = 0.178 + 0.33 + gap
        at = away * math.cos(math.radians(bearing)), away * math.sin(math.radians(bearing))
        assert pressed(BumperSpec(), people=[at]) == felt


@settings(max_examples=60)
@given(st.floats(-math.pi, math.pi), st.floats(-math.pi, math.pi), st.floats(-math.pi, math.pi))
def test_only_the_bearing_from_the_robot_counts(bearing: float, yaw: float, turn: float) -> None:
    away, pose = 0.5, Pose(3.0, -2.0, yaw)
    way = yaw + turn + bearing
    at = 3.0 + away * math.cos(way), -2.0 + away * math.sin(way)
    spec = FULL.model_copy(update={"mount": Mount(yaw=turn)})
    (sector,) = pressed(spec, people=[at], pose=pose)
    low, high = -math.pi + sector * math.pi / 6, -math.pi + (sector + 1) * math.pi / 6
    assert low - 1e-6 <= math.remainder(bearing, 2 * math.pi) <= high + 1e-6 or (
        abs(abs(bearing) - math.pi) < 1e-6
    )


def test_walls() -> None:
    wall = [[0.179, -5.0, 0.179, 5.0]]
    assert pressed(BumperSpec(), walls=wall) == [1]
    assert pressed(BumperSpec(), walls=wall, pose=Pose(0, 0, math.pi / 4)) == [0]
    assert pressed(BumperSpec(), walls=wall, pose=Pose(-0.01, 0, 0)) == []
    assert pressed(BumperSpec(), walls=wall, heights=(0.5, 2.0)) == []  # it drives below
    assert pressed(BumperSpec(), walls=[[0.1, 0.14, 0.1, 5.0]]) == [2]  # the end of a wall
    assert pressed(BumperSpec(), walls=[[0.179, -5, 0.179, 0.178], [9, 0.1781, -9, 0.1781]]) == [
        1,
        2,
    ]


def test_pillars_and_crowds() -> None:
    assert pressed(BumperSpec(), pillars=[[0.5, 0.0, 0.33]]) == [1]
    assert pressed(FULL, people=[(0.4, 0.1), (0.1, -0.45), (-0.4, 0.02)]) == [3, 6, 11]
    assert pressed(FULL, people=[(0.4, 0.1)], present=False) == []
    assert pressed(FULL) == []


def test_inside_somebody_one_sector_is_pressed() -> None:
    assert len(pressed(FULL, people=[(0.0, 0.0)])) == 1


@pytest.mark.parametrize(
    "fields",
    [{"sectors": 0}, {"angle_min": 1.0, "angle_max": 1.0}, {"angle_max": 9.0}, {"radius": 0.0}],
)
def test_refused(fields: dict[str, float]) -> None:
    with pytest.raises(ValidationError):
        BumperSpec(**fields)  # type: ignore[arg-type]
