"""Sensors that look at the walls near them only read the same, bit by bit."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.core.sensing import walls_near as module
from crowdbot.core.sensing.depth_renderer import DepthRenderer
from crowdbot.core.sensing.ray_grid import RayGrid
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sensing.walls_near import WallsNear, in_scene
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.sensor import Pinhole

RNG = np.random.default_rng(7)
COUNT = 400


def _walls() -> Array:
    start = RNG.uniform(0.0, 30.0, (COUNT, 2))
    angle, length = RNG.uniform(0.0, math.tau, COUNT), RNG.uniform(0.1, 3.0, COUNT)
    return np.column_stack([start, start + length[:, None] * np.c_[np.cos(angle), np.sin(angle)]])


WALLS = np.concatenate([_walls(), [[5.0, 0.0, 5.0, 30.0], [5.0, 0.0, 5.0, 30.0]]])
HEIGHTS = np.column_stack([RNG.uniform(0.0, 0.8, len(WALLS)), RNG.uniform(1.0, 3.0, len(WALLS))])
PILLARS = np.column_stack([RNG.uniform(0.0, 30.0, (10, 2)), np.full(10, 0.3)])
PLACES = RNG.uniform(0.0, 30.0, (12, 2)).tolist()


def _scene() -> Scene:
    scene = Scene(WALLS, HEIGHTS, np.full(30, 0.25), 1.7, PILLARS)
    people = np.zeros((30, 4))
    people[:, :2] = np.random.default_rng(1).uniform(0.0, 30.0, (30, 2))
    scene.update(None, people, np.ones(30, np.bool_))
    return scene


def _readings() -> list[bytes]:
    """All kinds of rays, from several places."""
    scene, found = _scene(), list[bytes]()
    flat = RayGrid(np.linspace(-3.0, 3.0, 181), [0.0])
    layers = RayGrid(np.linspace(-1.0, 1.0, 61), np.linspace(-0.4, 0.2, 5))
    camera = DepthRenderer(Pinhole(width=64, height=32, focal=58.0), 0.4, 8.0)
    angles = np.linspace(-3.0, 3.0, 40)
    rays = np.column_stack([np.cos(angles), np.sin(angles), np.full(40, -0.05)])
    for x, y in PLACES:
        at = (x, y, 0.9)
        for grid in (flat, layers):
            for reach in (3.0, 25.0):
                found += [a.tobytes() for a in scene.cast_grid(grid, at, 0.3, reach, floor=True)]
        found += [a.tobytes() for a in scene.cast(np.tile(at, (40, 1)), rays, 6.0)]
        found += [a.tobytes() for a in scene.cast_tilted(at, np.eye(3), rays, 6.0)]
        found.append(scene.render_depth(camera, at, 0.3).tobytes())
        found.append(scene.render_depth_mm(camera, at, 0.3).tobytes())
    return found


def test_all_readings_are_those_of_all_walls(monkeypatch: pytest.MonkeyPatch) -> None:
    near = _readings()
    monkeypatch.setattr(module, "_FEW", 10**9)
    assert near == _readings()


def _rooms() -> Array:
    """Rooms of 4 m x 5 m with doors, whose walls touch, and a box in each."""
    walls = []
    for column in range(6):
        for row in range(5):
            x, y = 4.0 * column, 6.5 * row
            walls += [[x, y, x + 4.0, y], [x, y, x, y + 5.0], [x + 4.0, y, x + 4.0, y + 5.0]]
            walls += [[x, y + 5.0, x + 1.5, y + 5.0], [x + 2.5, y + 5.0, x + 4.0, y + 5.0]]
            walls += [[x + 1.0, y + 1.0, x + 1.6, y + 1.0], [x + 1.6, y + 1.0, x + 1.6, y + 1.4]]
    return np.array(walls)


def test_walls_behind_others_are_left_out_and_nothing_changes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    walls = _rooms()
    heights = np.tile([0.0, 2.5], (len(walls), 1))
    heights[5::7], heights[6::7] = (0.0, 0.8), (0.0, 0.8)
    near = WallsNear(walls, heights, len(walls))
    seen, every = near.near(9.3, 8.2, 10.0, 0.6), near.near(9.3, 8.2, 10.0)
    assert len(seen.segments) < 0.6 * len(every.segments)
    assert len(near.near(9.3, 8.2, 10.0, 2.6).segments) == len(every.segments)  # looks over walls
    monkeypatch.setattr("tests.core.sensing.test_walls_near.WALLS", walls)
    monkeypatch.setattr("tests.core.sensing.test_walls_near.HEIGHTS", heights)
    found = _readings()
    monkeypatch.setattr(module, "_FEW", 10**9)
    assert found == _readings()


def test_the_first_of_walls_that_lie_on_each_other_is_hit(monkeypatch: pytest.MonkeyPatch) -> None:
    walls = np.repeat(_rooms(), 2, axis=0)
    heights = np.tile([0.0, 2.5], (len(walls), 1))
    grid = RayGrid(np.linspace(-3.0, 3.0, 181), [0.0])
    near = Scene(walls, heights, np.zeros(0), 1.7).cast_grid(grid, (9.3, 8.2, 0.6), 0.3, 10.0)
    body = near[2][near[2] < -1]
    assert (body % 2 == 0).all()
    monkeypatch.setattr(module, "_FEW", 10**9)
    every = Scene(walls, heights, np.zeros(0), 1.7).cast_grid(grid, (9.3, 8.2, 0.6), 0.3, 10.0)
    assert [a.tobytes() for a in near] == [a.tobytes() for a in every]


def test_level_rays_stop_at_the_walls_of_single_rays() -> None:
    scene = _scene()
    grid = RayGrid(np.linspace(-3.0, 3.0, 181), [0.0])
    rays = np.column_stack([np.cos(grid.azimuth), np.sin(grid.azimuth), np.zeros(181)])
    for x, y in PLACES:
        at = (x, y, 0.9)
        distance, _, body = scene.cast_grid(grid, at, 0.0, 25.0)
        single, _, hit = scene.cast(np.tile(at, (181, 1)), rays, 25.0)
        np.testing.assert_allclose(distance[0], single, atol=1e-9)
        assert np.mean(body[0] == hit) > 0.99  # but for rays through common corners


def test_few_walls_are_near_and_the_moving_ones_always() -> None:
    near = WallsNear(WALLS, HEIGHTS, COUNT)
    found = near.near(15.0, 15.0, 2.0)
    assert found.indices is not None
    assert found.indices[-2:].tolist() == [COUNT, COUNT + 1]
    assert len(found.segments) < 0.2 * COUNT
    assert not found.segments.flags.writeable
    body = np.array([-1, 3, -2, -1 - len(found.indices), -2 - len(WALLS)])
    in_scene(body, found)
    assert body.tolist() == [-1, 3, -2 - found.indices[0], -3 - COUNT, -2 - len(WALLS)]
