"""Ultrasound: the nearest hit in a zone of revolution about the sensor's axis.

With L the range and R the largest radius, the surface of the zone is, for t from 0 to pi,
z = (L / 2) (1 - cos t) along the axis and r = 4 R / (3 sqrt 3) (1 - cos t) sin t across it: a drop
with its tip at the sensor. A ray at the angle a to the axis leaves it where
sin t = tan(a) 3 sqrt(3) L / (8 R), t >= pi / 2.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numba import njit
from numpy.typing import NDArray

from crowdbot.core.interfaces import NoiseGenerator, Pose, SensorInfo
from crowdbot.core.sensing.columns import Grid
from crowdbot.core.sensing.proximity import Proximity
from crowdbot.core.sensing.scene import Scene
from crowdbot.plugins.sensors.ultrasound import UltrasoundSpec

Array = NDArray[np.float64]
_ROUNDING = 1e-12  # the tangent of the zone's own edge is within it


def zone_length(angle: Array, length: float, radius: float) -> Array:
    """How far the zone reaches at angles to its axis, m; 0 outside."""
    sine = np.tan(angle) * 3.0 * math.sqrt(3.0) * length / (8.0 * radius)
    t = math.pi - np.arcsin(np.minimum(sine, 1.0))
    reach: Array = 0.5 * length * (1.0 - np.cos(t)) / np.cos(angle)
    return np.where(sine <= 1.0 + _ROUNDING, reach, 0.0)


class Ultrasound:
    """Rays on a regular grid of azimuth and elevation, its middle on the axis.

    The outermost rays are the zone's tangents at the sensor.
    """

    def __init__(self, spec: UltrasoundSpec, noise: Sequence[NoiseGenerator] = ()) -> None:
        self._spec, self._proximity = spec, Proximity(spec, noise)
        half = spec.half_angle
        steps = math.ceil(half / spec.resolution - 1e-9)
        angles = half * np.arange(-steps, steps + 1) / steps
        self._grid = Grid(angles, np.tan(angles))
        to_axis = np.arccos(np.cos(angles)[:, np.newaxis] * np.cos(angles))
        self._reach = zone_length(to_axis, spec.range_max, spec.radius)
        self._info = SensorInfo(
            category="ultrasound",
            frame="ultrasound",
            mount=self._proximity.mount,
            rate=spec.rate,
            shape=(1,),
            ros_type="sensor_msgs/msg/Range",
            angles=np.array([-half, half]),
            range_min=spec.range_min,
            range_max=spec.range_max,
            random=self._proximity.random,
        )

    def info(self) -> SensorInfo:
        """Constant description; ``angles`` are the edges of the zone at the sensor."""
        return self._info

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Distance (1,) to the nearest thing in the zone, m; inf if there is none."""
        del t
        own = self._proximity
        distance, incidence, _ = scene.cast_grid(
            self._grid, *own.place(scene, pose), self._spec.range_max, details=own.limited
        )
        own.returned(distance, incidence)
        return own.measured(_nearest(distance, self._reach), rng)


@njit(cache=True, error_model="numpy")
def _nearest(distance: Array, reach: Array) -> Array:
    """The least distance (1,) that lies within the reach of its ray."""
    best = np.full(1, math.inf)
    for r in range(distance.shape[0]):
        for c in range(distance.shape[1]):
            if distance[r, c] <= reach[r, c] and distance[r, c] < best[0]:
                best[0] = distance[r, c]
    return best


def build(spec: UltrasoundSpec, noise: Sequence[NoiseGenerator] = ()) -> Ultrasound:
    """A sonar from its spec and its noise generators."""
    return Ultrasound(spec, noise)
