"""The pose of a robot's sensor in the world."""

from __future__ import annotations

import math

from crowdbot.core.geometry.rotation import rotation
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.dsl.spec.spec import Mount, TiltableMount

#: Default height of base_link above the floor (m): the Kobuki's.
BASE_HEIGHT = 0.0102


def mount_pose(mount: Mount) -> tuple[float, float, float, float]:
    """Return x, y, z, yaw from base_link, m and rad."""
    return mount.x, mount.y, mount.z, mount.yaw


def mount_tilt(mount: Mount) -> tuple[float, float]:
    """Return roll and pitch, rad; 0 for a mount that cannot be tilted."""
    return (mount.roll, mount.pitch) if isinstance(mount, TiltableMount) else (0.0, 0.0)


def sensor_rotation_in_world(mount: Mount, pose: Pose) -> Array:
    """Return the matrix (3, 3) that rotates vectors from the sensor's frame to the world frame."""
    return rotation(*mount_tilt(mount), pose.yaw + mount.yaw)


def sensor_pose_in_world(
    mount: Mount, scene: Scene, pose: Pose
) -> tuple[tuple[float, float, float], float]:
    """Return position and heading of a sensor in the world frame, m and rad.

    The heading of a tilted sensor is its yaw, see `sensor_rotation_in_world`.
    """
    c, s = math.cos(pose.yaw), math.sin(pose.yaw)
    base = BASE_HEIGHT if scene.robot is None else scene.robot.z
    ahead, aside = mount.x, mount.y
    x, y = pose.x + c * ahead - s * aside, pose.y + s * ahead + c * aside
    return (x, y, base + mount.z), pose.yaw + mount.yaw
