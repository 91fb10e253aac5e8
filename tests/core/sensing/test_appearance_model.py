"""People of different looks: legs, phases, wheelchairs and luggage are seen; discs stay."""

from __future__ import annotations

import math
from typing import get_args

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.sensing.body_model import BOTTOM, PARTS, RADIUS, TOP, TRUNK
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.types.appearance import Appearance
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.scenario.people_kinds import AppearanceName
from tests.core.sensing.sensing_worlds import crowd_of

NO_WALLS = np.zeros((0, 4))


def looks_of(*names: str, height: float = 0.0, leg: float = 0.0, phase: float = 0.0) -> Appearance:
    count = len(names)
    return Appearance(
        height=np.full(count, height),
        leg_length=np.full(count, leg),
        phase=np.full(count, phase),
        look=names,
    )


def scene_of(looks: Appearance | None, xyv: Array, way: Array, walked: Array) -> Scene:
    count = len(xyv)
    scene = Scene(NO_WALLS, (0.0, 2.5), np.full(count, 0.33), 1.7, looks=looks)
    scene.update(None, xyv, np.ones(count, np.bool_), way, walked)
    return scene


def still(looks: Appearance | None, x: float = 3.0) -> Scene:
    xyv = np.array([[x, 0.0, 0.0, 0.0]])
    return scene_of(looks, xyv, np.array([[0.0, 1.0]]), np.zeros(1))


@given(st.integers(0, 2**32 - 1), st.integers(1, 8))
@settings(max_examples=40)
def test_adults_of_usual_size_look_as_ever(seed: int, count: int) -> None:
    crowd = crowd_of(seed, count)
    plain, dressed = scene_of(None, *crowd), scene_of(looks_of(*["adult"] * count), *crowd)
    np.testing.assert_allclose(dressed.cylinders, plain.cylinders, rtol=0, atol=1e-12)


def test_phases_differ_between_people() -> None:
    xyv, way = np.array([[3.0, 0.0, 1.3, 0.0]]), np.array([[1.0, 0.0]])
    one = scene_of(looks_of("adult"), xyv, way, np.array([0.1])).cylinders[:2].copy()
    other = scene_of(looks_of("adult", phase=math.pi), xyv, way, np.array([0.1])).cylinders[:2]
    assert np.abs(one[0] - other[0]).max() > 0.05
    half_stride = 0.5 * 0.83 * 1.7
    moved = scene_of(looks_of("adult"), xyv, way, np.array([0.1 + half_stride])).cylinders[:2]
    np.testing.assert_allclose(moved, other, atol=1e-9)


def test_legs_are_as_long_as_they_are() -> None:
    bodies = still(looks_of("adult", height=1.5, leg=0.7)).cylinders
    assert bodies[0, TOP] == bodies[TRUNK, BOTTOM] == pytest.approx(0.7)
    assert bodies[TRUNK, TOP] == pytest.approx(1.5)


@pytest.mark.parametrize("look", get_args(AppearanceName))
def test_what_each_look_adds(look: str) -> None:
    scene = still(looks_of(look))
    assert len(scene.cylinders) == PARTS + (look in ("wheelchair_user", "stroller", "suitcase"))
    assert len(scene.things) == len(scene.cylinders) - PARTS


def range_at(scene: Scene, height: float, toward: tuple[float, float]) -> float:
    origin = np.array([[0.0, 0.0, height]])
    distance, _, _ = scene.cast(origin, np.array([[*toward, 0.0]]), 10.0)
    return float(distance[0])


def test_a_lidar_sees_a_wheelchair_where_it_sees_between_legs() -> None:
    ahead = (1.0, 0.0)
    legs, chair = still(None), still(looks_of("wheelchair_user", height=1.3))
    assert range_at(chair, 0.4, ahead) == pytest.approx(3.0 - 0.31)
    assert range_at(legs, 0.4, ahead) > 2.75
    assert math.isinf(range_at(chair, 1.5, ahead)) != math.isinf(range_at(legs, 1.5, ahead))


def test_a_stroller_is_met_before_who_pushes_it_and_is_hers() -> None:
    scene = still(looks_of("stroller"))
    to = math.atan2(0.75, 3.0)
    distance, _, body = scene.cast(
        np.array([[0.0, 0.0, 0.4]]), np.array([[math.cos(to), math.sin(to), 0.0]]), 10.0
    )
    assert distance[0] == pytest.approx(math.hypot(3.0, 0.75) - 0.27)
    assert body[0] == 0
    assert scene.people_radius[0] == 0.33  # what touches


def test_what_the_absent_have_is_not_seen() -> None:
    scene = still(looks_of("suitcase"))
    scene.update(None, np.array([[3.0, 0.0, 0.0, 0.0]]), np.zeros(1, np.bool_))
    assert math.isinf(range_at(scene, 0.3, (1.0, 0.0)))
    assert np.isinf(scene.cylinders[:, 0]).all()


def test_children_are_thinner_and_shorter() -> None:
    radius = np.array([0.33, 0.2])
    scene = Scene(
        NO_WALLS, (0.0, 2.5), radius, 1.7,
        looks=Appearance(height=np.array([1.7, 1.27]), leg_length=np.zeros(2), phase=np.zeros(2),
                    look=("adult", "child")),
    )  # fmt: skip
    scene.update(None, np.zeros((2, 4)), np.ones(2, np.bool_))
    adult, child = scene.cylinders[:PARTS], scene.cylinders[PARTS : 2 * PARTS]
    assert np.all(child[:, RADIUS] < adult[:, RADIUS])
    assert child[TRUNK, TOP] < adult[TRUNK, TOP]
