"""Images in whole millimetres are those of readings in m."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.sensing.depth_mm import depth_mm
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.plugin import DepthCamera, Pose, TiltableMount
from crowdbot.plugins.sensors.rgbd_camera import RgbdCameraSpec
from crowdbot.plugins.sensors.rgbd_camera_build import build
from crowdbot.testing.sensor_scenes import context
from tests.core.sensing.sensing_worlds import world

ERRORS = {"noise": 0.01, "resolution": 0.003, "bits": 7, "dropout": 0.1, "max_incidence": 1.0}


def test_rounded_to_even_and_zero_where_nothing_was_measured() -> None:
    depth = np.array([[0.0, 0.4, math.inf, 1.2345, 65.535, 65.5351, math.nan]], np.float32)
    assert depth_mm(depth).tolist() == [[0, 400, 0, 1234, 65535, 0, 0]]


@settings(max_examples=200)
@given(
    st.integers(0, 2**32 - 1),
    st.integers(2, 40),
    st.sampled_from([0.7, 9.0, 65.5, 65.534, 65.535, 80.0]),
    st.sampled_from([{}, *({n: x} for n, x in ERRORS.items())]),
)
def test_a_camera_rounds_its_own_reading(
    seed: int, width: int, farthest: float, errors: dict[str, float]
) -> None:
    scene, rng = world(seed), np.random.default_rng(seed)
    pose = Pose(*rng.uniform(-7, 7, 3))
    mount = TiltableMount(z=float(rng.uniform(0.05, 2.2)))
    fields = {"width": width, "height": 30, "depth_min": 0.3, "depth_max": farthest, **errors}
    camera = build(RgbdCameraSpec(mount=mount, **fields), context())  # type: ignore[arg-type]
    assert isinstance(camera, DepthCamera)
    reading = camera.read(scene, pose, 0.0, sensor_rng(0, "robot", "camera", 3))
    image = camera.depth_mm(scene, pose, 0.0, sensor_rng(0, "robot", "camera", 3))
    assert image.dtype == np.uint16
    np.testing.assert_array_equal(image, depth_mm(reading))


@pytest.mark.parametrize("tall", [1, 2])
def test_a_picture_of_nothing(tall: int) -> None:
    camera = build(RgbdCameraSpec(width=2, height=2 * tall, mount=TiltableMount(z=90.0)), context())
    image = camera.depth_mm(world(0), Pose(0.0, 0.0, 0.0), 0.0, sensor_rng(0, "r", "c", 0))
    assert image.tolist() == [[0, 0]] * 2 * tall
