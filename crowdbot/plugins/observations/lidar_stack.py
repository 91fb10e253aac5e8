"""Observation of the last scans of a lidar, with the goal and the robot's own motion."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le
from pydantic import Field

from crowdbot.plugin import Component, ObservationSpec, PositiveLength

Beams = Annotated[int, Ge(4), Le(4096)]
Scans = Annotated[int, Ge(1), Le(64)]


class LidarStackSpec(ObservationSpec):
    """The nearest return in each sector of a scan, for the last scans, then goal and motion.

    Distances are divided by ``range``, and 1 is a free sector. Then follow the distance to the
    goal, divided by ``goal_range``, the cosine and sine of its direction in the robot's frame, and
    v, w and vy, divided by their limits.
    """

    kind: Literal["lidar_stack"] = "lidar_stack"
    sensor: str = Field(default="lidar", description="Name or category of the lidar.")
    sectors: Beams = Field(default=36, description="Sectors of equal width, which keep a minimum.")
    scans: Scans = Field(default=3, description="How many scans, the latest first.")
    range: PositiveLength = Field(default=6.0, description="Farther returns count as free, m.")
    goal_range: PositiveLength = Field(default=10.0, description="Farther goals are this far, m.")

    @property
    def needs(self) -> tuple[str, ...]:
        """Return its lidar."""
        return (self.sensor,)


LIDAR_STACK = Component(
    spec=LidarStackSpec,
    build="crowdbot.plugins.observations.lidar_stack_build:build",
    summary="last scans of a lidar, goal and own motion",
)
