"""Grids of rays against the same rays one by one."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.geometry.rough_angle import rough_angle
from crowdbot.core.sensing.ray_columns import rough_half
from crowdbot.core.sensing.ray_grid import DEEPEST, RayGrid
from crowdbot.core.sensing.scene import Scene
from tests.core.sensing.sensing_worlds import scene_of, world
from tests.examples import costly


@costly(200)
@given(st.integers(0, 2**32 - 1), st.booleans(), st.booleans(), st.floats(0.5, 12.0))
def test_a_grid_is_its_rays(seed: int, floor: bool, leaning: bool, reach: float) -> None:
    rng = np.random.default_rng(seed)
    scene, yaw = world(seed), float(rng.uniform(-9, 9))
    at = (*rng.uniform(-6, 6, 2).tolist(), float(rng.uniform(0.05, 2.2)))
    first, turn = rng.uniform(-7, 7), rng.uniform(0.01, 2 * math.pi)
    azimuth = first + np.sort(rng.uniform(0.0, turn, int(rng.integers(1, 40))))
    slope = np.append(rng.uniform(-1.5, 1.5, int(rng.integers(0, 6))), 0.0)
    scale = rng.uniform(0.5, 1.0, len(azimuth)) if leaning else None
    grid = RayGrid(azimuth, slope, scale)
    distance, incidence, body = scene.cast_grid(grid, at, yaw, reach, floor=floor)
    slope = slope[:, None] * grid.slope_scale
    level = np.stack([np.cos(azimuth + yaw), np.sin(azimuth + yaw)], axis=-1)
    rays = np.concatenate(
        [np.broadcast_to(level, (*slope.shape, 2)), slope[..., None]], axis=-1
    ).reshape(-1, 3)
    one_by_one = scene.cast(np.tile(at, (len(rays), 1)), rays, reach)
    d, a, b = (x.reshape(grid.shape) for x in one_by_one)
    if floor:
        with np.errstate(divide="ignore"):
            down = np.where(slope < 0.0, -at[2] / slope, np.inf) * np.hypot(1.0, slope)
        under = (down < d) & (down <= reach)
        steep = math.pi / 2 - np.abs(np.arctan(slope))
        d, a, b = np.where(under, down, d), np.where(under, steep, a), np.where(under, -1, b)
    np.testing.assert_allclose(distance, d, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(incidence, a, atol=1e-5)  # acos is blunt at 0
    inside = distance == 0.0  # of several bodies around the sensor either may be named
    np.testing.assert_array_equal(body[~inside], b[~inside])
    blind = scene.cast_grid(grid, at, yaw, reach, floor=floor, details=False)
    np.testing.assert_array_equal(blind[0], distance)
    assert blind[1].size == blind[2].size == 0


def test_no_rays() -> None:
    scene = world(3)
    for azimuth, slope, shape in (([], [0.0], (1, 0)), ([0.0, 1.0], [], (0, 2)), ([], [], (0, 0))):
        distance, incidence, body = scene.cast_grid(RayGrid(azimuth, slope), (0, 0, 1), 0.0, 9.0)
        assert distance.shape == incidence.shape == body.shape == shape
    assert [len(x) for x in scene.cast(np.empty((0, 3)), np.empty((0, 3)), 9.0)] == [0, 0, 0]


@pytest.mark.parametrize("slope", [[0.0], [0.0, 1e-3]])
def test_more_bodies_than_a_column_holds(slope: list[float]) -> None:
    """The nearest are kept, whatever the order in which they come; level rays need but one."""
    x = 1.0 + 0.5 * np.random.default_rng(0).permutation(3 * DEEPEST)
    pillars = np.column_stack([x, np.zeros_like(x), np.full_like(x, 0.2)])
    distance, _, body = scene_of(pillars=pillars).cast_grid(
        RayGrid([0.0], slope), (0.0, 0.0, 0.3), 0.0, 99.0
    )
    assert distance[0, 0] == pytest.approx(0.8)
    assert body[0, 0] == -2 - int(np.argmin(x))


def test_a_full_turn_has_no_seam() -> None:
    """Walls all round are seen by every beam, wherever the scan begins."""
    box = [[3, -3, 3, 3], [3, 3, -3, 3], [-3, 3, -3, -3], [-3, -3, 3, -3]]
    scene = scene_of(walls=np.array(box, np.float64))
    for start in (-math.pi, 0.0, 1.0, -7.0):
        for yaw in (0.0, 2.0, -3.0, 50.0):
            azimuth = start + np.arange(720) * math.pi / 360
            distance, _, _ = scene.cast_grid(RayGrid(azimuth, [0.0]), (0.3, -0.2, 0.3), yaw, 9.0)
            heading = azimuth + yaw
            with np.errstate(divide="ignore"):
                to_x = (3.0 * np.sign(np.cos(heading)) - 0.3) / np.cos(heading)
                to_y = (3.0 * np.sign(np.sin(heading)) + 0.2) / np.sin(heading)
            np.testing.assert_allclose(distance[0], np.minimum(to_x, to_y), rtol=1e-9)


def test_rough_angles_leave_no_column_out() -> None:
    """Together they are off by less than what discs are made wider by."""
    angles = np.linspace(-math.pi, math.pi, 4001)
    for angle in angles:
        x, y = 3.0 * math.cos(angle), 3.0 * math.sin(angle)
        assert rough_angle(x, y) == pytest.approx(math.atan2(y, x), abs=2e-5)
    for x, y in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)):
        assert rough_angle(x, y) == pytest.approx(math.atan2(y, x), abs=2e-5)
    for sine in np.linspace(0.0, 1.0, 1001):
        assert math.asin(sine) <= rough_half(sine) <= math.asin(sine) + 1e-3


def test_a_wall_along_which_a_ray_runs_is_never_hit_before_its_end() -> None:
    """Rounding decides nothing where ray and wall lie on one line."""
    walls = np.array([[-4.25, 4.25, -1.25, 1.25], [-6.0, 4.0, -4.0, 6.0]])
    scene = Scene(walls, (0.0, 2.5), np.zeros(0), 1.7)
    grid = RayGrid(np.linspace(-math.pi, math.pi, 720, endpoint=False), [0.0])
    distance, _, body = scene.cast_grid(grid, (0.0, 0.0, 1.0), 0.0, 25.0)
    along = int(np.argmin(np.abs(grid.azimuth - 0.75 * math.pi)))
    assert (distance[0, along], body[0, along]) == (pytest.approx(5.0 * math.sqrt(2.0)), -3)
    azimuth = grid.azimuth[along]
    ray = np.array([[math.cos(azimuth), math.sin(azimuth), 0.0]])
    for found in (scene.cast, lambda at, d, reach: scene.cast_tilted(at[0], np.eye(3), d, reach)):
        one, _, what = found(np.array([[0.0, 0.0, 1.0]]), ray, 25.0)
        assert (one[0], what[0]) == (pytest.approx(5.0 * math.sqrt(2.0)), -3)
