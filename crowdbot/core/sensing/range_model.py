"""Convert true distances to readings, for all range sensors.

A hit nearer than ``range_min`` reads ``range_min``: inf would mean a free path while something
touches the sensor.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.sensing.mount import (
    mount_pose,
    mount_tilt,
    sensor_pose_in_world,
    sensor_rotation_in_world,
)
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sensing.sensor import NoiseGenerator
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.immutable import immutable
from crowdbot.core.support.plain_numbers import plain_numbers
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.dsl.spec.range_sensor import RangeSensorSpec

_KEPT = np.zeros(0, dtype=np.bool_)
#: Largest error relative to the range. Readings are recorded as single floats of 24 bits, so that a
#: larger error would remove all digits of the distance.
_LARGEST = 2.0**24


class RangeModel:
    """Pose, incidence limit, noise, range, bits and dropouts of one range sensor.

    Attributes:
        drops_slanted: True if slanted surfaces are not seen, so that angles are needed.
        random: True if `measure` draws random numbers.
        tilted: True if the mount has roll or pitch; then use `cast_tilted`.
    """

    def __init__(self, spec: RangeSensorSpec, noise: Sequence[NoiseGenerator]) -> None:
        self._spec, self._noise = spec, tuple(noise)
        self.drops_slanted = spec.max_incidence < math.pi / 2
        self.random = spec.dropout > 0.0 or any(g.random for g in noise)
        self.tilted = mount_tilt(spec.mount) != (0.0, 0.0)
        self._step = (spec.range_max - spec.range_min) / 2.0**spec.bits if spec.bits else 0.0

    @property
    def mount(self) -> tuple[float, float, float, float]:
        """Return x, y, z, yaw from base_link, m and rad."""
        return mount_pose(self._spec.mount)

    def pose_in_world(self, scene: Scene, pose: Pose) -> tuple[tuple[float, float, float], float]:
        """Return position and heading of the sensor in the world frame, m and rad."""
        return sensor_pose_in_world(self._spec.mount, scene, pose)

    @property
    def tilt(self) -> tuple[float, float]:
        """Return roll and pitch of the mount, rad."""
        return mount_tilt(self._spec.mount)

    def cast_tilted(self, scene: Scene, pose: Pose, rays: Array) -> Array:
        """Return the distances (N,) of a tilted sensor's rays, m; inf for no return.

        The floor is visible; surfaces hit at too large an angle are not.

        Args:
            rays: (N, 3) directions of length 1, sensor frame.
        """
        at, _ = self.pose_in_world(scene, pose)
        turn = sensor_rotation_in_world(self._spec.mount, pose)
        distance, incidence, _ = scene.cast_tilted(at, turn, rays, self._spec.range_max)
        self.drop_slanted(distance, incidence)
        return distance

    def drop_slanted(self, distance: Array, incidence: Array) -> None:
        """Set hits at too large an angle to inf, in place; both (N,), m and rad."""
        if self.drops_slanted:
            distance[incidence > self._spec.max_incidence] = np.inf

    def measure(self, distance: Array, rng: np.random.Generator) -> Array:
        """Convert true distances (N,) to readings, in place; inf without a return.

        Random numbers are drawn by the generators in order, then for dropouts.
        """
        spec, lost = self._spec, _KEPT
        for generator in self._noise:
            distance += _errors(generator, distance, rng, spec.range_max * _LARGEST)
        if spec.dropout > 0.0:
            lost = rng.random(len(distance)) < spec.dropout
        _finish(distance, lost, spec.range_min, spec.range_max, self._step)
        return distance


def _errors(
    generator: NoiseGenerator, distance: Array, rng: np.random.Generator, largest: float
) -> Array:
    """Return the errors (N,) of one generator, m; arbitrary for beams without a hit.

    Raises:
        ValueError: they are not one number of at most ``largest`` per beam; the message names the
            generator's class.
    """
    answer = generator.errors(immutable(distance), rng)
    try:
        errors = plain_numbers(answer)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{_who(generator)}: errors returned {error}") from None
    if errors.shape != distance.shape:
        shapes = f"{errors.shape} for {distance.shape}"
        raise ValueError(f"{_who(generator)}: errors returned shape {shapes}")
    # The sum of squares is at least the largest square, and faster.
    if not np.vdot(errors, errors) < largest * largest:  # or NaN
        _check_hits(errors[distance < np.inf], largest, _who(generator))
    return errors


def _who(generator: NoiseGenerator) -> str:
    return f"noise of {type(generator).__module__}.{type(generator).__name__}"


def _check_hits(errors: Array, largest: float, source: str) -> None:
    """Refuse invalid errors (hits,) of hits.

    Raises:
        ValueError: an error is not finite, or too large.
    """
    if not np.isfinite(errors).all():
        raise ValueError(f"{source}: errors returned something that is not finite for what was hit")
    wrong = errors[np.abs(errors) > largest]
    if len(wrong):
        raise ValueError(
            f"{source}: errors returned {wrong[0]:.3g} m for what was hit; write at most "
            f"{largest:.3g} m, beyond which every reading is out of range"
        )


@kernel
def _finish(
    distance: Array, lost: NDArray[np.bool_], shortest: float, longest: float, step: float
) -> None:
    """Keep hits within range, round them down to whole steps, drop some; in place."""
    for k in range(len(distance)):
        if distance[k] < math.inf:
            distance[k] = min(max(distance[k], shortest), longest)
            if step > 0.0:
                distance[k] = max(math.floor(distance[k] / step) * step, shortest)
        if len(lost) and lost[k]:
            distance[k] = math.inf
