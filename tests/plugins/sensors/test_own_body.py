"""No sensor of the challenge's robot sees the robot that carries it."""

from __future__ import annotations

import math
from typing import cast

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.sensing.build import build_sensor
from crowdbot.plugin import Pose, Sensor
from crowdbot.testing.sensor_scenes import context
from tests.core.sensing.sensing_worlds import BASE, REGISTRY, Array, read, scene_of
from tests.examples import costly

SENSORS = open_spec("challenge-2020", REGISTRY).scenarios[0].robots["robot"].sensors
BUILT: dict[str, Sensor] = {
    name: cast(Sensor, build_sensor(REGISTRY, spec, context()))
    for name, spec in SENSORS.items()
    if spec.kind not in ("wheel_odometry", "imu")
}


def _empty(name: str, values: Array, height: float) -> bool:
    """Whether a reading shows nothing at all, or the floor alone."""
    info = BUILT[name].info()
    if info.camera is None:
        return bool(np.isinf(values).all())
    rows = np.arange(info.camera.height) - info.camera.centre[1]
    with np.errstate(divide="ignore"):
        floor = np.where(rows > 0.0, height * info.camera.focal / rows, np.inf)
    seen = np.isfinite(values)
    return bool(np.all(values[seen] > 0.97 * np.broadcast_to(floor[:, None], values.shape)[seen]))


@given(x=st.floats(-40.0, 40.0), y=st.floats(-4.0, 4.0), yaw=st.floats(-math.pi, math.pi))
@costly(40)
def test_alone_in_the_world_nothing_is_seen(x: float, y: float, yaw: float) -> None:
    scene = scene_of()
    assert len(BUILT) >= 15
    for name, one in BUILT.items():
        height = one.info().mount[2] + BASE
        assert _empty(name, read(one, scene, Pose(x, y, yaw)), height), name


@given(yaw=st.floats(-math.pi, math.pi))
@costly(20)
def test_four_walls_are_all_that_is_seen(yaw: float) -> None:
    """A room of 6 m: every beam of a lidar ends on a wall, at the distance of the nearest line."""
    corners = np.array([[3.0, 3.0], [-3.0, 3.0], [-3.0, -3.0], [3.0, -3.0]])
    scene = scene_of(walls=np.hstack([corners, np.roll(corners, -1, axis=0)]))
    pose = Pose(0.4, -0.3, yaw)
    for name in ("front_lidar", "rear_lidar"):
        info = BUILT[name].info()
        assert info.angles is not None
        mx, my, _, turned = info.mount
        at_x = pose.x + math.cos(yaw) * mx - math.sin(yaw) * my
        at_y = pose.y + math.sin(yaw) * mx + math.cos(yaw) * my
        c, s = np.cos(yaw + turned + info.angles), np.sin(yaw + turned + info.angles)
        to_x = np.where(c > 0, 3.0 - at_x, 3.0 + at_x) / np.maximum(np.abs(c), 1e-9)
        to_y = np.where(s > 0, 3.0 - at_y, 3.0 + at_y) / np.maximum(np.abs(s), 1e-9)
        expected = np.minimum(to_x, to_y)
        found = read(BUILT[name], scene, pose)
        assert np.max(np.abs(found - expected)) < 0.01  # noise of 1 mm
