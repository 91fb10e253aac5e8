"""Rendered depth against the rays, one by one."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from crowdbot.core.sensing.depth_renderer import DepthRenderer
from crowdbot.core.sensing.ray_grid import DEEPEST, RayGrid
from crowdbot.core.sensing.scene import Scene
from crowdbot.plugin import Pinhole
from tests.core.sensing.sensing_worlds import scene_of, world

Array = NDArray[np.float64]
At = tuple[float, float, float]


def by_rays(scene: Scene, renderer: DepthRenderer, at: At, yaw: float) -> Array:
    """Depth (H, W) along the axis of what `Scene.cast_grid` hits."""
    left, cosine = renderer.left[::-1], renderer.cos_azimuth[::-1]
    grid = RayGrid(np.arctan(left), renderer.slope, cosine)
    length, _, _ = scene.cast_grid(grid, at, yaw, 1e3, floor=True)
    depth: Array = length * cosine / np.sqrt(1.0 + (renderer.slope[:, None] * cosine) ** 2)
    return depth[:, ::-1]


@pytest.mark.slow
@settings(max_examples=500)
@given(
    st.integers(0, 2**32 - 1), st.integers(1, 40), st.integers(1, 40), st.floats(0.2, 3.0),
    st.booleans(),
)  # fmt: skip
def test_painted_depth_is_that_of_the_rays(
    seed: int, width: int, height: int, view: float, near: bool
) -> None:
    """Tops, bottoms and faces of bodies, from outside, from within and beside."""
    rng = np.random.default_rng(seed)
    scene, yaw = world(seed), float(rng.uniform(-9, 9))
    x, y = rng.uniform(-6, 6, 2).tolist()
    spots = scene.cylinders[np.isfinite(scene.cylinders[:, 0])]
    if near and len(spots):  # bodies beside and around the camera have no projection
        x, y = rng.choice(spots)[:2] + rng.uniform(-0.4, 0.4, 2)
    at = (float(x), float(y), float(rng.uniform(0.05, 2.2)))
    nearest, farthest = 0.5, 9.0
    focal = 0.5 * width / math.tan(0.5 * view)
    renderer = DepthRenderer(Pinhole(width=width, height=height, focal=focal), nearest, farthest)
    depth, true = scene.render_depth(renderer, at, yaw), by_rays(scene, renderer, at, yaw)
    assert depth.shape == (height, width)
    assert depth.dtype == np.float32
    expected = np.where(true < nearest, 0.0, np.where(true <= farthest, true, np.inf))
    np.testing.assert_array_equal(depth, expected.astype(np.float32))


def test_more_bodies_than_a_column_of_rays_holds() -> None:
    """Of any number of bodies behind one another the nearest is seen."""
    x = 1.0 + 0.5 * np.random.default_rng(0).permutation(3 * DEEPEST)
    pillars = np.column_stack([x, np.zeros_like(x), np.full_like(x, 0.2)])
    renderer = DepthRenderer(Pinhole(width=3, height=3, focal=300.0), 0.1, 99.0)
    depth = scene_of(pillars=pillars).render_depth(renderer, (0.0, 0.0, 0.3), 0.0)
    assert depth == pytest.approx(0.8, abs=1e-3)


def test_nobody_and_the_absent_are_nowhere() -> None:
    scene = world(1)
    gone = np.zeros(len(scene.people), np.bool_)
    scene.update(None, np.full((len(gone), 4), np.nan), gone)
    renderer = DepthRenderer(Pinhole(width=9, height=2, focal=9.0), 0.1, 99.0)
    depth = scene.render_depth(renderer, (90.0, 0.0, 1.0), 0.0)
    np.testing.assert_array_equal(depth[0], np.inf)
    np.testing.assert_allclose(depth[1], 18.0)
