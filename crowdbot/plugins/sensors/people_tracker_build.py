"""People tracker: ground truth within the line of sight, with noise and misses.

Lines of sight go from the mount to a person's trunk at three quarters of the height: to its centre,
and to 0.8 of its radius on either side. A person is seen if at least one line reaches them without
meeting another person, a wall or a pillar first.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import (
    Array,
    Indices,
    Pose,
    Scene,
    SensorInfo,
    mount_pose,
    sensor_pose_in_world,
)
from crowdbot.plugin.for_sensors import trunk_radius
from crowdbot.plugins.sensors.described_build import DescribedSensor
from crowdbot.plugins.sensors.people_tracker import PeopleTrackerSpec

NOBODY = (-1.0, 0.0, 0.0, 0.0, 0.0)
_AIM_HEIGHT = 0.75  # share of a person's height
_AIM_ASIDE = (0.0, -0.8, 0.8)  # share of the trunk's radius


class PeopleTrackerSensor(DescribedSensor):
    """Reading: (max_people, 5) id, x, y, vx, vy in the axes of base_link; m, m/s."""

    def __init__(self, spec: PeopleTrackerSpec) -> None:
        self._spec = spec
        self._info = SensorInfo(
            category="people",
            frame="people_tracker",
            mount=mount_pose(spec.mount),
            rate=spec.rate,
            shape=(spec.max_people, 5),
            ros_type="std_msgs/msg/Float64MultiArray",
            range_max=spec.range_max,
            random=bool(spec.miss or spec.position_noise or spec.velocity_noise),
            privileged=True,
        )

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Return the people it sees, nearest first."""
        del t
        spec = self._spec
        seen = self._candidates(scene, pose)
        if spec.occlusion:
            seen = seen[self._in_sight(scene, pose, seen)]
        rows = np.empty((spec.max_people, 5))
        rows[:] = NOBODY
        if self._info.random:
            # Drawn for everyone, so that one person's errors do not depend on who else is there.
            missed = rng.random(len(scene.people)) < spec.miss
            errors = rng.standard_normal((len(scene.people), 4))
            seen = seen[~missed[seen]]
        seen = seen[: spec.max_people]
        rows[: len(seen), 0] = seen
        rows[: len(seen), 1:] = _in_base(scene.people[seen], pose)
        if self._info.random:
            noise = np.repeat((spec.position_noise, spec.velocity_noise), 2)
            rows[: len(seen), 1:] += noise * errors[seen]
        return rows

    def _candidates(self, scene: Scene, pose: Pose) -> Indices:
        """Return people present, in range and in the field of view; nearest first."""
        spec = self._spec
        (x, y, _), yaw = sensor_pose_in_world(spec.mount, scene, pose)
        away = np.where(scene.present[:, None], scene.people[:, :2] - (x, y), math.inf)
        distance = np.hypot(away[:, 0], away[:, 1])
        near = np.flatnonzero(scene.present & (distance <= spec.range_max))
        bearing = np.arctan2(away[near, 1], away[near, 0]) - yaw
        ahead = np.abs(np.arctan2(np.sin(bearing), np.cos(bearing))) <= 0.5 * spec.view + 1e-12
        near = near[ahead]
        candidates: Indices = near[np.argsort(distance[near], kind="stable")]
        return candidates

    def _in_sight(self, scene: Scene, pose: Pose, people: Indices) -> NDArray[np.bool_]:
        """Return a mask (K,) of people that a line of sight reaches."""
        at, _ = sensor_pose_in_world(self._spec.mount, scene, pose)
        away = scene.people[people, :2] - at[:2]
        distance = np.hypot(away[:, 0], away[:, 1])
        # A person at the mount's position is aimed at along x: every ray begins inside.
        ahead = np.where(
            distance[:, None] > 0.0, away / np.maximum(distance, 1e-300)[:, None], (1.0, 0.0)
        )
        height, radius = scene.people_height[people], scene.people_radius[people]
        aside = np.outer(_AIM_ASIDE, trunk_radius(height, radius))
        rays = np.empty((len(_AIM_ASIDE), len(people), 3))
        rays[:, :, 0] = away[:, 0] - aside * ahead[:, 1]
        rays[:, :, 1] = away[:, 1] + aside * ahead[:, 0]
        rays[:, :, 2] = _AIM_HEIGHT * height - at[2]
        flat = rays.reshape(-1, 3)
        flat[np.abs(flat).sum(axis=1) == 0.0] = (1.0, 0.0, 0.0)
        reach = 2.0 * self._spec.range_max + 5.0
        _, _, body = scene.cast(np.broadcast_to(at, flat.shape).copy(), flat, reach)
        found: NDArray[np.bool_] = (body.reshape(rays.shape[:2]) == people).any(axis=0)
        return found


def _in_base(people: Array, pose: Pose) -> Array:
    """Transform positions and velocities (K, 4) from the world to base_link's axes."""
    c, s = math.cos(pose.yaw), math.sin(pose.yaw)
    turn = np.array([[c, -s], [s, c]])
    return np.hstack([(people[:, :2] - (pose.x, pose.y)) @ turn, people[:, 2:] @ turn])


build = PeopleTrackerSensor.from_spec
