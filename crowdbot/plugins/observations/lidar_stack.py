"""Observation of the last scans of a lidar, with the goal and the robot's own motion."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import Component, ObservationSpec, PositiveLength, default

Beams = Annotated[int, Ge(4), Le(4096)]
Scans = Annotated[int, Ge(1), Le(64)]
Stride = Annotated[int, Ge(1), Le(64)]


class LidarStackSpec(ObservationSpec):
    """The nearest return in each sector of a scan, for some scans, then goal and motion.

    The latest scan comes first, then those ``stride`` steps of the planner before, and so on.

    Distances are divided by ``range``, and 1 is a free sector. Then follow the distance to the
    goal, divided by ``goal_range``, the cosine and sine of its direction in the robot's frame, and
    v, w and vy, divided by their limits.
    """

    kind: Literal["lidar_stack"] = "lidar_stack"
    sensor: str = default("lidar", "Name or category of the lidar.")
    others: tuple[str, ...] = default(
        (), "Further lidars, whose sectors follow in a scan.", strict=False
    )
    sectors: Beams = default(36, "Sectors of equal width, which keep a minimum.")
    scans: Scans = default(3, "How many scans, the latest first.")
    stride: Stride = default(1, "Steps of the planner between two scans.")
    range: PositiveLength = default(6.0, "Farther returns count as free, m.")
    goal_range: PositiveLength = default(10.0, "Farther goals are this far, m.")

    @property
    def needs(self) -> tuple[str, ...]:
        """Return its lidars."""
        return (self.sensor, *self.others)


LIDAR_STACK = Component(spec=LidarStackSpec, summary="last scans of a lidar, goal and own motion")
