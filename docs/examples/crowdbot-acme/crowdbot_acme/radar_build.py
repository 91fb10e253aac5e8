"""The radar, from the people of the scene."""

from __future__ import annotations

import math

import numpy as np
from crowdbot.plugin import (
    Pose,
    Scene,
    SensorContext,
    SensorInfo,
    SensorMessage,
    mount_pose,
    sensor_pose_in_world,
)
from numpy.typing import NDArray

from crowdbot_acme.radar import RadarSpec

Array = NDArray[np.float64]

#: What recordings and ROS clients get: `fields` of a reading; the header is filled in.
_MESSAGE = SensorMessage(
    definitions={
        "acme_msgs/msg/Radar": "std_msgs/Header header\n"
        "float64 distance\nfloat64 closing_speed\nfloat64 bearing\n"
    },
    fields=lambda values: dict(
        zip(("distance", "closing_speed", "bearing"), values.tolist(), strict=True)
    ),
    topic="radar",
)


class Radar:
    """Keeps nothing between readings and draws nothing."""

    def __init__(self, spec: RadarSpec) -> None:
        self._spec = spec
        self._info = SensorInfo(
            category="radar",
            frame="radar",
            mount=mount_pose(spec.mount),
            rate=spec.rate,
            shape=(3,),
            ros_type="acme_msgs/msg/Radar",
            message=_MESSAGE,
            range_max=spec.range_max,
            random=False,
        )

    def info(self) -> SensorInfo:
        """Constant description."""
        return self._info

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Distance to the surface (m), closing speed (m/s), bearing (rad); inf, 0, 0: no one."""
        del t, rng
        (x, y, _), yaw = sensor_pose_in_world(self._spec.mount, scene, pose)
        offset = scene.people[:, :2] - [x, y]
        distance = np.hypot(offset[:, 0], offset[:, 1]) - scene.people_radius
        bearing = _wrapped(np.arctan2(offset[:, 1], offset[:, 0]) - yaw)
        seen = scene.present & (distance <= self._spec.range_max)
        seen &= np.abs(bearing) <= 0.5 * self._spec.opening
        if not np.any(seen):
            return np.array([math.inf, 0.0, 0.0])
        i = int(np.argmin(np.where(seen, distance, math.inf)))
        way = offset[i] / max(float(np.hypot(*offset[i])), 1e-9)
        closing = -float((scene.people[i, 2:] - _velocity(scene)) @ way)
        return np.array([max(float(distance[i]), 0.0), closing, float(bearing[i])])


def _velocity(scene: Scene) -> Array:
    """Return the velocity of the robot in the world frame, m/s."""
    robot = scene.robot
    return np.zeros(2) if robot is None else np.array([robot.vx, robot.vy])


def _wrapped(angle: Array) -> Array:
    return np.asarray((angle + math.pi) % (2.0 * math.pi) - math.pi)


def build(spec: RadarSpec, context: SensorContext) -> Radar:
    """Return a radar; it is the same on every robot."""
    del context
    return Radar(spec)
