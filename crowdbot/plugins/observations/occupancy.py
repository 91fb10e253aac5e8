"""Observation: an occupancy grid of lidar returns around the robot."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import Component, ObservationSpec, PositiveLength, default

Cells = Annotated[int, Ge(4), Le(512)]


class OccupancySpec(ObservationSpec):
    """A square grid around the robot, row by row from behind to ahead, then goal and motion.

    The grid turns with the robot: x ahead, y left. A cell with a return in it is 1, any other 0.
    Goal and motion are those of ``lidar_stack``.
    """

    kind: Literal["occupancy"] = "occupancy"
    sensor: str = default("lidar", "Name or category of the lidar.")
    cells: Cells = default(32, "Cells along each side.")
    side: PositiveLength = default(8.0, "Length of a side, m.")
    goal_range: PositiveLength = default(10.0, "Farther goals are this far, m.")

    @property
    def needs(self) -> tuple[str, ...]:
        """Return the needed lidar."""
        return (self.sensor,)


OCCUPANCY = Component(spec=OccupancySpec, summary="grid of what a lidar hits around the robot")
