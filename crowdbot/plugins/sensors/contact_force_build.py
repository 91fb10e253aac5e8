"""Contact force: the resultant of all contacts with people, moved to the mount.

A force F at the base with torque T about it has the torque T - r x F about a point r.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, Pose, Scene, SensorInfo, mount_pose
from crowdbot.plugins.sensors.contact_force import ContactForceSpec
from crowdbot.plugins.sensors.described_build import DescribedSensor


class ContactForce(DescribedSensor):
    """Reading: (3,) force x, y (N), torque about z (N m); ``range_max`` is the largest force, N."""

    def __init__(self, spec: ContactForceSpec) -> None:
        self._spec = spec
        self._info = SensorInfo(
            category="contact_force",
            frame="contact_force",
            mount=mount_pose(spec.mount),
            rate=spec.rate,
            shape=(3,),
            ros_type="geometry_msgs/msg/WrenchStamped",
            range_max=spec.force_max,
            random=spec.noise > 0.0,
            sees=False,
            feels=True,
        )

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Return the force of people in the last tick, in the axes of the mount."""
        del t
        spec, (fx, fy, torque) = self._spec, scene.push
        x, y = _turned(spec.mount.x, spec.mount.y, pose.yaw)
        ahead, aside = _turned(fx, fy, -(pose.yaw + spec.mount.yaw))
        felt = np.array([ahead, aside, torque - (x * fy - y * fx)])
        if self._info.random:
            felt += spec.noise * rng.standard_normal(3)
        size = math.hypot(felt[0], felt[1])
        if size > spec.force_max:
            felt *= spec.force_max / size
        return felt


def _turned(x: float, y: float, angle: float) -> tuple[float, float]:
    c, s = math.cos(angle), math.sin(angle)
    return c * x - s * y, s * x + c * y


build = ContactForce.from_spec
