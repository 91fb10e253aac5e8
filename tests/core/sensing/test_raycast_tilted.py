"""Rays of tilted sensors: the same as ray by ray, and the floor."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from crowdbot.core.geometry.rotation import rotation
from tests.core.sensing.sensing_worlds import scene_of

Array = NDArray[np.float64]
TURN = rotation(0.3, -0.2, 1.0)


def _rays(rng: np.random.Generator, count: int) -> Array:
    rays = rng.normal(size=(count, 3))
    rays[:4] = [[0, 0, -1], [0, 0, 1], [1, 0, 0], [-1, 0, 0]]
    return np.asarray(rays / np.linalg.norm(rays, axis=1, keepdims=True))


@given(seed=st.integers(0, 10_000), height=st.floats(0.0, 2.4), reach=st.floats(1.0, 20.0))
@settings(max_examples=60)
def test_the_same_as_ray_by_ray(seed: int, height: float, reach: float) -> None:
    """Random walls, people and pillars, the sensor among them or inside; and the floor by hand."""
    rng = np.random.default_rng(seed)
    scene = scene_of(
        rng.uniform(-6, 6, (12, 2)), rng.uniform(-6, 6, (8, 4)),
        pillars=np.column_stack([rng.uniform(-6, 6, (5, 2)), rng.uniform(0.1, 2.0, 5)]),
        pillar_heights=(0.3, 1.9),
    )  # fmt: skip
    own, at = _rays(rng, 200), (*rng.uniform(-1, 1, 2).tolist(), height)
    rays = own @ TURN.T
    found, incidence, body = scene.cast_tilted(at, TURN, own, reach)
    bodies, slanted, who = scene.cast(np.tile(at, (len(rays), 1)), rays, reach)
    down = np.maximum(-rays[:, 2], 0.0)
    floor = np.divide(height, down, out=np.full(len(rays), math.inf), where=down > 0.0)
    floor[floor > reach] = math.inf
    np.testing.assert_allclose(found, np.minimum(floor, bodies), rtol=1e-12)
    struck = bodies < floor
    np.testing.assert_array_equal(body[struck], who[struck])
    np.testing.assert_allclose(incidence[struck], slanted[struck], atol=1e-7)
    missed = np.isfinite(floor) & (floor < bodies)
    np.testing.assert_array_equal(body[missed], -1)
    np.testing.assert_allclose(incidence[missed], np.arccos(down[missed]), atol=1e-7)
    assert np.all(incidence[np.isinf(found)] == 0.0)


def test_walls_that_end_at_the_sensor_or_behind_it() -> None:
    """A wall through the sensor, one that passes behind, one without length."""
    walls = [[-1, 0, 1, 0], [-3, -2, -3, 2], [2, 2, 2, 2]]
    scene = scene_of(walls=walls)
    rays = np.array([[0, 1.0, 0], [-1.0, 0, 0], [math.sqrt(0.5), math.sqrt(0.5), 0]])
    found, _, _ = scene.cast_tilted((0.0, 0.0, 1.0), np.eye(3), rays, 9.0)
    expected, _, _ = scene.cast(np.tile([0.0, 0.0, 1.0], (3, 1)), rays, 9.0)
    np.testing.assert_allclose(found, expected)
    assert found[1] == pytest.approx(3.0)
