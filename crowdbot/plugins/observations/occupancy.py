"""Observation: an occupancy grid of lidar returns around the robot."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le
from pydantic import Field

from crowdbot.plugin import Component, ObservationSpec, PositiveLength

Cells = Annotated[int, Ge(4), Le(512)]


class OccupancySpec(ObservationSpec):
    """A square grid around the robot, row by row from behind to ahead, then goal and motion.

    The grid turns with the robot: x ahead, y left. A cell with a return in it is 1, any other 0.
    Goal and motion are those of ``lidar_stack``.
    """

    kind: Literal["occupancy"] = "occupancy"
    sensor: str = Field(default="lidar", description="Name or category of the lidar.")
    cells: Cells = Field(default=32, description="Cells along each side.")
    side: PositiveLength = Field(default=8.0, description="Length of a side, m.")
    goal_range: PositiveLength = Field(default=10.0, description="Farther goals are this far, m.")

    @property
    def needs(self) -> tuple[str, ...]:
        """Return the needed lidar."""
        return (self.sensor,)


OCCUPANCY = Component(spec=OccupancySpec, summary="grid of what a lidar hits around the robot")
