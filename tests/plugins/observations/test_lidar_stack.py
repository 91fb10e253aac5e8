"""Sectors of one or several lidars, of scans that lie some steps apart."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from crowdbot.core.learning.seen import LearningContext, RobotInputs
from crowdbot.core.types.robot import RobotBody, RobotLimits
from crowdbot.core.types.sensor import Pinhole, SensorInfo
from crowdbot.errors import InputError
from crowdbot.plugins.observations.lidar_stack import LidarStackSpec
from crowdbot.plugins.observations.lidar_stack_build import build

LIMITS = RobotLimits(v_min=-1.0, v_max=1.0, w_max=1.0, a_max=1.0, alpha_max=1.0)
BODY = RobotBody(
    drive="differential", radius=0.3, footprint=None, front=0.3, back=0.3, half_width=0.3
)
NAMES = ("front", "rear")


def context() -> LearningContext:
    one = SensorInfo(
        category="lidar", frame="lidar", mount=(0.0,) * 4, rate=16.0, shape=(8,),
        ros_type="sensor_msgs/msg/LaserScan",
    )  # fmt: skip
    return LearningContext(worlds=1, limits=LIMITS, body=BODY, sensors=dict.fromkeys(NAMES, one))


def scans(spec: LidarStackSpec, steps: int) -> Any:
    """The scans of an observer that sees n / 10 of its range ahead, and all free behind, at n."""
    observer, found = build(spec, context()), []
    for step in range(steps):
        seen = RobotInputs(
            fresh=np.array([step == 0]),
            stepped=np.array([step > 0]),
            pose=np.zeros((1, 3)),
            twist=np.zeros((1, 3)),
            goal=np.ones((1, 2)),
            readings={
                "front": np.full((1, 8), 0.1 * step * spec.range),
                "rear": np.full((1, 8), np.inf),
            },
        )
        found.append(observer.observe(seen)[0, :-6].tolist())
    return found


def test_scans_lie_some_steps_apart() -> None:
    spec = LidarStackSpec(sensor="front", sectors=4, scans=3, stride=2)
    seen = scans(spec, 6)
    assert seen[5] == pytest.approx(np.repeat([0.5, 0.3, 0.1], 4))
    assert seen[1] == pytest.approx(np.repeat([0.1, 0.0, 0.0], 4))
    usual = scans(LidarStackSpec(sensor="front", sectors=4, scans=3), 6)
    assert usual[5] == pytest.approx(np.repeat([0.5, 0.4, 0.3], 4))


def test_further_lidars_follow_in_each_scan() -> None:
    spec = LidarStackSpec(sensor="front", others=("rear",), sectors=4, scans=2)
    assert spec.needs == NAMES
    assert scans(spec, 3)[2] == pytest.approx(np.repeat([0.2, 1.0, 0.1, 1.0], 4))


def test_a_lidar_that_is_not_there_is_named() -> None:
    with pytest.raises(InputError, match="no sensor 'left'"):
        build(LidarStackSpec(sensor="front", others=("left",)), context())


def test_a_depth_camera_sees_what_stands_but_not_the_floor() -> None:
    camera = SensorInfo(
        category="camera", frame="camera", mount=(0.0, 0.0, 0.4, 0.0), rate=8.0, shape=(2, 4),
        ros_type="sensor_msgs/msg/Image", range_min=0.3,
        camera=Pinhole(width=4, height=2, focal=2.0),
    )  # fmt: skip
    spec = LidarStackSpec(sensor="camera", sectors=4, scans=1, range=4.0)
    observer = build(spec, replace(context(), sensors={"camera": camera}))
    # The lower row looks down by 1 in 4: at 2 m it sees the floor, at 0.8 m what is 0.2 m high.
    depth = np.array([[[2.0, np.inf, 3.0, 0.0], [2.0, 0.8, 2.0, 2.0]]])
    seen = RobotInputs(
        fresh=np.array([True]), stepped=np.array([False]), pose=np.zeros((1, 3)),
        twist=np.zeros((1, 3)), goal=np.ones((1, 2)), readings={"camera": depth},
    )  # fmt: skip
    left = np.hypot(1.0, [0.75, 0.25, 0.25, 0.75])
    wanted = left * [2.0, 0.8, 3.0, 0.3] / 4.0
    assert observer.observe(seen)[0, :4] == pytest.approx(wanted[::-1])
