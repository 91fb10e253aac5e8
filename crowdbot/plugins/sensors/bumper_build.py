"""Bumper: sectors of a ring that discs of people, walls and pillars press.

A body presses the sector that contains its nearest point; bodies are those of the contact model:
people are discs, walls are segments.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import (
    Array,
    Pose,
    Scene,
    SensorInfo,
    kernel,
    mount_pose,
    nearest_on_segment,
    sensor_pose_in_world,
)
from crowdbot.plugins.sensors.bumper import BumperSpec
from crowdbot.plugins.sensors.described_build import DescribedSensor

_EDGE = 1e-9  # rad; contacts at the very edge of the outer sectors count


class Bumper(DescribedSensor):
    """Reading: (sectors,) 0 or 1; ``angles`` are the (sectors + 1,) borders of the sectors."""

    def __init__(self, spec: BumperSpec) -> None:
        self._spec = spec
        edges = np.linspace(spec.angle_min, spec.angle_max, spec.sectors + 1)
        edges.setflags(write=False)
        self._info = SensorInfo(
            category="bumper",
            frame="bumper",
            mount=mount_pose(spec.mount),
            rate=spec.rate,
            shape=(spec.sectors,),
            ros_type="std_msgs/msg/Float64MultiArray",
            angles=edges,
            range_max=spec.reach,
            random=False,
        )

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Return 1.0 for each sector in contact."""
        del t, rng
        spec = self._spec
        (x, y, _), yaw = sensor_pose_in_world(spec.mount, scene, pose)
        pressed = np.zeros(spec.sectors)
        _press(
            x, y, yaw + spec.angle_min, spec.angle_max - spec.angle_min,
            spec.radius + spec.reach, spec.height,
            scene.people, scene.people_radius, scene.present, scene.pillars,
            scene.pillar_heights, scene.walls, scene.wall_heights, pressed,
        )  # fmt: skip
        return pressed


@kernel
def _press(
    x: float, y: float, begin: float, span: float, ring: float, height: float,
    people: Array, radius: Array, present: NDArray[np.bool_], pillars: Array,
    pillar_heights: Array, walls: Array, wall_heights: Array, pressed: Array,
) -> None:  # fmt: skip
    """Write 1 for each sector of the ring (centre x, y) that a body presses."""
    for i in range(people.shape[0]):
        if present[i]:
            px, py = people[i, 0] - x, people[i, 1] - y
            if math.hypot(px, py) - radius[i] <= ring:
                _mark(px, py, begin, span, pressed)
    for i in range(pillars.shape[0]):
        px, py = pillars[i, 0] - x, pillars[i, 1] - y
        if pillar_heights[i, 0] <= height and math.hypot(px, py) - pillars[i, 2] <= ring:
            _mark(px, py, begin, span, pressed)
    for i in range(walls.shape[0]):
        px, py = nearest_on_segment(x, y, walls[i, 0], walls[i, 1], walls[i, 2], walls[i, 3])
        if wall_heights[i, 0] <= height and math.hypot(px - x, py - y) <= ring:
            _mark(px - x, py - y, begin, span, pressed)


@kernel
def _mark(px: float, py: float, begin: float, span: float, pressed: Array) -> None:
    """Press the sector that contains the direction to (px, py), if any."""
    way = (math.atan2(py, px) - begin) % (2.0 * math.pi)
    if way <= span + _EDGE:
        pressed[min(int(way / span * len(pressed)), len(pressed) - 1)] = 1.0
    elif way >= 2.0 * math.pi - _EDGE:
        pressed[0] = 1.0


build = Bumper.from_spec
