"""Privileged sensor: ground truth of the people around the robot."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le, Lt

from crowdbot.plugin import (
    Component,
    Mount,
    NonNegativeLength,
    NonNegativeSpeed,
    PositiveFrequency,
    PositiveLength,
    Quantity,
    SensorSpec,
    default,
)


class PeopleTrackerSpec(SensorSpec):
    """Reading (max_people, 5), nearest first: id, x, y (m), vx, vy (m/s), in base_link's axes.

    The id is a person's index in the crowd; unused rows have id -1 and zeros. Privileged: no real
    sensor measures this, so a planner that uses it must declare itself privileged.
    """

    kind: Literal["people_tracker"] = "people_tracker"
    mount: Mount = default(Mount(z=0.4), "Where lines of sight begin; yaw turns the view.")
    rate: PositiveFrequency = default(16.0, "Readings per second, Hz.", le=128)
    range_max: PositiveLength = default(10.0, "Farthest centre of a person, from the mount, m.")
    view: Annotated[float, Gt(0), Le(2.0 * math.pi), Quantity("angle")] = default(
        2.0 * math.pi, "Horizontal field of view, rad."
    )
    max_people: Annotated[int, Ge(1), Le(10_000)] = default(
        32, "Rows of a reading; the nearest are kept."
    )
    occlusion: bool = default(True, "Whether people must be in line of sight to be tracked.")
    miss: Annotated[float, Ge(0), Lt(1)] = default(
        0.0, "Probability that a person is left out of a reading."
    )
    position_noise: NonNegativeLength = default(0.0, "Standard deviation along each axis, m.")
    velocity_noise: NonNegativeSpeed = default(0.0, "Standard deviation along each axis, m/s.")

    def field_of_view(self) -> tuple[float, float, float]:
        """Return first and last angle, rad, and range, m, for drawings."""
        return -0.5 * self.view, 0.5 * self.view, self.range_max


PEOPLE_TRACKER = Component(
    spec=PeopleTrackerSpec,
    summary="privileged: people around the robot, with noise, misses and occlusion",
)
