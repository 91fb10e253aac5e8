"""Infrared: the nearest hit of random rays in a narrow cone.

The rays aim at a disc at the end of the range. Their distance from its centre is uniform, so that
their density falls as one over that distance, like a beam that is bright in the middle.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from crowdbot.plugin import (
    Array,
    NoiseGenerator,
    Pose,
    RangeModel,
    Scene,
    SensorInfo,
)
from crowdbot.plugins.sensors.described_build import DescribedSensor
from crowdbot.plugins.sensors.infrared import InfraredSpec


class Infrared(DescribedSensor):
    """Draws new rays for every reading from the sensor's own stream, before any noise.

    The ``angles`` of its description are the edges of the beam.
    """

    def __init__(self, spec: InfraredSpec, noise: Sequence[NoiseGenerator] = ()) -> None:
        self._spec, self._range_model = spec, RangeModel(spec, noise)
        self._info = SensorInfo(
            category="infrared",
            frame="infrared",
            mount=self._range_model.mount,
            rate=spec.rate,
            shape=(1,),
            ros_type="sensor_msgs/msg/Range",
            angles=np.array([-spec.dispersion, spec.dispersion]),
            range_min=spec.range_min,
            range_max=spec.range_max,
            tilt=self._range_model.tilt,
        )

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Return the distance (1,) to the nearest surface that faces the beam, m; inf if none."""
        del t
        own = self._range_model
        if own.tilted:
            rays = self._rays(0.0, rng)
            rays /= np.linalg.norm(rays, axis=1, keepdims=True)
            return own.measure(own.cast_tilted(scene, pose, rays).min(keepdims=True), rng)
        at, yaw = own.pose_in_world(scene, pose)
        rays = self._rays(yaw, rng)
        origins = np.broadcast_to(np.array(at), rays.shape)
        distance, incidence, _ = scene.cast(
            np.ascontiguousarray(origins), rays, self._spec.range_max
        )
        own.drop_slanted(distance, incidence)
        return own.measure(distance.min(keepdims=True), rng)

    def _rays(self, yaw: float, rng: np.random.Generator) -> Array:
        """Return directions (N, 3), turned by a yaw; 1 along the axis."""
        share, turn = rng.random((2, self._spec.rays))
        away = share * math.tan(self._spec.dispersion)
        left, up = away * np.cos(2.0 * math.pi * turn), away * np.sin(2.0 * math.pi * turn)
        c, s = math.cos(yaw), math.sin(yaw)
        return np.column_stack([c - s * left, s + c * left, up])


build = Infrared.from_spec
