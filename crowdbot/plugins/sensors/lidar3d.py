"""Multi-layer lidar."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from annotated_types import Ge, Le, MaxLen
from pydantic import model_validator

from crowdbot.plugin import MOST_RAYS, Angle, Component, PositiveAngle, Quantity, default
from crowdbot.plugins.sensors.lidar import LidarSpec

Elevation = Annotated[float, Ge(-1.5), Le(1.5), Quantity("angle")]


class Lidar3dSpec(LidarSpec):
    """Fans of beams one above the other, forming part of a sphere. It also sees the floor.

    The layers lie evenly from ``elevation_min`` to ``elevation_max``, both included, unless
    ``elevations`` lists them.
    """

    kind: Literal["lidar3d"] = "lidar3d"
    angle_min: Angle = default(-math.pi, "First beam of a layer, rad.")
    angle_max: Angle = default(math.pi, "End of a layer, rad.")
    angle_step: PositiveAngle = default(math.pi / 360, "Between beams, rad.")
    elevation_min: Elevation = default(-math.pi / 12, "Lowest layer, over the horizon, rad.")
    elevation_max: Elevation = default(math.pi / 12, "Highest layer, over the horizon, rad.")
    layers: Annotated[int, Ge(1), Le(512)] = default(16, "How many there are.")
    elevations: Annotated[tuple[Elevation, ...], MaxLen(512)] = default(
        (), "The layers one by one, rising, rad.", strict=False
    )

    @property
    def elevation(self) -> tuple[float, ...]:
        """Return the elevation of each layer above the horizon, rising, rad."""
        if self.elevations or self.layers == 1:
            return self.elevations or (0.5 * (self.elevation_min + self.elevation_max),)
        step = (self.elevation_max - self.elevation_min) / (self.layers - 1)
        return tuple(self.elevation_min + k * step for k in range(self.layers))

    @model_validator(mode="after")
    def _layered(self) -> Lidar3dSpec:
        if self.elevation_min > self.elevation_max:
            raise ValueError("elevation_min must not be above elevation_max")
        if list(self.elevations) != sorted(set(self.elevations)):
            raise ValueError("elevations must rise from layer to layer")
        rays = self.beams * len(self.elevation)
        if rays > MOST_RAYS:
            raise ValueError(f"{rays} beams, more than {MOST_RAYS}: angle_step is too small")
        return self


LIDAR3D = Component(spec=Lidar3dSpec, summary="laser scanner of several layers")
